#include "import/yaml/scene_yaml.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "import/suggest.h"

#define LATHE_SEGMENTS_MAX 4096
#define SHAPE_KEYS         5

struct kind {
    const char *name;
    enum shape_kind shape;
    const char *keys[SHAPE_KEYS]; /* of its own, NULL-terminated */
    /* Fills what is of this kind alone; a mesh in object space. */
    bool (*read)(struct scene_yaml *s, const struct doc_node *map,
                 struct shape_desc *shape, struct err *err);
};

static bool check_radius(const struct doc_node *map, double radius, struct err *err)
{
    struct place at = doc_place(map);
    return radius > 0.0 ||
           err_set(err, ERR_VALUE, &at, "the radius %g is not positive", radius);
}

static bool sphere(struct scene_yaml *s, const struct doc_node *map,
                   struct shape_desc *shape, struct err *err)
{
    (void)s;
    return scene_yaml_double(map, "radius", &shape->radius, err) &&
           check_radius(map, shape->radius, err);
}

static bool disk(struct scene_yaml *s, const struct doc_node *map,
                 struct shape_desc *shape, struct err *err)
{
    return scene_yaml_double(map, "height", &shape->height, err) &&
           sphere(s, map, shape, err);
}

static bool cylinder(struct scene_yaml *s, const struct doc_node *map,
                     struct shape_desc *shape, struct err *err)
{
    shape->z_min = -1.0;
    shape->z_max = 1.0;
    if (!scene_yaml_double(map, "z_min", &shape->z_min, err) ||
        !scene_yaml_double(map, "z_max", &shape->z_max, err))
        return false;
    struct place at = doc_place(map);
    if (!(shape->z_min < shape->z_max))
        return err_set(err, ERR_VALUE, &at, "z_min is not below z_max");
    return sphere(s, map, shape, err);
}

static bool rectangle(struct scene_yaml *s, const struct doc_node *map,
                      struct shape_desc *shape, struct err *err)
{
    (void)s;
    (void)map;
    (void)err;
    shape->mesh = mesh_rectangle();
    return true;
}

static bool box(struct scene_yaml *s, const struct doc_node *map,
                struct shape_desc *shape, struct err *err)
{
    (void)s;
    (void)map;
    (void)err;
    shape->mesh = mesh_box();
    return true;
}

static bool read_profile(const struct doc_node *list, double *profile, struct err *err)
{
    for (int i = 0; i < doc_count(list); i++) {
        const struct doc_node *pair = doc_item(list, i);
        double *radius = profile + 2 * (size_t)i; /* the height follows */
        if (!doc_to_doubles(pair, radius, 2, err))
            return false;
        struct place at = doc_place(pair);
        if (*radius < 0.0)
            return err_set(err, ERR_VALUE, &at, "a radius of the profile is negative");
    }
    return true;
}

static bool lathe(struct scene_yaml *s, const struct doc_node *map,
                  struct shape_desc *shape, struct err *err)
{
    (void)s;
    int segments = 64;
    bool smooth = true;
    double crease = 30.0;
    const struct doc_node *list = scene_yaml_want(map, "profile", err);
    if (!list ||
        !scene_yaml_int(map, "segments", 3, LATHE_SEGMENTS_MAX, &segments, err) ||
        !scene_yaml_bool(map, "smooth", &smooth, err) ||
        !scene_yaml_double(map, "crease", &crease, err))
        return false;
    struct place at = doc_place(list);
    int count = doc_kind(list) == DOC_LIST ? doc_count(list) : 0;
    if (count < 2 || count > 100000)
        return err_set(err, ERR_VALUE, &at,
                       "a profile is a list of at least two [radius, height]");
    double *profile = mem_alloc(2 * (size_t)count, sizeof *profile);
    bool read = read_profile(list, profile, err);
    if (read) {
        shape->mesh = mesh_lathe(profile, count, segments, smooth, crease);
        read = shape->mesh || err_set(err, ERR_VALUE, &at,
                                      "nothing can be turned of "
                                      "this profile");
    }
    mem_free(profile);
    return read;
}

static bool mesh_file(struct scene_yaml *s, const struct doc_node *map,
                      struct shape_desc *shape, struct err *err)
{
    const struct doc_node *node = scene_yaml_want(map, "file", err);
    const char *name;
    if (!node || !doc_to_text(node, &name, err))
        return false;
    struct place at = scene_yaml_place(s, node);
    if (!text_ends_with(name, ".ply"))
        return err_set(err, ERR_UNSUPPORTED, &at, "mesh files are read from .ply only");
    char *path = text_join(s->directory, name);
    shape->mesh = ahead_mesh(s->ahead, import_ply, path, &at, err);
    mem_free(path);
    return shape->mesh != NULL;
}

static const struct kind kinds[] = {
    {"sphere", SHAPE_SPHERE, {"radius"}, sphere},
    {"disk", SHAPE_DISK, {"radius", "height"}, disk},
    {"cylinder", SHAPE_CYLINDER, {"radius", "z_min", "z_max"}, cylinder},
    {"rectangle", SHAPE_MESH, {NULL}, rectangle},
    {"box", SHAPE_MESH, {NULL}, box},
    {"lathe", SHAPE_MESH, {"profile", "segments", "smooth", "crease"}, lathe},
    {"mesh", SHAPE_MESH, {"file"}, mesh_file},
};

#define KINDS (sizeof kinds / sizeof kinds[0])

static const struct kind *find_kind(const struct doc_node *map, struct err *err)
{
    const char *known[KINDS + 1] = {0};
    const char *name;
    struct place map_at = doc_place(map);
    if (doc_kind(map) != DOC_MAP) {
        err_set(err, ERR_SYNTAX, &map_at, "a shape wants keys and values");
        return NULL;
    }
    const struct doc_node *type = scene_yaml_want(map, "type", err);
    if (!type || !doc_to_text(type, &name, err))
        return NULL;
    for (size_t i = 0; i < KINDS; i++) {
        if (text_equal(name, kinds[i].name))
            return &kinds[i];
        known[i] = kinds[i].name;
    }
    struct place at = doc_place(type);
    suggest_fail(err, &at, "type of shape", name, known);
    return NULL;
}

static bool check_keys(const struct doc_node *map, const struct kind *kind,
                       struct err *err)
{
    static const char *const common[] = {"type",     "material",  "transform", "reverse",
                                         "emission", "two_sided", NULL};
    const char *allowed[sizeof common / sizeof common[0] + SHAPE_KEYS] = {0};
    int count = 0;
    for (int i = 0; common[i]; i++)
        allowed[count++] = common[i];
    for (int i = 0; i < SHAPE_KEYS && kind->keys[i]; i++)
        allowed[count++] = kind->keys[i];
    return doc_check_keys(map, allowed, err);
}

static bool read_material(const struct scene_yaml *s, const struct doc_node *map,
                          int *index, struct err *err)
{
    const char *name;
    const struct doc_node *node = scene_yaml_want(map, "material", err);
    if (!node || !doc_to_text(node, &name, err))
        return false;
    for (int i = 0; s->names[i]; i++) {
        if (text_equal(name, s->names[i])) {
            *index = s->indices[i];
            return *index >= 0;
        }
    }
    struct place at = doc_place(node);
    return !s->nameless && suggest_fail(err, &at, "material", name, s->names);
}

static bool read_emission(struct scene_yaml *s, const struct doc_node *map,
                          struct shape_desc *shape, struct err *err)
{
    const struct doc_node *node = doc_get(map, "emission");
    if (!scene_yaml_bool(map, "two_sided", &shape->two_sided, err))
        return false;
    struct place at = doc_place(map);
    if (!node && doc_get(map, "two_sided"))
        return err_set(err, ERR_VALUE, &at, "two_sided is said of emission; none here");
    if (node && !scene_yaml_colour(s, node, &shape->radiance, err))
        return false;
    shape->emits = !rgb_is_black(shape->radiance);
    return true;
}

/* A mirrored mesh keeps its outside outside, as quadrics do by themselves. */
static bool place_mesh(struct scene_yaml *s, struct shape_desc *shape, struct err *err)
{
    mesh_transform(shape->mesh, &shape->to_world);
    bool mirrored = xform_swaps_handedness(&shape->to_world);
    shape->reverse_orientation ^= mirrored && !shape->mesh->n;
    shape->to_world = xform_identity();
    return mesh_check(shape->mesh, &shape->place, &s->desc->log, err);
}

static bool read_shape(struct scene_yaml *s, const struct doc_node *map, int number,
                       struct err *err)
{
    (void)number;
    const struct kind *kind = find_kind(map, err);
    struct shape_desc shape = {.place = scene_yaml_place(s, map), .radius = 1.0};
    shape.to_world = xform_identity();
    const struct doc_node *transform = kind ? doc_get(map, "transform") : NULL;
    if (!kind || !check_keys(map, kind, err) ||
        !read_material(s, map, &shape.material, err) ||
        !read_emission(s, map, &shape, err) ||
        !scene_yaml_bool(map, "reverse", &shape.reverse_orientation, err) ||
        (transform && !scene_yaml_transform(transform, &shape.to_world, err)))
        return false;
    shape.kind = kind->shape;
    shape.object = s->object;
    if (!kind->read(s, map, &shape, err) || (shape.mesh && !place_mesh(s, &shape, err))) {
        mesh_destroy(shape.mesh);
        return false;
    }
    scene_desc_add_shape(s->desc, &shape);
    return true;
}

bool scene_yaml_shapes(struct scene_yaml *s, const struct doc_node *list, struct err *err)
{
    return scene_yaml_list(s, list, "shapes", read_shape, err);
}
