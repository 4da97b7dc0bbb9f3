#ifndef ETALON_IMPORT_MITSUBA_SCENE_H
#define ETALON_IMPORT_MITSUBA_SCENE_H

/* The parts of the Mitsuba reader. An object (<shape>, <bsdf>, ...) is an element with a
 * type; its properties are children with a name. camelCase (0.5, 0.6) and snake_case (3)
 * are one: names are compared without underscores and case. What nobody asks for is
 * reported. */

#include "import/ahead.h"
#include "import/mitsuba_tree.h"

#define MITSUBA_DEPTH_MAX 64 /* edges, where Mitsuba has no limit or a larger one */

struct mitsuba_id {
    const char *name;
    struct mitsuba_node *node;
};

struct mitsuba {
    struct scene_desc *desc;
    char *directory; /* file names start here */
    struct ahead *ahead;
    struct mitsuba_node *root;
    struct mitsuba_id *ids; /* sorted by name */
    size_t id_count, id_capacity;
    bool old;        /* 0.x: other defaults */
    int entered;     /* objects that are being read, one inside the other */
    int two_sided;   /* depth of "twosided" around the material that is being read */
    int defaults[2]; /* materials of shapes without one: [emits]; -1 before */
};

/* --- objects -------------------------------------------------------------------------
 */

/* What a <ref> stands for (another node: itself); NULL after an error. */
struct mitsuba_node *mitsuba_resolve(struct mitsuba *m, struct mitsuba_node *node,
                                     struct err *err);
/* The first child that is an object of this element, or a reference to one; *child is
 * NULL if there is none. False only if a reference leads nowhere. */
bool mitsuba_child(struct mitsuba *m, const struct mitsuba_node *object,
                   const char *element, struct mitsuba_node **child, struct err *err);
/* Around the reading of an object that may hold others: fails where it holds itself, or
 * where references lead too deep. */
bool mitsuba_enter(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
void mitsuba_leave(struct mitsuba *m, struct mitsuba_node *object);
/* The "type" of an object; "" if it has none. */
const char *mitsuba_type(const struct mitsuba_node *object);
/* A counted note for each property and child that nobody asked for. */
void mitsuba_report(struct mitsuba *m, const struct mitsuba_node *object);
/* Declares that these properties (NULL-terminated) have no meaning here. */
void mitsuba_ignore(struct mitsuba_node *object, const char *const *names);
/* Notes an unknown plugin, with the nearest known name (NULL-terminated list) and what
 * comes in its place. */
void mitsuba_unknown(struct mitsuba *m, const struct mitsuba_node *object,
                     const char *const *known, const char *instead);

/* --- properties: *value is untouched if there is none of that name --------------------
 */

bool mitsuba_same_name(const char *a, const char *b);
struct mitsuba_node *mitsuba_property(struct mitsuba_node *object, const char *name);
bool mitsuba_float(struct mitsuba_node *object, const char *name, double *value,
                   struct err *err);
bool mitsuba_integer(struct mitsuba_node *object, const char *name, int *value,
                     struct err *err);
bool mitsuba_boolean(struct mitsuba_node *object, const char *name, bool *value,
                     struct err *err);
bool mitsuba_string(struct mitsuba_node *object, const char *name, const char **value,
                    struct err *err);
bool mitsuba_point(struct mitsuba_node *object, const char *name, double value[3],
                   struct err *err);
/* rgb, srgb, spectrum, a number for grey, or a texture; negative components are clamped
 * and counted. */
struct mitsuba_value {
    const struct texture *texture; /* or NULL: */
    struct rgb value;
};
bool mitsuba_value(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   struct mitsuba_value *value, struct err *err);
/* Where nothing can vary: the mean of a texture, with a note. */
bool mitsuba_colour(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                    struct rgb *value, struct err *err);
bool mitsuba_transform(struct mitsuba_node *object, const char *name, struct xform *value,
                       struct err *err);
/* +z along the way from origin to target, +y anyhow; false if they coincide. */
bool mitsuba_look_along(const double origin[3], const double target[3],
                        struct xform *out);
/* Numbers in an attribute, separated by commas or blanks: *count of at most `room`. */
bool mitsuba_numbers(const struct mitsuba_node *node, const char *attribute, size_t room,
                     double *values, size_t *count, struct err *err);
/* Attributes x, y, z, or "value" with one number or three; absent ones are untouched. */
bool mitsuba_xyz(const struct mitsuba_node *node, double xyz[3], struct err *err);

/* --- kinds of objects ----------------------------------------------------------------
 */

bool mitsuba_sensor(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
bool mitsuba_film(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
bool mitsuba_integrator(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
bool mitsuba_texture(struct mitsuba *m, struct mitsuba_node *object,
                     const struct texture **out, struct err *err);
struct rgb mitsuba_texture_mean(struct mitsuba *m, const struct mitsuba_node *object,
                                const struct texture *texture);
/* The picture that an object names. NULL without an error: there is none, as a note says.
 */
const struct texture_image *mitsuba_picture(struct mitsuba *m,
                                            struct mitsuba_node *object, struct err *err);

#define MITSUBA_MATERIAL_NONE (-2) /* light passes through */

bool mitsuba_material(struct mitsuba *m, struct mitsuba_node *object, int *index,
                      struct err *err);
bool mitsuba_material_add(struct mitsuba *m, struct bsdf *bsdf,
                          const struct mitsuba_node *object, int *index, struct err *err);
/* Reads a colour or its texture into a parameter of the BSDF. */
bool mitsuba_material_pass(struct mitsuba *m, struct mitsuba_node *object,
                           const char *name, double fallback, struct bsdf *bsdf,
                           const char *to, struct err *err);
/* What Mitsuba gives a shape without a BSDF: grey, or black for an emitter. */
bool mitsuba_material_default(struct mitsuba *m, bool emitter, int *index,
                              struct err *err);
/* Readers of materials that hold others: the first of them alone; one for both sides or
 * one for each; a blend of two; a mask; a bump map. */
bool mitsuba_mixture_first(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err);
bool mitsuba_mixture_sides(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err);
bool mitsuba_mixture_blend(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err);
bool mitsuba_mixture_weighted(struct mitsuba *m, struct mitsuba_node *object, int *index,
                              struct err *err);
bool mitsuba_mixture_bump(struct mitsuba *m, struct mitsuba_node *object, int *index,
                          struct err *err);
bool mitsuba_mixture_mask(struct mitsuba *m, struct mitsuba_node *object, int *index,
                          struct err *err);

/* intIOR (`inside` by default) over extIOR, numbers or names of stuffs. */
bool mitsuba_ior_ratio(struct mitsuba_node *object, double inside, double *eta,
                       struct err *err);

#define MITSUBA_IOR_BK7           1.5046
#define MITSUBA_IOR_POLYPROPYLENE 1.49

/* eta and k, given or by the metal's name, relative to what is outside; *perfect: a metal
 * that reflects all. */
bool mitsuba_ior_metal(struct mitsuba *m, struct mitsuba_node *object, struct rgb *eta,
                       struct rgb *k, bool *perfect, struct err *err);

bool mitsuba_emitter(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
/* The area emitter of a shape. */
bool mitsuba_emitter_area(struct mitsuba *m, struct mitsuba_node *object,
                          struct shape_desc *shape, struct err *err);
bool mitsuba_shape(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
/* Gives the mesh smooth normals: of the faces around a vertex, weighted by the angles
 * that they fill there, as Mitsuba; the winding gives the side. */
void mitsuba_smooth_normals(struct mesh *mesh);

#endif
