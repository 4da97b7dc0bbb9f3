#ifndef ETALON_PATH_EDGE_H
#define ETALON_PATH_EDGE_H

/* The edge that joins two sub-paths. */

#include "image/contrib.h"
#include "path/passage.h"

/* The edge between two vertices; V and the cosines of the geometric term
 * G = V |cos| |cos'| / distance^2 [Veach97 Eq. 8.2] are the caller's. */
struct edge {
    struct vec3 w;         /* unit, from a to b */
    double inverse_square; /* 1 / distance^2 */
};

static inline bool edge_between(const struct ray_endpoint *a,
                                const struct ray_endpoint *b, struct edge *e)
{
    struct vec3 d = vec3_sub(b->p, a->p);
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    double square = x * x + y * y + z * z;
    if (!(square > 0.0))
        return false;
    double inverse = 1.0 / sqrt(square);
    e->w = vec3((float)(x * inverse), (float)(y * inverse), (float)(z * inverse));
    e->inverse_square = 1.0 / square;
    return true;
}

/* 1 / distance^2. Two points in a corner may be rounded to the same place; then the sum
 * of their ray offsets, which bounds the rounding error, replaces their distance. */
static inline double inverse_square_between(const struct ray_endpoint *a,
                                            const struct ray_endpoint *b)
{
    double square = hit_square_distance(a->p, b->p);
    double apart = (double)a->offset + (double)b->offset;
    return 1.0 / (square > 0.0 ? square : apart * apart);
}

/* The edge from the light's point y to z. A point outside all shapes stands for a light
 * at infinity, so that visibility of this edge is tested as of any other. */
static inline bool edge_from_light(const struct light *light, struct ray_endpoint *y,
                                   const struct ray_endpoint *z, struct edge *e)
{
    if (!light->infinite)
        return edge_between(y, z, e);
    *e = (struct edge){y->ng, 1.0};
    float far = (float)(2.0 * light->sphere.radius);
    y->p = vec3_mad(z->p, -far, y->ng);
    return true;
}

static inline double edge_cos_geometric(const struct vertex *v, struct vec3 w)
{
    return fabs((double)vec3_dot(v->hit.at.ng, w));
}

static inline double edge_cos_shading(const struct vertex *v, struct vec3 w)
{
    return fabs((double)vec3_dot(v->hit.shading.n, w));
}

/* Whether a path with this value is unobstructed from y to z, w being the direction; then
 * the value is that of light which has passed what lies between. Visibility is tested
 * last, as it costs most. blind: nothing lies between, without a test. */
static inline enum failure edge_unobstructed(const struct subpaths *paths,
                                             const struct vertex *y,
                                             const struct vertex *z, struct vec3 w,
                                             bool blind, struct rgb *value,
                                             struct passage *passage)
{
    if (rgb_is_black(*value))
        return FAILURE_ZERO;
    *passage = (struct passage){{1.0, 1.0, 1.0}, 1.0, 1.0, 1.0}; /* nothing passed */
    if (blind)
        return FAILURE_NONE;
    if (!paths->passed)
        return accel_visible(paths->scene, &y->hit.at, &z->hit.at) ? FAILURE_NONE
                                                                   : FAILURE_BLOCKED;
    struct passage passed;
    enum failure failure = passage_between(paths, y, z, w, &passed);
    if (failure == FAILURE_NONE) {
        *passage = passed;
        *value = rgb_mul(*value, passed.value);
    }
    return failure;
}

#endif
