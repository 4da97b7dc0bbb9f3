#ifndef ETALON_SCENE_LIGHT_H
#define ETALON_SCENE_LIGHT_H

/* Lights: the interface and the table of kinds; one file light_<kind>.c each. A light is
 * chosen by power and a point on it uniformly in area. The density does not depend on the
 * receiver, so light paths and next-event estimation share it.
 *
 * A light at infinity has directions for points. Its endpoint holds in ng the direction
 * that the light travels, density per solid angle (a probability if that direction is a
 * delta); its "direction" is the place where a path enters, uniform over the disk across
 * ng that covers the sphere around the scene, density 1/(pi radius^2) per area across ng,
 * and endpoint.p is written only then. So an edge to infinity has no 1/distance^2, and no
 * cosine at its far end: conv of path/vertex.h is 1 there and |cos| here. */

#include "math/dist.h"
#include "scene/hit.h"
#include "scene/sky_density.h"

struct light_desc;
struct scene;
struct light_type;

/* The sphere that lights at infinity must cover. */
struct light_sphere {
    struct vec3 centre;
    double radius;
};

/* What an environment map needs; see light_environment.c. */
struct environment {
    bool has_map; /* else the same radiance from everywhere */
    struct sky_map map;
    struct dist_tree density;
    double to_local[3][3]; /* a rotation, or one with a reflection */
};
void environment_deinit(struct environment *e);
size_t environment_bytes(const struct environment *e); /* beside the struct */

/* A texture's parameters by the place: those of the quadric, or affine maps
 * u[0] x + u[1] y + u[2] z + u[3]. See scene/emission.h. */
struct emission_map {
    const struct texture *texture; /* a factor of the radiance */
    const struct quadric *quadric; /* NULL: */
    double u[4], v[4];
};

struct light {
    const struct light_type *type;
    struct rgb radiance; /* W/(m^2 sr), or intensity W/sr of a point light; scaled
                            by the scene's emission_scale */
    int32_t shape;       /* -1 without a surface */
    bool two_sided;
    bool infinite; /* see above */
    bool
        delta_position; /* cannot be hit by chance; endpoint.ng is zero unless infinite */
    double area;        /* m^2 */
    double power;       /* of the luminance, W; > 0 */
    double pick;        /* probability of being chosen */
    double pdf_point;   /* pick / area: density of a point by area; pick if delta, and
                           for an environment, whose points differ */
    struct dist triangles; /* of a mesh, by area */
    /* Members of some kinds only. */
    struct vec3 position;                /* point light, spot */
    struct vec3 axis;                    /* spot, distant: where it shines to, unit */
    double inner, outer;                 /* spot, radians from the axis */
    double versine_inner, versine_outer; /* 1 - cos of them */
    bool linear, smooth;                 /* spot: how it falls off */
    struct light_sphere sphere;          /* at infinity */
    struct emission_map map;             /* lamps with a texture */
    struct environment environment;
};

struct light_type {
    const char *name;
    /* For lights without a surface: sets *light, including its power, from the
     * description; the scaled radiance is already set. */
    bool (*build)(const struct light_desc *desc, struct light *light, struct err *err);
    /* A point, uniform in area; ng on the emitting side. Returns the triangle of a mesh
     * that it lies on, else 0. */
    uint32_t (*sample_point)(const struct scene *scene, const struct light *light,
                             const double u[2], struct ray_endpoint *point);
    /* Radiance (intensity) sent from `point` into w, where it is not the same for all
     * points and directions of the emitting side; else NULL. */
    struct rgb (*emission)(const struct light *light, const struct ray_endpoint *point,
                           struct vec3 w);
    /* Density of a point divided by `pick`, if it is not the same for all points; else
     * NULL. */
    double (*pdf_point)(const struct light *light, const struct ray_endpoint *point);
    /* w with its density per solid angle; *weight = emission * |cos| / pdf (no cosine
     * for a delta position). False if it sends nothing. At infinity: point->p too. */
    bool (*sample_direction)(const struct light *light, struct ray_endpoint *point,
                             const double u[2], struct vec3 *w, double *pdf,
                             struct rgb *weight);
    double (*pdf_direction)(const struct light *light, const struct ray_endpoint *point,
                            struct vec3 w);
    /* The inverses: u with which sample_point gives the point that was hit, and with
     * which sample_direction gives w from there (at infinity: the ray through `through`).
     * u comes uniform, and what sampling does not read stays. False if no u does. */
    bool (*invert_point)(const struct scene *scene, const struct light *light,
                         const struct hit *point, double u[2]);
    bool (*invert_direction)(const struct light *light, const struct ray_endpoint *point,
                             struct vec3 w, struct vec3 through, double u[2]);
};

extern const struct light_type light_area, light_area_textured, light_point, light_spot,
    light_distant, light_environment;

/* Density of a point that light_sample chose, or that a path met by chance. */
static inline double light_pdf_point(const struct light *light,
                                     const struct ray_endpoint *point)
{
    double pdf = light->pdf_point;
    return light->type->pdf_point ? pdf * light->type->pdf_point(light, point) : pdf;
}

/* For sample_direction of lights at infinity: the point at which a path enters the scene.
 */
bool light_enter(const struct light *light, struct ray_endpoint *point, const double u[2],
                 struct vec3 *w, double *pdf);
bool light_enter_invert(const struct light *light, const struct ray_endpoint *point,
                        struct vec3 w, struct vec3 through, double u[2]);
static inline double light_enter_pdf(const struct light *light)
{
    /* 1 / (pi r^2) [Pharr16, section 16.1.2]. */
    return 1.0 / (3.14159265358979323846 * light->sphere.radius * light->sphere.radius);
}

/* Radiance (intensity) that the light sends from `point` into w. */
static inline struct rgb light_emission(const struct light *light,
                                        const struct ray_endpoint *point, struct vec3 w)
{
    if (light->type->emission)
        return light->type->emission(light, point, w);
    float cos = vec3_dot(point->ng, w);
    bool sends = light->delta_position || cos > 0.0f || (light->two_sided && cos < 0.0f);
    return sends ? light->radiance : rgb_grey(0.0);
}

/* Chooses a light by power (u_pick) and a point on it: point->at, and of a mesh its
 * triangle. NULL never happens in a scene that scene_build accepted. The density of the
 * point is light_pdf_point. */
const struct light *light_sample(const struct scene *scene, double u_pick,
                                 const double u[2], struct hit *point);
/* u_pick and u, which come uniform, become numbers with which light_sample gives this
 * point or what was hit. False if none do. */
bool light_invert(const struct scene *scene, const struct light *light,
                  const struct hit *point, double *u_pick, double u[2]);

/* invert_point of lights that have one point only. */
bool light_invert_no_point(const struct scene *scene, const struct light *light,
                           const struct hit *point, double u[2]);

#endif
