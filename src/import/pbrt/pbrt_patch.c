/* Shapes over a grid of parameters: bilinear patches and height fields. */
#include "import/pbrt/pbrt_shape.h"

#include <math.h>
#include <string.h>

#define CUTS          8 /* of a patch that is no parallelogram, each way */
#define VERTICES_MOST ((size_t)1 << 27)

/* What stands at a patch's corners, in pbrt's order: (u,v) = (0,0), (1,0), (0,1), (1,1).
 */
static double bilinear(const double *numbers, int width, const size_t corner[4], int k,
                       double u, double v)
{
    double c[4];
    for (int i = 0; i < 4; i++)
        c[i] = numbers[(size_t)width * corner[i] + (size_t)k];
    return (1.0 - v) * ((1.0 - u) * c[0] + u * c[1]) + v * ((1.0 - u) * c[2] + u * c[3]);
}

/* A parallelogram: its two triangles are all of it, and so is their uv. */
static bool is_flat(const double *points, const size_t corner[4])
{
    double twist = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        double c[4];
        for (int i = 0; i < 4; i++)
            c[i] = points[3 * corner[i] + (size_t)k];
        twist = fmax(twist, fabs(c[0] - c[1] - c[2] + c[3]));
        size = fmax(size, fmax(fabs(c[3] - c[0]), fabs(c[2] - c[1])));
    }
    return twist <= 1e-5 * size;
}

struct patches {
    const double *points, *normals, *uv; /* the last two may be NULL */
    const double *index;                 /* NULL: one patch of four points */
    size_t count;
};

static void corners_of(const struct patches *patches, size_t patch, size_t corner[4])
{
    for (size_t i = 0; i < 4; i++)
        corner[i] = patches->index ? (size_t)patches->index[4 * patch + i] : i;
}

static void add_patch(struct mesh *mesh, const struct patches *patches,
                      const size_t corner[4], uint32_t cuts)
{
    uint32_t first = mesh->vertex_count;
    for (uint32_t j = 0; j <= cuts; j++)
        for (uint32_t i = 0; i <= cuts; i++) {
            size_t v = mesh->vertex_count++;
            double s[2] = {(double)i / cuts, (double)j / cuts};
            for (int k = 0; k < 3; k++) {
                mesh->p[3 * v + (size_t)k] = (float)bilinear(patches->points, 3, corner,
                                                             k, s[0], s[1]);
                if (patches->normals)
                    mesh->n[3 * v + (size_t)k] = (float)bilinear(patches->normals, 3,
                                                                 corner, k, s[0], s[1]);
            }
            for (int k = 0; k < 2; k++)
                mesh->uv[2 * v + (size_t)k] =
                    (float)(patches->uv ? bilinear(patches->uv, 2, corner, k, s[0], s[1])
                                        : s[k]);
        }
    pbrt_shape_add_cells(mesh, first, cuts, cuts);
}

static struct mesh *cut_patches(const struct patches *patches, bool *bent)
{
    size_t vertices = 0, cells = 0, corner[4];
    *bent = false;
    for (size_t i = 0; i < patches->count; i++) {
        corners_of(patches, i, corner);
        bool flat = is_flat(patches->points, corner);
        size_t cuts = flat ? 1 : CUTS;
        vertices += (cuts + 1) * (cuts + 1);
        cells += cuts * cuts;
        *bent |= !flat;
    }
    if (vertices > VERTICES_MOST)
        return NULL;
    struct mesh *mesh = mesh_create((uint32_t)vertices, (uint32_t)(2 * cells),
                                    patches->normals != NULL, true);
    mesh->vertex_count = mesh->triangle_count = 0;
    for (size_t i = 0; i < patches->count; i++) {
        corners_of(patches, i, corner);
        add_patch(mesh, patches, corner, is_flat(patches->points, corner) ? 1 : CUTS);
    }
    return mesh;
}

bool pbrt_patch_bilinear(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"faceIndices", NULL};
    struct pbrt_params *params = &p->params;
    const struct pbrt_param *index = pbrt_params_find(params, "indices", PBRT_INTEGER);
    const struct pbrt_param *points = pbrt_params_find(params, "P", PBRT_POINT);
    const struct pbrt_param *normals = pbrt_params_find(params, "N", PBRT_NORMAL);
    const struct pbrt_param *uv = pbrt_shape_uv(p);
    bool bent;
    pbrt_params_ignore(params, ignored);
    if (!points || points->count == 0 ||
        (index ? index->count == 0 || index->count % 4 != 0 : points->count != 12))
        return err_set(err, ERR_VALUE, &params->place,
                       "Shape \"bilinearmesh\" wants \"point3 P\" and \"integer "
                       "indices\" in fours");
    if (!pbrt_shape_count_is(normals, points->count, err) ||
        !pbrt_shape_count_is(uv, points->count / 3 * 2, err) ||
        !pbrt_shape_check_indices(p, index, points->count / 3, err))
        return false;
    const struct patches patches = {
        .points = pbrt_params_numbers(params, points),
        .normals = normals ? pbrt_params_numbers(params, normals) : NULL,
        .uv = uv ? pbrt_params_numbers(params, uv) : NULL,
        .index = index ? pbrt_params_numbers(params, index) : NULL,
        .count = index ? index->count / 4 : 1,
    };
    struct mesh *mesh = cut_patches(&patches, &bent);
    if (!mesh)
        return err_set(err, ERR_VALUE, &points->place, "the mesh is too large");
    if (bent)
        log_note(&p->desc->log, &params->place,
                 "bilinear patches that are no parallelograms are cut into %d triangles",
                 2 * CUTS * CUTS);
    return pbrt_shape_add_mesh(p, mesh, err);
}

/* v3: heights over the unit square. */
bool pbrt_patch_heightfield(struct pbrt *p, struct err *err)
{
    const struct pbrt_param *heights = pbrt_params_find(&p->params, "Pz", PBRT_FLOAT);
    int nu = 0, nv = 0;
    if (!pbrt_params_int(&p->params, "nu", &nu, err) ||
        !pbrt_params_int(&p->params, "nv", &nv, err))
        return false;
    if (!heights || nu < 2 || nv < 2 || heights->count / (size_t)nu != (size_t)nv ||
        heights->count % (size_t)nu != 0)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "Shape \"heightfield\" wants nu, nv of 2 or more and nu x nv "
                       "numbers Pz");
    uint32_t columns = (uint32_t)nu - 1, rows = (uint32_t)nv - 1;
    struct mesh *mesh = mesh_create((uint32_t)heights->count, 2 * columns * rows, false,
                                    true);
    const double *z = pbrt_params_numbers(&p->params, heights);
    for (size_t i = 0; i < heights->count; i++) {
        size_t row = i / (size_t)nu, column = i % (size_t)nu;
        float u = (float)column / (float)columns, v = (float)row / (float)rows;
        const float point[3] = {u, v, (float)z[i]};
        memcpy(mesh->p + 3 * i, point, sizeof point);
        mesh->uv[2 * i] = u;
        mesh->uv[2 * i + 1] = v;
    }
    mesh->triangle_count = 0;
    pbrt_shape_add_cells(mesh, 0, columns, rows);
    return pbrt_shape_add_mesh(p, mesh, err);
}
