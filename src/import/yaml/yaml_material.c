#include "import/yaml/scene_yaml.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

static bool unknown_type(const struct doc_node *node, const char *name, struct err *err)
{
    int count = 0;
    while (bsdf_types[count])
        count++;
    const char **known = mem_alloc((size_t)count + 1, sizeof *known);
    for (int i = 0; i < count; i++)
        known[i] = bsdf_types[i]->name;
    struct place at = doc_place(node);
    suggest_fail(err, &at, "type of material", name, known);
    mem_free(known);
    return false;
}

/* The keys of a material are "type" and the parameters of its kind. */
static bool check_keys(const struct doc_node *map, const struct bsdf_type *type,
                       struct err *err)
{
    const char *allowed[BSDF_PARAMS + 2] = {"type"};
    for (int i = 0; type->params[i].name; i++)
        allowed[i + 1] = type->params[i].name;
    return doc_check_keys(map, allowed, err);
}

/* Some numbers have names. */
static bool named_number(const char *param, const char *word, double *value)
{
    static const struct {
        const char *param, *word;
        double value;
    } rows[] = {{"distribution", "ggx", 0.0}, {"distribution", "beckmann", 1.0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (text_equal(param, rows[i].param) && text_equal(word, rows[i].word)) {
            *value = rows[i].value;
            return true;
        }
    }
    return false;
}

static bool set_param(struct scene_yaml *s, struct bsdf *bsdf,
                      const struct bsdf_param *param, const struct doc_node *node,
                      struct err *err)
{
    struct rgb value;
    struct place at = scene_yaml_place(s, node);
    if (param->count == 3) {
        if (!scene_yaml_colour(s, node, &value, err))
            return false;
    } else if (!named_number(param->name, doc_text(node), &value.r) &&
               !doc_to_double(node, &value.r, err)) {
        return false;
    }
    return bsdf_set(bsdf, param->name, &value.r, param->count, &at, err);
}

static bool read_material(struct scene_yaml *s, const struct doc_node *map, int number,
                          struct err *err)
{
    struct bsdf bsdf;
    struct place at = scene_yaml_place(s, map);
    const char *name;
    if (doc_kind(map) != DOC_MAP)
        return err_set(err, ERR_SYNTAX, &at, "a material wants keys and values");
    const struct doc_node *type = scene_yaml_want(map, "type", err);
    if (!type || !doc_to_text(type, &name, err))
        return false;
    if (!bsdf_find(name))
        return unknown_type(type, name, err);
    if (text_equal(name, "blend") || text_equal(name, "sides"))
        return err_set(err, ERR_UNSUPPORTED, &at,
                       "a material of others (%s) cannot be written in YAML yet", name);
    bsdf_init(&bsdf, bsdf_find(name));
    if (!check_keys(map, bsdf.type, err))
        return false;
    for (const struct bsdf_param *p = bsdf.type->params; p->name; p++) {
        const struct doc_node *node = doc_get(map, p->name);
        if (node && !set_param(s, &bsdf, p, node, err))
            return false;
    }
    if (!bsdf_prepare(&bsdf, &at, err))
        return false;
    s->indices[number] = scene_desc_add_material(s->desc, &bsdf);
    return true;
}

bool scene_yaml_materials(struct scene_yaml *s, const struct doc_node *map,
                          struct err *err)
{
    struct place at = doc_place(map);
    if (doc_kind(map) != DOC_MAP)
        return err_set(err, ERR_SYNTAX, &at, "materials wants names and materials");
    int count = doc_count(map);
    mem_free(s->names);
    s->names = mem_alloc((size_t)count + 1, sizeof *s->names);
    s->indices = mem_alloc((size_t)count, sizeof *s->indices);
    for (int i = 0; i < count; i++) {
        s->names[i] = doc_key(map, i);
        s->indices[i] = -1;
    }
    scene_yaml_each(s, map, read_material);
    return true;
}
