#include "import/yaml/scene_yaml.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

/* The objects' numbers are those of their places in the map, which is read once. */
static bool find_object(const struct scene_yaml *s, const struct doc_node *node,
                        int *object, struct err *err)
{
    const char *name;
    if (!doc_to_text(node, &name, err))
        return false;
    for (int i = 0; s->objects[i]; i++) {
        if (text_equal(name, s->objects[i])) {
            *object = i + 1;
            return true;
        }
    }
    struct place at = doc_place(node);
    return !s->nameless && suggest_fail(err, &at, "object", name, s->objects);
}

static bool read_instance(struct scene_yaml *s, const struct doc_node *map, int number,
                          struct err *err)
{
    (void)number;
    static const char *const keys[] = {"object", "transform", NULL};
    struct instance_desc instance = {.parent = s->object,
                                     .to_world = xform_identity(),
                                     .place = scene_yaml_place(s, map)};
    const struct doc_node *name, *transform = NULL;
    if (!scene_yaml_map(map, "an instance", keys, err) ||
        !(name = scene_yaml_want(map, "object", err)) ||
        !find_object(s, name, &instance.object, err))
        return false;
    transform = doc_get(map, "transform");
    if (transform && !scene_yaml_transform(transform, &instance.to_world, err))
        return false;
    scene_desc_add_instance(s->desc, &instance);
    return true;
}

bool scene_yaml_instances(struct scene_yaml *s, const struct doc_node *list,
                          struct err *err)
{
    return scene_yaml_list(s, list, "instances", read_instance, err);
}

static bool read_object(struct scene_yaml *s, const struct doc_node *map, int number,
                        struct err *err)
{
    static const char *const keys[] = {"shapes", "instances", NULL};
    if (!scene_yaml_map(map, "an object", keys, err))
        return false;
    const struct doc_node *shapes = doc_get(map, "shapes");
    const struct doc_node *instances = doc_get(map, "instances");
    s->object = number + 1;
    bool read = (!shapes || scene_yaml_shapes(s, shapes, err)) &&
                (!instances || scene_yaml_instances(s, instances, err));
    s->object = 0;
    return read;
}

bool scene_yaml_objects(struct scene_yaml *s, const struct doc_node *map, struct err *err)
{
    struct place at = doc_place(map);
    if (doc_kind(map) != DOC_MAP)
        return err_set(err, ERR_SYNTAX, &at, "objects wants names and objects");
    int count = doc_count(map);
    mem_free(s->objects);
    s->objects = mem_alloc((size_t)count + 1, sizeof *s->objects);
    for (int i = 0; i < count; i++) {
        s->objects[i] = doc_key(map, i);
        scene_desc_add_object(s->desc);
    }
    scene_yaml_each(s, map, read_object);
    return true;
}
