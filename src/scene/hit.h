#ifndef ETALON_SCENE_HIT_H
#define ETALON_SCENE_HIT_H

/* Points that rays start from and end at. */

#include "math/frame.h"
#include "surface/bsdf.h"

#include <stdint.h>

/* A point that a ray may start from. offset: distance along ng that exceeds the rounding
 * error of p (proportional to the coordinates, no fixed epsilon); 0 in free space, where
 * ng is zero too. far_offset: growth of the offset at a segment's far end for each unit
 * of the segment's length; 0 except on an instance (scene/instance.h). */
struct ray_endpoint {
    struct vec3 p;
    struct vec3 ng; /* geometric normal, unit */
    float offset, far_offset;
};

struct hit {
    struct ray_endpoint at; /* ng on the side of shading.n, the emitting side of a lamp */
    struct frame shading;   /* shading.n . ng >= 0 */
    float u, v;             /* surface parameters; 0 unless needs.uv */
    uint32_t triangle;      /* of a mesh, its number */
    const struct bsdf *bsdf;
    int32_t light; /* index of the area light, or -1 */
    int32_t shape;
};

/* Where the textures of what was hit are evaluated. */
static inline struct texture_point hit_texture_point(const struct hit *hit)
{
    struct vec3 p = hit->at.p;
    return (struct texture_point){
        (double)hit->u, (double)hit->v, {(double)p.x, (double)p.y, (double)p.z}};
}

/* The BSDF that a textured material has there, made in *nodes. */
static inline const struct bsdf *hit_bsdf(const struct hit *hit, struct bsdf_nodes *nodes)
{
    const struct texture_point at = hit_texture_point(hit);
    nodes->count = 0;
    return bsdf_at(hit->bsdf, &at, nodes);
}

/* Puts that in place of the material's BSDF, if it is textured. */
static inline void hit_evaluate_textures(struct hit *hit, struct bsdf_nodes *nodes)
{
    if (hit->bsdf->flags & BSDF_TEXTURED)
        hit->bsdf = hit_bsdf(hit, nodes);
}

/* |a - b|^2 in double: densities per area and per solid angle differ by it. */
static inline double hit_square_distance(struct vec3 a, struct vec3 b)
{
    struct vec3 d = vec3_sub(a, b);
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    return x * x + y * y + z * z;
}

/* Sum of |n| |v| over components. If each component of v has an error of e |v|, the error
 * along n is at most e times this. */
static inline float abs_components_dot(struct vec3 n, struct vec3 v)
{
    return fabsf(n.x * v.x) + fabsf(n.y * v.y) + fabsf(n.z * v.z);
}

/* The origin of a ray into direction w: offset from the surface on w's side. */
static inline struct vec3 ray_endpoint_origin(const struct ray_endpoint *a, struct vec3 w)
{
    float side = vec3_dot(a->ng, w) < 0.0f ? -a->offset : a->offset;
    return vec3_mad(a->p, side, a->ng);
}

#endif
