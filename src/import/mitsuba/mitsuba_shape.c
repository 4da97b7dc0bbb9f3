#include "import/mitsuba/mitsuba_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "import/mitsuba/mitsuba_instance.h"
#include "import/mitsuba/mitsuba_material.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_transform.h"
#include "import/suggest.h"

#include <math.h>

static double cross_and_angle(const float *p, const float *a, const float *b,
                              double normal[3])
{
    double u[3], v[3], uu = 0.0, vv = 0.0, uv = 0.0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)a[k] - (double)p[k];
        v[k] = (double)b[k] - (double)p[k];
        uu += u[k] * u[k];
        vv += v[k] * v[k];
        uv += u[k] * v[k];
    }
    for (int k = 0; k < 3; k++)
        normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] +
                         normal[2] * normal[2]);
    if (!(length > 0.0) || !(uu > 0.0) || !(vv > 0.0))
        return 0.0;
    for (int k = 0; k < 3; k++)
        normal[k] /= length;
    return atan2(length, uv);
}

/* Smooth normals: of the faces around a vertex, weighted by the angles that they fill
 * there, as Mitsuba; the winding gives the side. */
static void smooth_normals(struct mesh *mesh)
{
    size_t count = 3 * (size_t)mesh->vertex_count;
    double *sum = mem_alloc(count + 1, sizeof *sum);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        const uint32_t *index = mesh->index + i / 3 * 3;
        const float *p[3];
        double normal[3];
        for (size_t j = 0; j < 3; j++) /* this corner first */
            p[j] = mesh->p + 3 * (size_t)index[(i + j) % 3];
        double angle = cross_and_angle(p[0], p[1], p[2], normal);
        for (size_t k = 0; k < 3 && angle > 0.0; k++)
            sum[3 * (size_t)mesh->index[i] + k] += angle * normal[k];
    }
    if (!mesh->n)
        mesh->n = mem_alloc(count + 1, sizeof *mesh->n);
    for (size_t i = 0; i < count; i++)
        mesh->n[i] = (float)sum[i]; /* made unit by mesh_check */
    mem_free(sum);
}

/* A shape while it is read. */
struct reading {
    struct mitsuba *m;
    struct mitsuba_node *object;
    struct shape_desc shape;
    bool face_normals;
    bool flip_uv;
    bool keeps_outside; /* where the transform mirrors; and it is flat by itself */
};

static struct mesh *obj(struct reading *r, const char *path, const struct place *at,
                        struct err *err)
{
    return ahead_mesh(r->m->ahead, import_obj, path, at, err);
}

static struct mesh *ply(struct reading *r, const char *path, const struct place *at,
                        struct err *err)
{
    return ahead_mesh(r->m->ahead, import_ply, path, at, err);
}

static struct mesh *serialized(struct reading *r, const char *path,
                               const struct place *at, struct err *err)
{
    int index = 0;
    struct import_serialized_flags flags = {false, false};
    if (!mitsuba_integer(r->object, "shape_index", &index, err))
        return NULL;
    struct mesh *mesh = import_serialized(path, index, &flags, at, err);
    r->face_normals = r->face_normals || flags.face_normals;
    if (mesh && flags.colours)
        log_note(&r->m->desc->log, at, "colours of vertices are not used");
    return mesh;
}

static bool from_file(struct reading *r,
                      struct mesh *(*read)(struct reading *r, const char *path,
                                           const struct place *at, struct err *err),
                      struct err *err)
{
    const char *name = NULL;
    double angle = -1.0;
    if (!mitsuba_string(r->object, "filename", &name, err) ||
        !mitsuba_boolean(r->object, "face_normals", &r->face_normals, err) ||
        !mitsuba_boolean(r->object, "flip_tex_coords", &r->flip_uv, err) ||
        !mitsuba_float(r->object, "max_smooth_angle", &angle, err))
        return false;
    if (!name)
        return err_set(err, ERR_VALUE, &r->object->place,
                       "shape \"%s\" wants a string \"filename\"",
                       mitsuba_type(r->object));
    if (angle >= 0.0)
        log_note(&r->m->desc->log, &r->object->place,
                 "maxSmoothAngle is not used: normals are those of the file, or smooth");
    char *path = text_join(r->m->directory, name);
    r->shape.mesh = read(r, path, &mitsuba_property(r->object, "filename")->place, err);
    mem_free(path);
    return r->shape.mesh != NULL;
}

static bool read_obj(struct reading *r, struct err *err)
{
    r->flip_uv = true; /* v of OBJ goes up, Mitsuba's goes down */
    return from_file(r, obj, err);
}

static bool read_ply(struct reading *r, struct err *err)
{
    return from_file(r, ply, err);
}

static bool read_serialized(struct reading *r, struct err *err)
{
    return from_file(r, serialized, err);
}

static bool rectangle(struct reading *r, struct err *err)
{
    (void)err;
    r->keeps_outside = true;
    r->shape.mesh = mesh_rectangle();
    return true;
}

/* Which axes u and v follow on the faces of a cube, in the order of mesh_box. */
static const struct {
    int u, v; /* 1, 2, 3: x, y, z; negative: backwards */
} cube_axes[6] = {{2, -3}, {2, 3}, {-1, -3}, {3, 1}, {2, 1}, {-2, 1}};

static float along(const float *p, int axis)
{
    return axis > 0 ? 0.5f + 0.5f * p[axis - 1] : 0.5f - 0.5f * p[-axis - 1];
}

static bool cube(struct reading *r, struct err *err)
{
    (void)err;
    struct mesh *mesh = r->shape.mesh = mesh_box();
    r->keeps_outside = true;
    for (size_t i = 0; i < 24; i++) {
        mesh->uv[2 * i] = along(mesh->p + 3 * i, cube_axes[i / 4].u);
        mesh->uv[2 * i + 1] = along(mesh->p + 3 * i, cube_axes[i / 4].v);
    }
    return true;
}

static bool check_radius(const struct reading *r, struct err *err)
{
    return r->shape.radius > 0.0 ||
           err_set(err, ERR_VALUE, &r->object->place, "the radius %g is not positive",
                   r->shape.radius);
}

static bool sphere(struct reading *r, struct err *err)
{
    double center[3] = {0.0, 0.0, 0.0};
    r->shape.kind = SHAPE_SPHERE;
    if (!mitsuba_point(r->object, "center", center, err) ||
        !mitsuba_float(r->object, "radius", &r->shape.radius, err))
        return false;
    struct xform move = xform_translate(center[0], center[1], center[2]);
    r->shape.to_world = xform_mul(&r->shape.to_world, &move);
    return check_radius(r, err);
}

static bool disk(struct reading *r, struct err *err)
{
    (void)err;
    r->shape.kind = SHAPE_DISK;
    return true;
}

static bool cylinder(struct reading *r, struct err *err)
{
    double p0[3] = {0.0, 0.0, 0.0}, p1[3] = {0.0, 0.0, 1.0};
    struct xform axis;
    r->shape.kind = SHAPE_CYLINDER;
    if (!mitsuba_point(r->object, "p0", p0, err) ||
        !mitsuba_point(r->object, "p1", p1, err) ||
        !mitsuba_float(r->object, "radius", &r->shape.radius, err))
        return false;
    if (!mitsuba_look_along(p0, p1, &axis))
        return err_set(err, ERR_VALUE, &r->object->place,
                       "the cylinder's p0 and p1 coincide");
    r->shape.to_world = xform_mul(&r->shape.to_world, &axis);
    r->shape.z_max = sqrt((p1[0] - p0[0]) * (p1[0] - p0[0]) +
                          (p1[1] - p0[1]) * (p1[1] - p0[1]) +
                          (p1[2] - p0[2]) * (p1[2] - p0[2]));
    return check_radius(r, err);
}

/* Transforms the mesh to world space and gives it the shading normals that Mitsuba would.
 */
static bool place_mesh(struct reading *r, struct err *err)
{
    struct shape_desc *shape = &r->shape;
    struct mesh *mesh = shape->mesh;
    bool mirrored = xform_swaps_handedness(&shape->to_world);
    for (size_t i = 0; r->flip_uv && mesh->uv && i < mesh->vertex_count; i++)
        mesh->uv[2 * i + 1] = 1.0f - mesh->uv[2 * i + 1];
    if (r->face_normals) {
        mem_free(mesh->n);
        mesh->n = NULL;
    }
    mesh_transform(mesh, &shape->to_world);
    shape->to_world = xform_identity();
    shape->reverse_orientation ^= r->keeps_outside && mirrored;
    if (!mesh_check(mesh, &shape->place, &r->m->desc->log, err))
        return false;
    if (!mesh->n && !r->face_normals && !r->keeps_outside)
        smooth_normals(mesh);
    return true;
}

static const struct shape_row {
    const char *type;
    bool (*read)(struct reading *r, struct err *err); /* NULL: known, left out */
} rows[] = {
    {"obj", read_obj},        {"ply", read_ply},      {"serialized", read_serialized},
    {"rectangle", rectangle}, {"cube", cube},         {"sphere", sphere},
    {"disk", disk},           {"cylinder", cylinder}, {"hair", NULL},
    {"heightfield", NULL},    {"deformable", NULL},   {"bsplinecurve", NULL},
    {"linearcurve", NULL},    {"sdfgrid", NULL},      {"ellipsoids", NULL},
    {"ellipsoidsmesh", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* The row of an object's type; NULL, with a note, if it is left out. */
static const struct shape_row *find_row(struct mitsuba *m,
                                        const struct mitsuba_node *object)
{
    const char *known[ROWS + 1] = {0};
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (!text_equal(mitsuba_type(object), rows[i].type))
            continue;
        if (rows[i].read)
            return &rows[i];
        log_note(&m->desc->log, &object->place,
                 "shape \"%s\" is not read yet and left out", rows[i].type);
        return NULL;
    }
    mitsuba_unknown(m, object, known, "left out");
    return NULL;
}

static bool read_surface(struct reading *r, struct err *err)
{
    struct mitsuba_node *bsdf, *emitter;
    struct shape_desc *shape = &r->shape;
    if (!mitsuba_child(r->m, r->object, "bsdf", &bsdf, err) ||
        !mitsuba_child(r->m, r->object, "emitter", &emitter, err) ||
        (emitter && !mitsuba_emitter_area(r->m, emitter, shape, err)) ||
        (bsdf && !mitsuba_material(r->m, bsdf, &shape->material, err)))
        return false;
    if (!bsdf || (shape->material == MITSUBA_MATERIAL_NONE && shape->emits))
        return mitsuba_material_default(r->m, emitter != NULL, &shape->material, err);
    return true;
}

/* Notes textures on shapes whose parameters differ from Mitsuba's. */
static void check_uv(const struct reading *r)
{
    enum shape_kind kind = r->shape.kind;
    int material = r->shape.material;
    if ((kind == SHAPE_SPHERE || kind == SHAPE_DISK) && material >= 0 &&
        r->m->desc->materials[material].flags & BSDF_TEXTURED)
        log_note(&r->m->desc->log, &r->shape.place,
                 "a textured %s: the texture lies otherwise than in Mitsuba",
                 mitsuba_type(r->object));
}

static bool read_shape(struct reading *r, const struct shape_row *row, struct err *err)
{
    struct shape_desc *shape = &r->shape;
    return read_surface(r, err) &&
           mitsuba_transform(r->object, "to_world", &shape->to_world, err) &&
           mitsuba_boolean(r->object, "flip_normals", &shape->reverse_orientation, err) &&
           row->read(r, err) && (!shape->mesh || place_mesh(r, err));
}

static bool read_plain(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    static const char *const ignored[] = {"silhouette_sampling_weight", NULL};
    const struct shape_row *row = find_row(m, object);
    struct reading r = {.m = m, .object = object};
    if (!row)
        return true;
    r.shape = (struct shape_desc){.place = object->place, .radius = 1.0};
    r.shape.to_world = xform_identity();
    mitsuba_ignore(object, ignored);
    if (!read_shape(&r, row, err)) {
        mesh_destroy(r.shape.mesh);
        return false;
    }
    mitsuba_report(m, object);
    check_uv(&r);
    if (r.shape.material == MITSUBA_MATERIAL_NONE) {
        log_note(&m->desc->log, &object->place,
                 "shapes with the bsdf \"null\" are left out: light passes through them");
        mesh_destroy(r.shape.mesh);
        return true;
    }
    mitsuba_instance_add(m, &r.shape);
    return true;
}

/* Mitsuba 3's "merge" makes one mesh of what stands in it, which looks the same. */
static bool read_merged(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    bool read = mitsuba_enter(m, object, err);
    if (!read)
        return false;
    for (size_t i = 0; read && i < object->child_count; i++) {
        struct mitsuba_node *child = mitsuba_resolve(m, object->children[i], err);
        read = child != NULL;
        if (!read || !text_equal(child->name, "shape"))
            continue;
        object->children[i]->used = true;
        read = mitsuba_shape(m, child, err);
    }
    mitsuba_leave(m, object);
    if (read)
        mitsuba_report(m, object);
    return read;
}

bool mitsuba_shape(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    if (text_equal(mitsuba_type(object), "merge"))
        return read_merged(m, object, err);
    if (text_equal(mitsuba_type(object), "shapegroup"))
        return !m->in_group || /* its instances show it */
               err_set(err, ERR_VALUE, &object->place,
                       "a shapegroup within a shapegroup: Mitsuba nests none");
    return text_equal(mitsuba_type(object), "instance") ? mitsuba_instance(m, object, err)
                                                        : read_plain(m, object, err);
}
