#ifndef ETALON_SCENE_LIGHT_H
#define ETALON_SCENE_LIGHT_H

/* Lights: the interface and the table of kinds; one file light_<kind>.c each. Points on
 * lights are chosen by power, then uniformly in area: the density does not depend on who
 * asks, so the start of a light path and next-event estimation share it. */

#include "math/dist.h"
#include "scene/hit.h"

struct scene;
struct light_type;

struct light {
    const struct light_type *type;
    struct rgb radiance; /* W/(m^2 sr), or intensity W/sr of a point light; scaled
                            by the scene's emission_scale */
    int32_t shape;       /* -1 without a surface */
    bool two_sided;
    bool delta_position;   /* cannot be hit by chance; anchor.ng is zero */
    struct vec3 position;  /* point light */
    double area;           /* m^2 */
    double power;          /* of the luminance, W; > 0 */
    double pick;           /* probability of being chosen */
    double pdf_point;      /* pick / area: density of a point by area; pick if delta */
    struct dist triangles; /* of a mesh, by area */
};

struct light_type {
    const char *name;
    /* A point, uniform in area; ng on the emitting side. */
    void (*sample_point)(const struct scene *scene, const struct light *light,
                         const double u[2], struct anchor *point);
    /* Radiance (intensity) sent from `point` into w, where it is not the same for all
     * points and directions of the emitting side; else NULL. */
    struct rgb (*emission)(const struct light *light, const struct anchor *point,
                           struct vec3 w);
    /* w with its density per solid angle; *weight = emission * |cos| / pdf (no cosine
     * for a delta position). False if it sends nothing. */
    bool (*sample_direction)(const struct light *light, const struct anchor *point,
                             const double u[2], struct vec3 *w, double *pdf,
                             struct rgb *weight);
    double (*pdf_direction)(const struct light *light, const struct anchor *point,
                            struct vec3 w);
};

extern const struct light_type light_area, light_point;

/* Radiance (intensity) that the light sends from `point` into w. */
static inline struct rgb light_emission(const struct light *light,
                                        const struct anchor *point, struct vec3 w)
{
    if (light->type->emission)
        return light->type->emission(light, point, w);
    float cos = vec3_dot(point->ng, w);
    bool sends = light->delta_position || cos > 0.0f || (light->two_sided && cos < 0.0f);
    return sends ? light->radiance : rgb_grey(0.0);
}

/* Chooses a light by power (u_pick) and a point on it; NULL never happens in a scene that
 * scene_build accepted. The density of the point is light->pdf_point. */
const struct light *light_sample(const struct scene *scene, double u_pick,
                                 const double u[2], struct anchor *point);

#endif
