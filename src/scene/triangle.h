#ifndef ETALON_SCENE_TRIANGLE_H
#define ETALON_SCENE_TRIANGLE_H

/* One triangle of a mesh: a point on it, its normals, and the distance that clears the
 * rounding errors. Shared by hits and by lights, so that both see one surface.
 *
 * With e = 2^-24 and, along axis k, P the place's coordinate, E the larger of the edges'
 * extents, n the normal's component and D the error of the normal as a fast intersector
 * computes it (from edges rounded before their cross product), the errors along the
 * normal are at most, to first order in e, the sums over k of
 *   p0 + (b1 e1 + b2 e2) in floats         n e (P + 3 E)
 *   rounding of p + offset ng              n e P
 *   the side of the plane, Ng . (v0 - o)   n e 5 E + D E / |Ng|,
 * together e sum n (2 P + 8 E) + sum D E / |Ng|; twice that is used. So a triangle across
 * an axis, which is represented exactly, has almost no offset, and a thin triangle has a
 * large one only if its normal is inaccurate: D E / |Ng| is up to 3 e E / sin of the
 * angle between its edges. An error of (b1, b2) does not matter: any weights give a point
 * of the plane. The parts with E are the triangle's own; they are computed in double, as
 * is the unit normal (of the winding), and kept in triangles.edge_offset or in
 * triangles.records.
 *
 * A hit reads its triangle from memory that is in no cache, mostly. A record holds all
 * that it reads in one or two cache lines, whose address needs nothing but the number of
 * the triangle; without records the indices must be there before the corners are asked
 * for, and each corner has up to three lines. */

#include "base/log.h"
#include "math/warp.h"
#include "scene/hit.h"

#define TRIANGLE_EPSILON 0x1p-24f

/* Floats of a record: corners, normal, edge offset, which fill a cache line; then, if the
 * mesh has any of these, shading normals and uv in a second one. */
enum triangle_record {
    TRIANGLE_RECORD_P = 0,      /* 9 */
    TRIANGLE_RECORD_FACE = 9,   /* 4 */
    TRIANGLE_RECORD_PLAIN = 16, /* length without the rest */
    TRIANGLE_RECORD_N = 16,     /* 9 */
    TRIANGLE_RECORD_UV = 25,    /* 6 */
    TRIANGLE_RECORD_FULL = 32,
};

/* The triangles of a mesh. */
struct triangles {
    const uint32_t *index; /* of the mesh */
    const float *p, *n, *uv;
    /* One of these. */
    const float *records; /* [count][stride], or NULL; of the scene */
    float *edge_offset;   /* [count], or NULL; owned */
    uint32_t count;
    uint8_t stride; /* TRIANGLE_RECORD_PLAIN or _FULL */
    bool flip;      /* flips normals relative to winding or mesh normals */
};

/* The arrays n and uv, and the numbers of the corners in them: those of the mesh, or of
 * the record. */
struct triangle {
    struct vec3 p0, e1, e2;
    uint32_t i0, i1, i2;
    const float *n, *uv; /* or NULL */
};

static inline struct vec3 triangle_corner(const float *at, uint32_t index)
{
    const float *v = at + 3 * (size_t)index;
    return (struct vec3){v[0], v[1], v[2]};
}

static inline const float *triangle_record(const struct triangles *mesh,
                                           uint32_t triangle)
{
    return mesh->records + (size_t)mesh->stride * triangle;
}

static inline struct triangle triangle_load(const struct triangles *mesh,
                                            uint32_t triangle)
{
    const float *p = mesh->p;
    struct triangle t = {.i1 = 1, .i2 = 2, .n = mesh->n, .uv = mesh->uv};
    if (mesh->records) {
        p = triangle_record(mesh, triangle);
        t.n = mesh->n ? p + TRIANGLE_RECORD_N : NULL;
        t.uv = mesh->uv ? p + TRIANGLE_RECORD_UV : NULL;
    } else {
        const uint32_t *i = mesh->index + 3 * (size_t)triangle;
        t.i0 = i[0], t.i1 = i[1], t.i2 = i[2];
    }
    t.p0 = triangle_corner(p, t.i0);
    t.e1 = vec3_sub(triangle_corner(p, t.i1), t.p0);
    t.e2 = vec3_sub(triangle_corner(p, t.i2), t.p0);
    return t;
}

/* Edges from the first corner and their cross product; returns its length. */
static inline double triangle_cross(const struct triangles *mesh, uint32_t triangle,
                                    double e1[3], double e2[3], double n[3])
{
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    const float *p0 = mesh->p + 3 * (size_t)index[0];
    const float *p1 = mesh->p + 3 * (size_t)index[1];
    const float *p2 = mesh->p + 3 * (size_t)index[2];
    for (int k = 0; k < 3; k++) {
        e1[k] = (double)p1[k] - (double)p0[k];
        e2[k] = (double)p2[k] - (double)p0[k];
    }
    n[0] = e1[1] * e2[2] - e1[2] * e2[1];
    n[1] = e1[2] * e2[0] - e1[0] * e2[2];
    n[2] = e1[0] * e2[1] - e1[1] * e2[0];
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* The larger of the two edges' extents along each axis. */
static inline struct vec3 triangle_extent(const struct triangle *t)
{
    return vec3(fmaxf(fabsf(t->e1.x), fabsf(t->e2.x)),
                fmaxf(fabsf(t->e1.y), fabsf(t->e2.y)),
                fmaxf(fabsf(t->e1.z), fabsf(t->e2.z)));
}

/* The triangle's normal and edge offset, into *made. For meshes without records. */
void triangle_make_face(const struct triangles *mesh, uint32_t triangle, float made[4]);

/* The same: those of its record, or made. */
static inline const float *triangle_face(const struct triangles *mesh, uint32_t triangle,
                                         float made[4])
{
    if (mesh->records)
        return triangle_record(mesh, triangle) + TRIANGLE_RECORD_FACE;
    triangle_make_face(mesh, triangle, made);
    return made;
}

/* p0 + b1 e1 + b2 e2 with its offset; ng on the side of the winding. */
static inline struct ray_endpoint triangle_endpoint(const struct triangle *t,
                                                    const float *face, float b1, float b2)
{
    struct ray_endpoint at;
    at.p = vec3_add(t->p0, vec3_mad(vec3_scale(t->e1, b1), b2, t->e2));
    at.ng = (struct vec3){face[0], face[1], face[2]};
    at.offset = 4.0f * TRIANGLE_EPSILON * abs_components_dot(at.ng, at.p) + face[3];
    at.far_offset = 0.0f;
    return at;
}

/* Interpolated shading normal, unit; false where the corners cancel. */
static inline bool triangle_shading_normal(const struct triangle *t, float b1, float b2,
                                           struct vec3 *normal)
{
    struct vec3 n0 = triangle_corner(t->n, t->i0);
    struct vec3 m = vec3_scale(n0, 1.0f - b1 - b2);
    m = vec3_mad(m, b1, triangle_corner(t->n, t->i1));
    m = vec3_mad(m, b2, triangle_corner(t->n, t->i2));
    float squared = vec3_dot(m, m);
    if (!(squared > 1e-12f))
        return false;
    *normal = vec3_scale(m, 1.0f / sqrtf(squared));
    return true;
}

/* The place with ng on its final side, and the shading normal there. Shading normals
 * decide the side where there are some; else the winding; both are turned by flip. */
static inline struct ray_endpoint triangle_place(const struct triangles *mesh,
                                                 uint32_t triangle,
                                                 const struct triangle *t, float b1,
                                                 float b2, struct vec3 *normal)
{
    float made[4];
    struct ray_endpoint at = triangle_endpoint(t, triangle_face(mesh, triangle, made), b1,
                                               b2);
    if (mesh->flip)
        at.ng = vec3_neg(at.ng);
    *normal = at.ng;
    if (t->n && triangle_shading_normal(t, b1, b2, normal)) {
        if (mesh->flip)
            *normal = vec3_neg(*normal);
        if (vec3_dot(at.ng, *normal) < 0.0f)
            at.ng = vec3_neg(at.ng);
    }
    return at;
}

/* The place at (b1, b2), the weights of corners 1 and 2; ng as at a hit. */
static inline struct ray_endpoint triangle_point(const struct triangles *mesh,
                                                 uint32_t triangle, float b1, float b2)
{
    struct triangle t = triangle_load(mesh, triangle);
    struct vec3 normal;
    return triangle_place(mesh, triangle, &t, b1, b2, &normal);
}

/* The weights of corners 1 and 2 at the place of the plane next to p. */
static inline struct vec2 triangle_weights(const struct triangles *mesh,
                                           uint32_t triangle, struct vec3 p)
{
    double e1[3], e2[3], n[3], d1 = 0.0, d2 = 0.0;
    double length = triangle_cross(mesh, triangle, e1, e2, n), square = length * length;
    const float *p0 = mesh->p + 3 * (size_t)mesh->index[3 * (size_t)triangle];
    const double d[3] = {(double)p.x - (double)p0[0], (double)p.y - (double)p0[1],
                         (double)p.z - (double)p0[2]};
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        d1 += n[k] * (d[i] * e2[j] - d[j] * e2[i]);
        d2 += n[k] * (e1[i] * d[j] - e1[j] * d[i]);
    }
    return (struct vec2){d1 / square, d2 / square};
}

/* Fills edge_offset; returns whether much of the area lies in thin triangles. */
bool triangle_build_offsets(struct triangles *mesh, const struct place *at,
                            struct log *log);
/* Whether the shading normals only repeat the geometric ones: +1 on the winding's side
 * throughout, -1 on the other, 0 if they say more. Wants the offsets. */
int triangle_flat_side(const struct triangles *mesh);
/* Floats of all records, a multiple of TRIANGLE_RECORD_PLAIN, once n and uv are final. */
size_t triangle_record_floats(const struct triangles *mesh);
/* Fills records in and uses them; drops the offsets, which they repeat. */
void triangle_use_records(struct triangles *mesh, float *records);
double triangle_area(const struct triangles *mesh, uint32_t triangle);

#endif
