#include "import/pbrt/pbrt_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "import/pbrt/pbrt_colour.h"
#include "import/pbrt/pbrt_mixture.h"
#include "import/pbrt/pbrt_shape.h"
#include "import/suggest.h"

#include <string.h>

static bool add_black(struct pbrt *p, const struct place *at, int *index, struct err *err)
{
    struct bsdf black;
    bsdf_init(&black, bsdf_find("black"));
    if (!bsdf_prepare(&black, at, err))
        return false;
    *index = scene_desc_add_material(p->desc, &black);
    return true;
}

/* The state's, or what stands for none. */
static bool choose_material(struct pbrt *p, const struct place *at, int *index,
                            struct err *err)
{
    *index = p->state.material;
    if (!pbrt_material_of_shape(p, index, err))
        return false;
    if (*index == PBRT_MATERIAL_NONE) {
        log_note(&p->desc->log, at, "an emitter without a material is taken as black");
        return add_black(p, at, index, err);
    }
    bool instances_say = p->in_object && p->lux;
    return *index != PBRT_MATERIAL_DEFAULT || instances_say ||
           pbrt_material_default(p, index, err);
}

/* Gives the shape what the graphics state holds; *seen: anything is left of it. */
static bool apply_state(struct pbrt *p, struct shape_desc *shape, bool *seen,
                        struct err *err)
{
    const struct pbrt_state *state = &p->state;
    struct pbrt_value alpha = {.value = rgb_grey(1.0)}, shadow = alpha;
    *seen = false;
    if (!pbrt_colour_float_value(p, "alpha", &alpha, err) ||
        !pbrt_colour_float_value(p, "shadowalpha", &shadow, err))
        return false;
    if (!alpha.texture && alpha.value.g == 0.0) {
        log_note(&p->desc->log, &shape->place, "shapes of alpha 0 are left out");
        return true;
    }
    shape->emits = state->emits;
    shape->two_sided = state->two_sided;
    shape->emission = state->emits ? state->emission : NULL;
    shape->radiance = state->emits ? pbrt_light_radiance(p, shape) : rgb_grey(0.0);
    if (state->material == PBRT_MATERIAL_NONE && !state->emits) {
        log_note(&p->desc->log, &shape->place,
                 "shapes without a material are left out: light passes through them");
        return true;
    }
    *seen = true;
    if (!choose_material(p, &shape->place, &shape->material, err))
        return false;
    bool masked = alpha.texture || alpha.value.g < 1.0;
    return !masked || shape->material == PBRT_MATERIAL_DEFAULT ||
           pbrt_mixture_masked(p, shape->material, pbrt_colour_node(p, &alpha),
                               &shape->material, err);
}

/* Takes the shape's mesh. */
bool pbrt_shape_add(struct pbrt *p, struct shape_desc *shape, struct err *err)
{
    bool seen;
    shape->place = p->params.place;
    bool ok = apply_state(p, shape, &seen, err);
    if (ok && seen)
        pbrt_object_add(p, shape);
    else
        mesh_destroy(shape->mesh);
    return ok;
}

bool pbrt_shape_add_turned_mesh(struct pbrt *p, struct mesh *mesh, bool reverse,
                                struct err *err)
{
    mesh_transform(mesh, &p->state.ctm);
    if (!mesh_check(mesh, &p->params.place, &p->desc->log, err)) {
        mesh_destroy(mesh);
        return false;
    }
    struct shape_desc shape = {.kind = SHAPE_MESH, .mesh = mesh};
    shape.to_world = xform_identity();
    shape.reverse_orientation = reverse;
    return pbrt_shape_add(p, &shape, err);
}

/* Without normals the winding decides the side, and pbrt v3 flips it if the transform
 * mirrors; normals decide by themselves. */
bool pbrt_shape_add_mesh(struct pbrt *p, struct mesh *mesh, struct err *err)
{
    bool flip = !mesh->n && xform_swaps_handedness(&p->state.ctm);
    return pbrt_shape_add_turned_mesh(p, mesh, p->state.reverse_orientation != flip, err);
}

/* LuxRender's subdivision of a mesh from a file, which is destroyed or returned. Texture
 * coordinates are not subdivided, so meshes that have them stay as they are. */
static struct mesh *subdivide(struct pbrt *p, struct mesh *mesh, int levels)
{
    struct mesh *smooth = mesh->uv ? NULL : mesh_loop(mesh, levels);
    if (smooth)
        mesh_destroy(mesh);
    else
        log_note(&p->desc->log, &p->params.place,
                 mesh->uv ? "the subdivision of a plymesh with texture coordinates is "
                            "left out"
                          : "the subdivision of a plymesh without a surface is left out");
    return smooth ? smooth : mesh;
}

/* levels: 0 without subdivision. */
static bool subdivision(struct pbrt *p, int *levels, struct err *err)
{
    static const char *const smoothing[] = {"dmnormalsmooth", "dmsharpboundary",
                                            "dmnormalsplit", NULL};
    *levels = 0;
    if (!p->lux || !pbrt_params_find(&p->params, "subdivscheme", PBRT_STRING))
        return true;
    pbrt_params_ignore(&p->params, smoothing);
    *levels = 2;
    if (!pbrt_params_int(&p->params, "nsubdivlevels", levels, err))
        return false;
    return (*levels >= 0 && *levels <= 10) ||
           err_set(err, ERR_VALUE, &p->params.place,
                   "nsubdivlevels must be from 0 to 10, not %d", *levels);
}

static bool plymesh(struct pbrt *p, struct err *err)
{
    int levels;
    if (!subdivision(p, &levels, err))
        return false;
    const struct pbrt_param *name = pbrt_params_find(&p->params, "filename", PBRT_STRING);
    if (!name || !name->is_string)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "Shape \"plymesh\" wants \"string filename\"");
    char *path = pbrt_path(p, pbrt_params_text(&p->params, name));
    struct mesh *mesh = ahead_mesh(p->ahead, import_ply, path, &name->place, err);
    mem_free(path);
    if (mesh && levels > 0)
        mesh = subdivide(p, mesh, levels);
    return mesh && pbrt_shape_add_mesh(p, mesh, err);
}

void pbrt_shape_add_cells(struct mesh *mesh, uint32_t first, uint32_t columns,
                          uint32_t rows)
{
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t a = first + j * (columns + 1) + i, c = a + columns + 1;
            const uint32_t corners[6] = {a, a + 1, c + 1, a, c + 1, c};
            memcpy(mesh->index + 3 * (size_t)mesh->triangle_count, corners,
                   sizeof corners);
            mesh->triangle_count += 2;
        }
}

bool pbrt_shape_count_is(const struct pbrt_param *param, size_t count, struct err *err)
{
    if (!param || param->count == count)
        return true;
    return err_set(err, ERR_VALUE, &param->place,
                   "%zu numbers do not fit the mesh's points, %zu are wanted",
                   param->count, count);
}

const struct pbrt_param *pbrt_shape_uv(struct pbrt *p)
{
    unsigned types = PBRT_FLOAT | PBRT_POINT2 | PBRT_VECTOR2;
    const struct pbrt_param *uv = pbrt_params_find(&p->params, "uv", types);
    return uv ? uv : pbrt_params_find(&p->params, "st", types);
}

static void copy_floats(const struct pbrt *p, const struct pbrt_param *from, float *to)
{
    const double *v = pbrt_params_numbers(&p->params, from);
    for (size_t i = 0; i < from->count; i++)
        to[i] = (float)v[i];
}

bool pbrt_shape_check_indices(const struct pbrt *p, const struct pbrt_param *index,
                              size_t points, struct err *err)
{
    const double *v = index ? pbrt_params_numbers(&p->params, index) : NULL;
    for (size_t i = 0; index && i < index->count; i++)
        if (!(v[i] >= 0.0 && v[i] < (double)points))
            return err_set(err, ERR_VALUE, &index->place,
                           "index %.0f is outside the mesh's %zu points", v[i], points);
    return true;
}

static bool copy_indices(const struct pbrt *p, const struct pbrt_param *from,
                         struct mesh *mesh, struct err *err)
{
    const double *v = pbrt_params_numbers(&p->params, from);
    if (!pbrt_shape_check_indices(p, from, mesh->vertex_count, err))
        return false;
    for (size_t i = 0; i < from->count; i++)
        mesh->index[i] = (uint32_t)v[i];
    return true;
}

static bool trianglemesh(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"faceIndices", "discarddegenerateUVs", NULL};
    struct pbrt_params *params = &p->params;
    const struct pbrt_param *index = pbrt_params_find(params, "indices", PBRT_INTEGER);
    const struct pbrt_param *points = pbrt_params_find(params, "P", PBRT_POINT);
    const struct pbrt_param *normals = pbrt_params_find(params, "N", PBRT_NORMAL);
    const struct pbrt_param *uv = pbrt_shape_uv(p);
    pbrt_params_ignore(params, ignored);
    bool alone = !index && points && points->count == 9; /* one triangle wants none */
    if (!points || points->count == 0 || (!alone && (!index || index->count == 0)))
        return err_set(
            err, ERR_VALUE, &params->place,
            "Shape \"trianglemesh\" wants \"integer indices\" and \"point P\"");
    size_t vertices = points->count / 3, corners = alone ? 3 : index->count;
    if (corners % 3 != 0)
        return err_set(err, ERR_VALUE, &index->place,
                       "%zu indices make no whole triangles", index->count);
    if (vertices > UINT32_MAX || corners / 3 > UINT32_MAX)
        return err_set(err, ERR_VALUE, &points->place, "the mesh is too large");
    if (!pbrt_shape_count_is(normals, points->count, err) ||
        !pbrt_shape_count_is(uv, 2 * vertices, err))
        return false;
    struct mesh *mesh = mesh_create((uint32_t)vertices, (uint32_t)(corners / 3),
                                    normals != NULL, uv != NULL);
    copy_floats(p, points, mesh->p);
    if (normals)
        copy_floats(p, normals, mesh->n);
    if (uv)
        copy_floats(p, uv, mesh->uv);
    for (uint32_t i = 0; alone && i < 3; i++)
        mesh->index[i] = i;
    if (alone || copy_indices(p, index, mesh, err))
        return pbrt_shape_add_mesh(p, mesh, err);
    mesh_destroy(mesh);
    return false;
}

static bool loop_subdivision(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"scheme", NULL};
    struct pbrt_params *params = &p->params;
    const struct pbrt_param *index = pbrt_params_find(params, "indices", PBRT_INTEGER);
    const struct pbrt_param *points = pbrt_params_find(params, "P", PBRT_POINT);
    int levels = 3;
    pbrt_params_ignore(params, ignored);
    if (!pbrt_params_int(params, "nlevels", &levels, err) ||
        !pbrt_params_int(params, "levels", &levels, err))
        return false;
    if (!index || !points || index->count == 0 || index->count % 3 != 0 ||
        points->count / 3 > UINT32_MAX || levels < 0 || levels > 10)
        return err_set(err, ERR_VALUE, &params->place,
                       "Shape \"loopsubdiv\" wants \"integer indices\" in threes, "
                       "\"point P\" and from 0 to 10 levels");
    struct mesh *control = mesh_create((uint32_t)(points->count / 3),
                                       (uint32_t)(index->count / 3), false, false);
    copy_floats(p, points, control->p);
    struct mesh *mesh = NULL;
    if (copy_indices(p, index, control, err)) {
        mesh = mesh_loop(control, levels);
        if (!mesh)
            err_set(err, ERR_VALUE, &index->place,
                    "no surface: an edge of more than two triangles, a triangle that "
                    "meets itself, or too many of them");
    }
    mesh_destroy(control);
    return mesh && pbrt_shape_add_mesh(p, mesh, err);
}

static const struct {
    const char *name;
    bool (*read)(struct pbrt *p, struct err *err); /* NULL: known, left out */
} rows[] = {
    {"trianglemesh", trianglemesh},
    {"plymesh", plymesh},
    {"sphere", pbrt_quadric_sphere},
    {"disk", pbrt_quadric_disk},
    {"cylinder", pbrt_quadric_cylinder},
    {"cone", pbrt_quadric_cone},
    {"paraboloid", pbrt_quadric_paraboloid},
    {"hyperboloid", pbrt_quadric_hyperboloid},
    {"curve", pbrt_curve},
    {"loopsubdiv", loop_subdivision},
    {"nurbs", NULL},
    {"heightfield", pbrt_patch_heightfield},
    {"bilinearmesh", pbrt_patch_bilinear},
};

#define ROWS (sizeof rows / sizeof rows[0])

bool pbrt_shape(struct pbrt *p, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    const char *kind = pbrt_params_head(&p->params, 0);
    const struct place *at = &p->params.head_places[0];
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].name;
        if (!text_equal(kind, rows[i].name))
            continue;
        if (rows[i].read)
            return pbrt_state_check(p, err) && rows[i].read(p, err);
        log_note(&p->desc->log, at, "a shape \"%s\" is left out", kind);
        pbrt_ignored(p, err);
        return true;
    }
    return suggest_fail(err, at, "shape", kind, known);
}
