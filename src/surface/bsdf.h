#ifndef ETALON_SURFACE_BSDF_H
#define ETALON_SURFACE_BSDF_H

/* Scattering at a surface: the interface and the table of kinds. Directions are unit
 * vectors in the local shading frame (z = shading normal) and point away from the
 * surface; wo is where the path comes from, wi where it goes on. A new kind is one file
 * bsdf_<kind>.c and one row of the table. */

#include "base/err.h"
#include "math/rgb.h"
#include "math/vec3.h"
#include "surface/texture.h"

#include <stdbool.h>

/* The quantity that a path transports: a camera path gathers radiance (light comes from
 * wi), a light path carries power. Refraction scales the first by (eta_i/eta_t)^2 and not
 * the second [Veach97, section 5.2]. */
enum transport { TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE };

enum bsdf_flag {
    BSDF_DELTA = 1, /* scatters only into single directions: cannot be connected to */
    BSDF_SOME_DELTA = 128, /* has delta lobes beside others; bsdf_sample says which */
    BSDF_TEXTURED = 256,   /* a parameter comes from a texture: see bsdf_at */
    BSDF_REFLECTS = 2,
    BSDF_TRANSMITS = 4,
    BSDF_BLACK = 8,          /* scatters nothing: a path ends here */
    BSDF_U_LOBE = 16,        /* bsdf_sample reads u[0] */
    BSDF_U_DIRECTION = 32,   /* bsdf_sample reads u[1], u[2] */
    BSDF_ANISOTROPIC = 64,   /* wants the shading frame aligned with dp/du */
    BSDF_STRAIGHT = 1 << 14, /* some light goes straight on: see bsdf_straight */
    /* Of its delta lobes, none does anything else. */
    BSDF_ONLY_STRAIGHT = 1 << 15,
};

#define BSDF_PARAMS   100
#define BSDF_TEXTURES 12  /* parameters of one node that come from textures */
#define BSDF_NODES    8   /* textured nodes of one material */
#define BSDF_SIZE_MAX 256 /* nodes of one material */

struct bsdf_type;

/* A parameter that a texture gives. */
struct bsdf_binding {
    const struct texture *texture; /* NULL: none */
    const struct bsdf_param *param;
};

/* What turns shading normals without moving the surface; of the outermost node. */
struct bsdf_relief {
    const struct texture *texture; /* NULL: nothing */
    /* A normal map: the colours c are normals 2c - 1 in the frame (dp/du, n x dp/du, n).
     * Else a bump map: a displacement along the normal, in scene units. */
    bool normals;
};

/* One material at one point. Before its textures are evaluated: what all points have in
 * common; then the flags are those of any point. */
struct bsdf {
    const struct bsdf_type *type;
    unsigned flags;              /* enum bsdf_flag, set by prepare */
    const struct bsdf *child[2]; /* of kinds that blend others; not owned */
    /* Nodes of the tree below and with this one, those that are used twice counted twice:
     * what an evaluation may have to visit. Set by bsdf_prepare. */
    int size;
    double param[BSDF_PARAMS]; /* layout is the type's own; colours take three */
    /* Of a material. At a point (bsdf_at) none is bound, and nothing else is there. */
    struct bsdf_binding bound[BSDF_TEXTURES];
    struct bsdf_relief relief;
};

/* Storage for the BSDF of one point (bsdf_at): scratch of the vertex. */
struct bsdf_nodes {
    int count;
    struct bsdf node[BSDF_NODES];
};

struct bsdf_value {
    struct rgb f;   /* BSDF without the cosine, 1/sr */
    double pdf;     /* of wi given wo, 1/sr */
    double pdf_rev; /* of wo given wi, 1/sr */
};

struct bsdf_sample {
    struct vec3 wi;
    struct rgb weight; /* f |cos wi| / pdf; for a delta lobe f without its delta */
    double pdf;        /* 1/sr; for a delta lobe the probability of choosing it */
    /* Density of wo given wi. For a delta lobe the coefficient of the same delta as in
     * pdf, so that pdf_rev/pdf is the limit of the rough case: refraction has the
     * Jacobian |cos wo| eta_o^2 / (|cos wi| eta_i^2). */
    double pdf_rev;
    bool delta; /* this lobe is a delta */
    bool transmission;
};

/* The delta lobe in the direction -wo, as if nothing were there but a filter. Both are
 * the same for wo and -wo, so that walks of both directions agree. */
struct bsdf_straight {
    struct rgb transmittance; /* f without its delta; not black */
    double chance;            /* of choosing this lobe, in (0,1] */
};

/* Parameters as files give them: name -> place in param[]. */
struct bsdf_param {
    const char *name;
    int offset;         /* into param[] */
    int count;          /* 1 number or 3 (rgb) */
    double fallback[3]; /* default */
    double min, max;    /* inclusive */
};

struct bsdf_type {
    const char *name;
    const struct bsdf_param *params; /* ends with name NULL */
    int places; /* of param[] that are in use: for each textured hit they are copied */
    /* Called after all params are set: checks them, precomputes values for the hot path,
     * sets flags. On failure err has the place `at`. */
    bool (*prepare)(struct bsdf *bsdf, const struct place *at, struct err *err);
    /* All zero for delta lobes and black kinds. False (and *out zero) if f is zero. */
    bool (*eval)(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out);
    /* False if nothing is scattered (weight zero). u: lobe, then two for the direction;
     * only those announced by the flags are read. The straight lobe is sampled exactly
     * where u[0] < its chance. */
    bool (*sample)(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out);
    /* Numbers u with which sample gives wi, as a delta or not: the right inverse of
     * [Pantaleoni17]. u comes with three uniform numbers, and `choice` is one more: where
     * many u give wi, these draw one of them with the law that uniform numbers have given
     * wi, and what sample does not read stays. False if no u gives wi, or if it cannot be
     * told which lobe of two deltas did. */
    bool (*invert)(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3]);
    /* Of kinds that may set BSDF_STRAIGHT, and called only with this flag; false if no
     * light goes straight on from this direction. */
    bool (*straight)(const struct bsdf *bsdf, struct vec3 wo, struct bsdf_straight *out);
};

/* Material of surfaces without one: scatters nothing. */
extern const struct bsdf bsdf_nothing;

/* NULL-terminated table; NULL if there is no such kind. */
extern const struct bsdf_type *const bsdf_types[];
const struct bsdf_type *bsdf_find(const char *name);

/* All params at their defaults; then set params, then bsdf_prepare. */
void bsdf_init(struct bsdf *bsdf, const struct bsdf_type *type);
const struct bsdf_param *bsdf_param_find(const struct bsdf_type *type, const char *name);
/* Checks finiteness and range; negative colour components are the importer's to clamp. */
bool bsdf_set(struct bsdf *bsdf, const char *name, const double *values, int count,
              const struct place *at, struct err *err);
/* Binds the parameter to a texture, clamped to its range at every point (a number takes
 * the luminance). Before bsdf_prepare. Not for eta and distribution. */
bool bsdf_bind(struct bsdf *bsdf, const char *name, const struct texture *texture,
               const struct place *at, struct err *err);
/* The children must be prepared. */
bool bsdf_prepare(struct bsdf *bsdf, const struct place *at, struct err *err);

/* The BSDF of a textured material at a point, made in *nodes. */
const struct bsdf *bsdf_at(const struct bsdf *material, const struct texture_point *at,
                           struct bsdf_nodes *nodes);

static inline bool bsdf_eval(const struct bsdf *b, struct vec3 wo, struct vec3 wi,
                             enum transport mode, struct bsdf_value *out)
{
    return b->type->eval(b, wo, wi, mode, out);
}

static inline bool bsdf_sample(const struct bsdf *b, struct vec3 wo, const double u[3],
                               enum transport mode, struct bsdf_sample *out)
{
    return b->type->sample(b, wo, u, mode, out);
}

static inline bool bsdf_invert(const struct bsdf *b, struct vec3 wo, struct vec3 wi,
                               bool delta, double choice, double u[3])
{
    return b->type->invert(b, wo, wi, delta, choice, u);
}

static inline bool bsdf_straight(const struct bsdf *b, struct vec3 wo,
                                 struct bsdf_straight *out)
{
    return b->flags & BSDF_STRAIGHT && b->type->straight(b, wo, out);
}

#endif
