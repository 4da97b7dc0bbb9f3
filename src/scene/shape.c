#include "scene/shape.h"

#include "base/mem.h"
#include "scene/triangle.h"

/* Height over longest edge below which Moeller and Trumbore's test loses a triangle's
 * edges: the flag that cures it costs a fifth of all rays, so it is not set for less. */
#define SHAPE_THIN 1e-4

/* Shading normals within this of the geometric one say nothing new. */
#define SHAPE_FLAT 1e-6f

static double corner_distance2(const float *a, const float *b)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double d = (double)a[k] - (double)b[k];
        sum += d * d;
    }
    return sum;
}

static double triangle_area(const struct shape *shape, uint32_t triangle)
{
    const uint32_t *index = shape->index + 3 * (size_t)triangle;
    const float *p0 = shape->p + 3 * (size_t)index[0];
    double e[2][3], cross[3], sum = 0.0;
    for (int j = 0; j < 2; j++)
        for (int k = 0; k < 3; k++)
            e[j][k] = (double)shape->p[3 * (size_t)index[j + 1] + (size_t)k] -
                      (double)p0[k];
    for (int k = 0; k < 3; k++) {
        cross[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] -
                   e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
        sum += cross[k] * cross[k];
    }
    return 0.5 * sqrt(sum);
}

static bool shape_has_thin(const struct shape *shape)
{
    for (uint32_t i = 0; i < shape->triangle_count; i++) {
        const uint32_t *index = shape->index + 3 * (size_t)i;
        const float *a = shape->p + 3 * (size_t)index[0];
        const float *b = shape->p + 3 * (size_t)index[1];
        const float *c = shape->p + 3 * (size_t)index[2];
        double longest = fmax(corner_distance2(a, b),
                              fmax(corner_distance2(b, c), corner_distance2(c, a)));
        if (2.0 * triangle_area(shape, i) < SHAPE_THIN * longest)
            return true;
    }
    return false;
}

/* Whether the shading normals only repeat the geometric ones: +1 on the winding's side
 * throughout, -1 on the other, 0 if they say more. */
static int shape_flat_side(const struct shape *shape)
{
    int side = 0;
    for (uint32_t i = 0; i < shape->triangle_count; i++) {
        struct triangle t = triangle_load(shape, i);
        struct vec3 ng = triangle_anchor(&t, 0.0f, 0.0f).ng;
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
                             struct log *log, struct err *err)
{
    if (!desc->mesh)
        return err_set(err, ERR_VALUE, &desc->place, "a mesh shape without a mesh");
    if (!mesh_check(desc->mesh, &desc->place, log, err))
        return false;
    const struct mesh *mesh = desc->mesh;
    shape->index = mesh->index;
    shape->p = mesh->p;
    shape->n = mesh->n;
    shape->uv = mesh->uv;
    shape->triangle_count = mesh->triangle_count;
    shape->thin = shape_has_thin(shape);
    int side = shape->n ? shape_flat_side(shape) : 0;
    if (side != 0) {
        shape->n = NULL;
        shape->flip ^= side < 0;
    }
    return true;
}

bool shape_build(struct shape *shape, struct shape_desc *desc,
                 const struct bsdf *materials, struct log *log, struct err *err)
{
    *shape = (struct shape){.light = -1, .flip = desc->reverse_orientation};
    shape->bsdf = &materials[desc->material];
    shape->aligned = (shape->bsdf->flags & BSDF_ANISOTROPIC) != 0;
    if (desc->kind == SHAPE_MESH)
        return shape_build_mesh(shape, desc, log, err);
    shape->quadric = mem_alloc(1, sizeof *shape->quadric);
    return quadric_init(shape->quadric, desc, err);
}

void shape_deinit(struct shape *shape)
{
    mem_free(shape->quadric);
}

double shape_area(const struct shape *shape)
{
    if (shape->quadric)
        return quadric_area(shape->quadric);
    double sum = 0.0;
    for (uint32_t i = 0; i < shape->triangle_count; i++)
        sum += triangle_area(shape, i);
    return sum;
}

void shape_triangle_areas(const struct shape *shape, double *areas)
{
    for (uint32_t i = 0; i < shape->triangle_count; i++)
        areas[i] = triangle_area(shape, i);
}

struct anchor shape_triangle_point(const struct shape *shape, uint32_t triangle, float b1,
                                   float b2)
{
    struct triangle t = triangle_load(shape, triangle);
    struct vec3 normal;
    return triangle_place(shape, &t, b1, b2, &normal);
}
