#include "import/yaml/scene_yaml.h"

#include <math.h>

struct place scene_yaml_place(const struct scene_yaml *s, const struct doc_node *node)
{
    struct place at = doc_place(node);
    at.file = s->file;
    return at;
}

bool scene_yaml_map(const struct doc_node *node, const char *what,
                    const char *const *allowed, struct err *err)
{
    struct place at = doc_place(node);
    if (doc_kind(node) != DOC_MAP)
        return err_set(err, ERR_SYNTAX, &at, "%s wants keys and values", what);
    return doc_check_keys(node, allowed, err);
}

bool scene_yaml_double(const struct doc_node *map, const char *key, double *value,
                       struct err *err)
{
    const struct doc_node *node = doc_get(map, key);
    return !node || doc_to_double(node, value, err);
}

bool scene_yaml_to_int(const struct doc_node *node, const char *key, int min, int max,
                       int *value, struct err *err)
{
    long read;
    if (!doc_to_long(node, &read, err))
        return false;
    struct place at = doc_place(node);
    if (read < min || read > max)
        return err_set(err, ERR_VALUE, &at, "%s must lie between %d and %d, not %ld", key,
                       min, max, read);
    *value = (int)read;
    return true;
}

bool scene_yaml_int(const struct doc_node *map, const char *key, int min, int max,
                    int *value, struct err *err)
{
    const struct doc_node *node = doc_get(map, key);
    return !node || scene_yaml_to_int(node, key, min, max, value, err);
}

bool scene_yaml_bool(const struct doc_node *map, const char *key, bool *value,
                     struct err *err)
{
    const struct doc_node *node = doc_get(map, key);
    return !node || doc_to_bool(node, value, err);
}

bool scene_yaml_vector(const struct doc_node *map, const char *key, double value[3],
                       struct err *err)
{
    const struct doc_node *node = doc_get(map, key);
    return !node || doc_to_doubles(node, value, 3, err);
}

bool scene_yaml_three(const struct doc_node *node, double v[3], struct err *err)
{
    if (doc_kind(node) == DOC_LIST)
        return doc_to_doubles(node, v, 3, err);
    if (!doc_to_double(node, v, err))
        return false;
    v[1] = v[2] = v[0];
    return true;
}

bool scene_yaml_colour(struct scene_yaml *s, const struct doc_node *node,
                       struct rgb *value, struct err *err)
{
    double v[3];
    if (!scene_yaml_three(node, v, err))
        return false;
    struct place at = scene_yaml_place(s, node);
    *value = scene_desc_clamp(s->desc, rgb(v[0], v[1], v[2]), &at);
    return true;
}

const struct doc_node *scene_yaml_want(const struct doc_node *map, const char *key,
                                       struct err *err)
{
    const struct doc_node *node = doc_get(map, key);
    struct place at = doc_place(map);
    if (!node)
        err_set(err, ERR_VALUE, &at, "\"%s\" is missing here", key);
    return node;
}

bool scene_yaml_tell(struct scene_yaml *s, const struct err *failure)
{
    s->failed = true;
    if (failure->code != ERR_NONE &&
        !import_failure_add(s->options, failure, s->first_error))
        s->stopped = true;
    return !s->stopped;
}

void scene_yaml_each(struct scene_yaml *s, const struct doc_node *node,
                     scene_yaml_item *read)
{
    for (int i = 0; !s->stopped && i < doc_count(node); i++) {
        struct err failure = {0};
        if (!read(s, doc_item(node, i), i, &failure))
            scene_yaml_tell(s, &failure);
    }
}

bool scene_yaml_list(struct scene_yaml *s, const struct doc_node *list, const char *what,
                     scene_yaml_item *read, struct err *err)
{
    struct place at = doc_place(list);
    if (doc_kind(list) != DOC_LIST)
        return err_set(err, ERR_SYNTAX, &at, "%s wants a list", what);
    scene_yaml_each(s, list, read);
    return true;
}
