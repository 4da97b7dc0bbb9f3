#ifndef ETALON_SCENE_TRIANGLE_H
#define ETALON_SCENE_TRIANGLE_H

/* One triangle of a mesh: a point on it, its normals, and the distance that clears the
 * rounding errors. Shared by hits and by lights, so that both see one surface.
 *
 * With e = 2^-24, P = max|p|, E = max(|e1|,|e2|) by component and sin = |e1 x e2| /
 * (|e1||e2|), the errors along the normal are at most, to first order in e,
 *   p0 + (b1 e1 + b2 e2) in floats         sqrt3 e (P + 3 E)
 *   rounding of p + offset ng              sqrt3 e P
 *   the side of the plane as a fast intersector computes it, Ng . (v0 - o) with edges
 *   rounded before their cross product     sqrt3 e E (4 + 5.7 / sin),
 * together e (3.5 P + E (12 + 10 / sin)). A lateral error of (b1, b2) does not matter:
 * any weights name a point of the plane. The second part is the triangle's own; it is
 * kept with the unit normal (of the winding) in shape.face, both computed in double. */

#include "scene/shape.h"

#define TRIANGLE_EPSILON 0x1p-24f

struct triangle {
    struct vec3 p0, e1, e2;
    uint32_t i0, i1, i2;
};

static inline struct vec3 triangle_corner(const float *at, uint32_t index)
{
    const float *v = at + 3 * (size_t)index;
    return (struct vec3){v[0], v[1], v[2]};
}

static inline struct triangle triangle_load(const struct shape *shape, uint32_t triangle)
{
    const uint32_t *i = shape->index + 3 * (size_t)triangle;
    struct triangle t = {.i0 = i[0], .i1 = i[1], .i2 = i[2]};
    t.p0 = triangle_corner(shape->p, t.i0);
    t.e1 = vec3_sub(triangle_corner(shape->p, t.i1), t.p0);
    t.e2 = vec3_sub(triangle_corner(shape->p, t.i2), t.p0);
    return t;
}

/* fmaxf is a function call wherever NaN is honoured; nothing here can be NaN. */
static inline float triangle_max(float a, float b)
{
    return a > b ? a : b;
}

static inline float triangle_max_abs(struct vec3 a)
{
    return triangle_max(fabsf(a.x), triangle_max(fabsf(a.y), fabsf(a.z)));
}

/* p0 + b1 e1 + b2 e2 with its offset; ng on the side of the winding. */
static inline struct anchor triangle_anchor(const struct triangle *t, const float *face,
                                            float b1, float b2)
{
    struct anchor at;
    at.p = vec3_add(t->p0, vec3_mad(vec3_scale(t->e1, b1), b2, t->e2));
    at.ng = (struct vec3){face[0], face[1], face[2]};
    at.offset = 4.0f * TRIANGLE_EPSILON * triangle_max_abs(at.p) + face[3];
    return at;
}

/* Interpolated shading normal, unit; false where the corners cancel. */
static inline bool triangle_shading_normal(const float *n, const struct triangle *t,
                                           float b1, float b2, struct vec3 *normal)
{
    struct vec3 n0 = triangle_corner(n, t->i0);
    struct vec3 m = vec3_scale(n0, 1.0f - b1 - b2);
    m = vec3_mad(m, b1, triangle_corner(n, t->i1));
    m = vec3_mad(m, b2, triangle_corner(n, t->i2));
    float squared = vec3_dot(m, m);
    if (!(squared > 1e-12f))
        return false;
    *normal = vec3_scale(m, 1.0f / sqrtf(squared));
    return true;
}

/* The place with ng on its final side, and the shading normal there. Shading normals
 * decide the side where there are some; else the winding; both are turned by flip. */
static inline struct anchor triangle_place(const struct shape *shape, uint32_t triangle,
                                           const struct triangle *t, float b1, float b2,
                                           struct vec3 *normal)
{
    struct anchor at = triangle_anchor(t, shape->face + 4 * (size_t)triangle, b1, b2);
    if (shape->flip)
        at.ng = vec3_neg(at.ng);
    *normal = at.ng;
    if (shape->n && triangle_shading_normal(shape->n, t, b1, b2, normal)) {
        if (shape->flip)
            *normal = vec3_neg(*normal);
        if (vec3_dot(at.ng, *normal) < 0.0f)
            at.ng = vec3_neg(at.ng);
    }
    return at;
}

#endif
