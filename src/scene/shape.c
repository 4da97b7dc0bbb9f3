#include "scene/shape.h"

#include "base/mem.h"

/* Counts triangles on whose parameters no map of normals can be laid. */
static void note_degenerate_uv(const struct mesh *mesh, const struct place *at,
                               struct log *log)
{
    uint32_t count = 0;
    for (uint32_t i = 0; mesh->uv && i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->index + 3 * (size_t)i;
        const float *a = mesh->uv + 2 * (size_t)corner[0];
        const float *b = mesh->uv + 2 * (size_t)corner[1];
        const float *c = mesh->uv + 2 * (size_t)corner[2];
        count += (b[0] - a[0]) * (c[1] - a[1]) == (b[1] - a[1]) * (c[0] - a[0]);
    }
    if (count > 0)
        log_note(log, at,
                 "a bump or normal map does not turn %u of %u triangles, whose uv are "
                 "degenerate",
                 count, mesh->triangle_count);
}

static bool shape_build_mesh(struct shape *shape, const struct shape_desc *desc,
                             struct log *log, struct err *err)
{
    if (!desc->mesh)
        return err_set(err, ERR_VALUE, &desc->place, "a mesh shape without a mesh");
    if (!mesh_check(desc->mesh, &desc->place, log, err))
        return false;
    if (desc->emits)
        mesh_drop_repeated(desc->mesh, &desc->place, log);
    const struct mesh *mesh = desc->mesh;
    struct triangles *t = &shape->triangles;
    *t = (struct triangles){
        .index = mesh->index,
        .p = mesh->p,
        .n = mesh->n,
        .uv = mesh->uv,
        .count = mesh->triangle_count,
        .flip = desc->reverse_orientation,
    };
    shape->thin = triangle_build_offsets(t, &desc->place, log);
    int side = t->n ? triangle_flat_side(t) : 0;
    if (side != 0) {
        t->n = NULL;
        t->flip ^= side < 0;
    }
    if (shape->bsdf->relief.texture)
        note_degenerate_uv(mesh, &desc->place, log);
    return true;
}

bool shape_build(struct shape *shape, struct shape_desc *desc,
                 const struct bsdf *materials, struct log *log, struct err *err)
{
    *shape = (struct shape){.light = -1};
    shape->bsdf = &materials[desc->material];
    shape->aligned = (shape->bsdf->flags & BSDF_ANISOTROPIC) != 0;
    if (desc->kind == SHAPE_MESH)
        return shape_build_mesh(shape, desc, log, err);
    if (shape->bsdf->relief.texture)
        log_note(log, &desc->place,
                 "a bump or normal map on a sphere, disk or cylinder is left out");
    shape->quadric = mem_alloc(1, sizeof *shape->quadric);
    return quadric_init(shape->quadric, desc, err);
}

void shape_deinit(struct shape *shape)
{
    mem_free(shape->triangles.edge_offset);
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
    for (uint32_t i = 0; i < shape->triangles.count; i++)
        sum += triangle_area(&shape->triangles, i);
    return sum;
}
