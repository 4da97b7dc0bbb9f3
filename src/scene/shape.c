#include "scene/shape.h"

#include "base/mem.h"
#include "scene/triangle.h"

/* Height over longest edge below which a triangle is thin, and the share of a mesh's area
 * in thin ones from which on the robust flag is asked for. Measured in a closed room all
 * of thin triangles, the fast test lets no ray in 1e5 through at 3e-3, and 18 at 3e-4,
 * the robust one none; it costs a third of all rays there, so a few needles do not set
 * it. */
#define SHAPE_THIN       1e-3
#define SHAPE_THIN_SHARE 0.01

/* Shading normals within this of the geometric one say nothing new. */
#define SHAPE_FLAT 1e-6f

/* The least offset, in units of the triangle's size: a ray from the very plane would be
 * a matter of the sign of zero. */
#define SHAPE_OFFSET_LEAST 0x1p-34

/* Offsets beyond this share of the longest edge are told. */
#define SHAPE_OFFSET_MUCH 0x1p-10

struct face {
    double normal[3]; /* unit, of the winding */
    double area;
    double longest; /* edge */
    double offset;  /* edge part of triangle.h's bound */
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* D of triangle.h: how far component k of e1 x e2 can be off in floats, with or without
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

/* The parts of triangle.h's bound that the edges make; length: |e1 x e2|. */
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
    return sum + SHAPE_OFFSET_LEAST * size;
}

static struct face face_compute(const struct shape *shape, uint32_t triangle)
{
    struct face face;
    double e1[3], e2[3], e3[3], n[3];
    double length = triangle_cross(shape, triangle, e1, e2, n);
    for (int k = 0; k < 3; k++) {
        e3[k] = e2[k] - e1[k];
        face.normal[k] = n[k] / length;
    }
    face.area = 0.5 * length;
    face.longest = sqrt(fmax(dot(e3, e3), fmax(dot(e1, e1), dot(e2, e2))));
    face.offset = face_offset(e1, e2, n, length);
    return face;
}

static void shape_build_faces(struct shape *shape, bool keep, const struct place *at,
                              struct log *log)
{
    double area = 0.0, thin = 0.0;
    size_t count = (size_t)shape->triangle_count + 1;
    if (keep)
        shape->face = mem_alloc(4 * count, sizeof(float));
    else
        shape->edge_offset = mem_alloc(count, sizeof(float));
    for (uint32_t i = 0; i < shape->triangle_count; i++) {
        struct face face = face_compute(shape, i);
        for (size_t k = 0; keep && k < 3; k++)
            shape->face[4 * (size_t)i + k] = (float)face.normal[k];
        *(keep ? &shape->face[4 * (size_t)i + 3]
               : &shape->edge_offset[i]) = (float)face.offset;
        if (face.offset > SHAPE_OFFSET_MUCH * face.longest)
            log_note(log, at,
                     "a triangle so thin that its normal is not known well: what lies "
                     "within %g of its length above it may be missed",
                     SHAPE_OFFSET_MUCH);
        area += face.area;
        if (2.0 * face.area < SHAPE_THIN * face.longest * face.longest)
            thin += face.area;
    }
    shape->thin = thin > SHAPE_THIN_SHARE * area;
}

/* Whether the shading normals only repeat the geometric ones: +1 on the winding's side
 * throughout, -1 on the other, 0 if they say more. */
static int shape_flat_side(const struct shape *shape)
{
    int side = 0;
    for (uint32_t i = 0; i < shape->triangle_count; i++) {
        struct triangle t = triangle_load(shape, i);
        float made[4];
        const float *face = triangle_face(shape, i, made);
        struct vec3 ng = vec3(face[0], face[1], face[2]);
        const uint32_t corner[3] = {t.i0, t.i1, t.i2};
        for (int k = 0; k < 3; k++) {
            float cos = vec3_dot(ng, triangle_corner(shape->n, corner[k]));
            int here = cos > 1.0f - SHAPE_FLAT ? 1 : cos < -1.0f + SHAPE_FLAT ? -1 : 0;
            if (here == 0 || (side != 0 && side != here))
                return 0;
            side = here;
        }
    }
    return side;
}

static bool shape_build_mesh(struct shape *shape, const struct shape_desc *desc,
                             bool keep_faces, struct log *log, struct err *err)
{
    if (!desc->mesh)
        return err_set(err, ERR_VALUE, &desc->place, "a mesh shape without a mesh");
    if (!mesh_check(desc->mesh, &desc->place, log, err))
        return false;
    if (desc->emits)
        mesh_drop_repeated(desc->mesh, &desc->place, log);
    const struct mesh *mesh = desc->mesh;
    shape->index = mesh->index;
    shape->p = mesh->p;
    shape->n = mesh->n;
    shape->uv = mesh->uv;
    shape->triangle_count = mesh->triangle_count;
    shape_build_faces(shape, keep_faces, &desc->place, log);
    int side = shape->n ? shape_flat_side(shape) : 0;
    if (side != 0) {
        shape->n = NULL;
        shape->flip ^= side < 0;
    }
    return true;
}

bool shape_build(struct shape *shape, struct shape_desc *desc,
                 const struct bsdf *materials, bool keep_faces, struct log *log,
                 struct err *err)
{
    *shape = (struct shape){.light = -1, .flip = desc->reverse_orientation};
    shape->bsdf = &materials[desc->material];
    shape->aligned = (shape->bsdf->flags & BSDF_ANISOTROPIC) != 0;
    if (desc->kind == SHAPE_MESH)
        return shape_build_mesh(shape, desc, keep_faces, log, err);
    if (shape->bsdf->bump)
        log_note(log, &desc->place,
                 "a bump map on a sphere, disk or cylinder is left out");
    shape->quadric = mem_alloc(1, sizeof *shape->quadric);
    return quadric_init(shape->quadric, desc, err);
}

void shape_deinit(struct shape *shape)
{
    mem_free(shape->face);
    mem_free(shape->edge_offset);
    mem_free(shape->quadric);
}

void shape_bounds(const struct shape *shape, const struct mesh *mesh, float lower[3],
                  float upper[3])
{
    if (shape->quadric) {
        quadric_bounds(shape->quadric, lower, upper);
        return;
    }
    for (int k = 0; k < 3; k++) {
        lower[k] = INFINITY;
        upper[k] = -INFINITY;
    }
    for (size_t v = 0; v < 3 * (size_t)mesh->vertex_count; v++) {
        lower[v % 3] = fminf(lower[v % 3], mesh->p[v]);
        upper[v % 3] = fmaxf(upper[v % 3], mesh->p[v]);
    }
}

double shape_area(const struct shape *shape)
{
    if (shape->quadric)
        return quadric_area(shape->quadric);
    double sum = 0.0;
    for (uint32_t i = 0; i < shape->triangle_count; i++)
        sum += face_compute(shape, i).area;
    return sum;
}

void shape_triangle_areas(const struct shape *shape, double *areas)
{
    for (uint32_t i = 0; i < shape->triangle_count; i++)
        areas[i] = face_compute(shape, i).area;
}

struct anchor shape_triangle_point(const struct shape *shape, uint32_t triangle, float b1,
                                   float b2)
{
    struct triangle t = triangle_load(shape, triangle);
    struct vec3 normal;
    return triangle_place(shape, triangle, &t, b1, b2, &normal);
}
