#include "scene/triangle.h"

#include "base/mem.h"

#include <string.h>

/* Height over longest edge below which a triangle is thin, and the share of a mesh's area
 * in thin triangles above which Embree's robust flag is set. Measured in a closed room of
 * thin triangles, of 1e5 rays the fast test loses none at 3e-3 and 18 at 3e-4, and the
 * robust one none. The flag costs a third of all rays' speed, so a few thin triangles do
 * not set it. */
#define TRIANGLE_THIN       1e-3
#define TRIANGLE_THIN_SHARE 0.01

/* Shading normals within this of the geometric one are dropped. */
#define TRIANGLE_FLAT 1e-6f

/* The least offset, relative to the triangle's size: a ray that starts exactly in the
 * plane would depend on the sign of zero. */
#define TRIANGLE_OFFSET_LEAST 0x1p-34

/* Offsets larger than this share of the longest edge are noted. */
#define TRIANGLE_OFFSET_MUCH 0x1p-10

struct face {
    double area;
    double longest; /* edge */
    double offset;  /* edge part of the header's bound */
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* D of the header: how far component k of e1 x e2 can be off in floats, with or without
 * fused operations. */
static double face_normal_error(const double e1[3], const double e2[3], int k)
{
    int i = (k + 1) % 3, j = (k + 2) % 3;
    float a = (float)e1[i], b = (float)e2[j], c = (float)e1[j], d = (float)e2[i];
    double exact = e1[i] * e2[j] - e1[j] * e2[i];
    float plain = a * b - c * d, left = fmaf(a, b, -(c * d)), right = fmaf(-c, d, a * b);
    return fmax(fabs((double)plain - exact),
                fmax(fabs((double)left - exact), fabs((double)right - exact)));
}

/* The parts of the header's bound that the edges make; length: |e1 x e2|. */
static double face_offset(const double e1[3], const double e2[3], const double n[3],
                          double length)
{
    double sum = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        double extent = fmax(fabs(e1[k]), fabs(e2[k]));
        double error = 2.0 * face_normal_error(e1, e2, k);
        sum += (16.0 * (double)TRIANGLE_EPSILON * fabs(n[k]) + error) / length * extent;
        size = fmax(size, extent);
    }
    return sum + TRIANGLE_OFFSET_LEAST * size;
}

static struct face face_compute(const struct triangles *mesh, uint32_t triangle)
{
    struct face face;
    double e1[3], e2[3], e3[3], n[3];
    double length = triangle_cross(mesh, triangle, e1, e2, n);
    for (int k = 0; k < 3; k++)
        e3[k] = e2[k] - e1[k];
    face.area = 0.5 * length;
    face.longest = sqrt(fmax(dot(e3, e3), fmax(dot(e1, e1), dot(e2, e2))));
    face.offset = face_offset(e1, e2, n, length);
    return face;
}

/* Four floats loaded at once; the fourth is not used. */
typedef float triangle_float4 __attribute__((vector_size(16), aligned(4), may_alias));
typedef double triangle_double4 __attribute__((vector_size(32)));
#define TRIANGLE_WIDE(v) \
    __builtin_convertvector(*(const triangle_float4 *)(const void *)(v), triangle_double4)
#define TRIANGLE_TURN(v, i, j, k) ((triangle_double4){(v)[i], (v)[j], (v)[k], 0.0})

/* The unit normal of the winding, by the operations of triangle_cross in their order, so
 * to the same bits. The corners may be read beyond their end, see mesh.h. */
static void triangle_normal(const struct triangles *mesh, uint32_t triangle,
                            float normal[3])
{
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    triangle_double4 p0 = TRIANGLE_WIDE(mesh->p + 3 * (size_t)index[0]);
    triangle_double4 e1 = TRIANGLE_WIDE(mesh->p + 3 * (size_t)index[1]) - p0;
    triangle_double4 e2 = TRIANGLE_WIDE(mesh->p + 3 * (size_t)index[2]) - p0;
    triangle_double4 n = TRIANGLE_TURN(e1, 1, 2, 0) * TRIANGLE_TURN(e2, 2, 0, 1) -
                         TRIANGLE_TURN(e1, 2, 0, 1) * TRIANGLE_TURN(e2, 1, 2, 0);
    triangle_double4 squares = n * n;
    n /= sqrt(squares[0] + squares[1] + squares[2]);
    for (int k = 0; k < 3; k++)
        normal[k] = (float)n[k];
}

void triangle_make_face(const struct triangles *mesh, uint32_t triangle, float made[4])
{
    triangle_normal(mesh, triangle, made);
    made[3] = mesh->edge_offset[triangle];
}

bool triangle_build_offsets(struct triangles *mesh, const struct place *at,
                            struct log *log)
{
    double area = 0.0, thin = 0.0;
    mesh->edge_offset = mem_alloc((size_t)mesh->count + 1, sizeof(float));
    for (uint32_t i = 0; i < mesh->count; i++) {
        struct face face = face_compute(mesh, i);
        mesh->edge_offset[i] = (float)face.offset;
        if (face.offset > TRIANGLE_OFFSET_MUCH * face.longest)
            log_note(log, at,
                     "a triangle so thin that its normal is not known well: what lies "
                     "within %g of its length above it may be missed",
                     TRIANGLE_OFFSET_MUCH);
        area += face.area;
        if (2.0 * face.area < TRIANGLE_THIN * face.longest * face.longest)
            thin += face.area;
    }
    return thin > TRIANGLE_THIN_SHARE * area;
}

int triangle_flat_side(const struct triangles *mesh)
{
    int side = 0;
    for (uint32_t i = 0; i < mesh->count; i++) {
        struct triangle t = triangle_load(mesh, i);
        float made[4];
        const float *face = triangle_face(mesh, i, made);
        struct vec3 ng = vec3(face[0], face[1], face[2]);
        const uint32_t corner[3] = {t.i0, t.i1, t.i2};
        for (int k = 0; k < 3; k++) {
            float cos = vec3_dot(ng, triangle_corner(mesh->n, corner[k]));
            int here = cos > 1.0f - TRIANGLE_FLAT    ? 1
                       : cos < -1.0f + TRIANGLE_FLAT ? -1
                                                     : 0;
            if (here == 0 || (side != 0 && side != here))
                return 0;
            side = here;
        }
    }
    return side;
}

static void fill_record(const struct triangles *mesh, uint32_t triangle, float *record)
{
    const uint32_t *corner = mesh->index + 3 * (size_t)triangle;
    for (size_t k = 0; k < 3; k++) {
        float *p = record + TRIANGLE_RECORD_P + 3 * k;
        memcpy(p, mesh->p + 3 * (size_t)corner[k], 3 * sizeof *p);
        if (mesh->n)
            memcpy(record + TRIANGLE_RECORD_N + 3 * k, mesh->n + 3 * (size_t)corner[k],
                   3 * sizeof *p);
        if (mesh->uv)
            memcpy(record + TRIANGLE_RECORD_UV + 2 * k, mesh->uv + 2 * (size_t)corner[k],
                   2 * sizeof *p);
    }
    triangle_make_face(mesh, triangle, record + TRIANGLE_RECORD_FACE);
}

static size_t record_stride(const struct triangles *mesh)
{
    return mesh->n || mesh->uv ? TRIANGLE_RECORD_FULL : TRIANGLE_RECORD_PLAIN;
}

size_t triangle_record_floats(const struct triangles *mesh)
{
    return mesh->count * record_stride(mesh);
}

void triangle_use_records(struct triangles *mesh, float *records)
{
    mesh->stride = (uint8_t)record_stride(mesh);
    for (uint32_t i = 0; i < mesh->count; i++)
        fill_record(mesh, i, records + (size_t)mesh->stride * i);
    mesh->records = records;
    mem_free(mesh->edge_offset);
    mesh->edge_offset = NULL;
}

double triangle_area(const struct triangles *mesh, uint32_t triangle)
{
    return face_compute(mesh, triangle).area;
}
