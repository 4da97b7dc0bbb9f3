#include "import/yaml/scene_yaml.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "import/suggest.h"

#define FILM_MAX  65536
#define DEPTH_MAX 100000

typedef bool section_fn(struct scene_yaml *s, const struct doc_node *node,
                        struct err *err);

static bool description(struct scene_yaml *s, const struct doc_node *node,
                        struct err *err)
{
    const char *text;
    (void)s;
    return doc_to_text(node, &text, err);
}

static bool film(struct scene_yaml *s, const struct doc_node *map, struct err *err)
{
    static const char *const keys[] = {"width", "height", "crop", NULL};
    double *crop = s->desc->camera.crop;
    if (!scene_yaml_map(map, "film", keys, err) || !scene_yaml_want(map, "width", err) ||
        !scene_yaml_want(map, "height", err) ||
        !scene_yaml_int(map, "width", 1, FILM_MAX, &s->desc->width, err) ||
        !scene_yaml_int(map, "height", 1, FILM_MAX, &s->desc->height, err))
        return false;
    const struct doc_node *node = doc_get(map, "crop");
    if (!node)
        return true;
    if (!doc_to_doubles(node, crop, 4, err))
        return false;
    struct place at = doc_place(node);
    if (crop[0] >= 0.0 && crop[0] < crop[1] && crop[1] <= 1.0 && crop[2] >= 0.0 &&
        crop[2] < crop[3] && crop[3] <= 1.0)
        return true;
    return err_set(err, ERR_VALUE, &at,
                   "crop wants [x0, x1, y0, y1] rising within [0, 1]");
}

static bool max_depth(struct scene_yaml *s, const struct doc_node *node, struct err *err)
{
    return scene_yaml_to_int(node, "max_depth", 1, DEPTH_MAX, &s->desc->max_depth, err);
}

static bool hide_emitters(struct scene_yaml *s, const struct doc_node *node,
                          struct err *err)
{
    return doc_to_bool(node, &s->desc->hide_emitters, err);
}

static bool settings(struct scene_yaml *s, const struct doc_node *map, struct err *err)
{
    struct place map_at = doc_place(map);
    if (doc_kind(map) != DOC_MAP)
        return err_set(err, ERR_SYNTAX, &map_at, "settings wants keys and values");
    for (int i = 0; i < doc_count(map); i++) {
        const char *value;
        if (!doc_to_text(doc_item(map, i), &value, err))
            return false;
        struct place at = doc_key_place(map, i);
        at.file = s->file;
        scene_desc_add_setting(s->desc, doc_key(map, i), value, &at);
    }
    return true;
}

static bool point_light(struct scene_yaml *s, const struct doc_node *map, int number,
                        struct err *err)
{
    (void)number;
    static const char *const keys[] = {"type", "position", "intensity", NULL};
    static const char *const known[] = {"point", NULL};
    const struct doc_node *type, *position, *intensity;
    const char *name;
    double p[3];
    struct light_desc light = {.place = scene_yaml_place(s, map)};
    if (!scene_yaml_map(map, "a light", keys, err) ||
        !(type = scene_yaml_want(map, "type", err)) || !doc_to_text(type, &name, err))
        return false;
    struct place at = doc_place(type);
    if (!text_equal(name, "point"))
        return suggest_fail(err, &at, "type of light", name, known);
    if (!(position = scene_yaml_want(map, "position", err)) ||
        !(intensity = scene_yaml_want(map, "intensity", err)) ||
        !doc_to_doubles(position, p, 3, err) ||
        !scene_yaml_colour(s, intensity, &light.intensity, err))
        return false;
    light.to_world = xform_translate(p[0], p[1], p[2]);
    if (rgb_is_black(light.intensity))
        log_note(&s->desc->log, &light.place, "a light of no intensity is left out");
    else
        scene_desc_add_light(s->desc, &light);
    return true;
}

static bool lights(struct scene_yaml *s, const struct doc_node *list, struct err *err)
{
    return scene_yaml_list(s, list, "lights", point_light, err);
}

/* Materials before the shapes that name them, objects before their instances. */
static const struct section {
    const char *key;
    section_fn *read;
    bool wanted, names;
} sections[] = {
    {"description", description, false, false},
    {"camera", scene_yaml_camera, true, false},
    {"film", film, true, false},
    {"max_depth", max_depth, false, false},
    {"hide_emitters", hide_emitters, false, false},
    {"settings", settings, false, false},
    {"materials", scene_yaml_materials, false, true},
    {"objects", scene_yaml_objects, false, true},
    {"shapes", scene_yaml_shapes, false, false},
    {"instances", scene_yaml_instances, false, false},
    {"lights", lights, false, false},
};

#define SECTIONS (sizeof sections / sizeof sections[0])

/* Where a key is not known, it may be a wanted one. */
static bool check_sections(const struct doc_node *root, struct err *err)
{
    const char *keys[SECTIONS + 1] = {0};
    for (size_t i = 0; i < SECTIONS; i++)
        keys[i] = sections[i].key;
    if (!scene_yaml_map(root, "a scene", keys, err))
        return false;
    for (size_t i = 0; i < SECTIONS; i++)
        if (sections[i].wanted && !scene_yaml_want(root, sections[i].key, err))
            return false;
    return true;
}

static bool read_scene(struct scene_yaml *s, const struct doc_node *root)
{
    struct err failure = {0};
    if (!check_sections(root, &failure)) {
        scene_yaml_tell(s, &failure);
        s->nameless = true; /* of whatever stands under the wrong key */
    }
    for (size_t i = 0; !s->stopped && i < SECTIONS; i++) {
        const struct doc_node *node = doc_get(root, sections[i].key);
        failure = (struct err){0};
        if (!node || sections[i].read(s, node, &failure))
            continue;
        scene_yaml_tell(s, &failure);
        s->nameless |= sections[i].names;
    }
    return !s->failed;
}

struct scene_desc *import_yaml(const char *path, const struct import_options *options,
                               struct err *err)
{
    struct doc *doc = doc_load(path, err);
    if (!doc)
        return NULL;
    struct scene_desc *desc = scene_desc_create(path);
    struct scene_yaml s = {.desc = desc, .options = options, .first_error = err};
    s.directory = text_directory(path);
    s.file = scene_desc_keep(desc, path);
    s.names = mem_alloc(1, sizeof *s.names);
    s.objects = mem_alloc(1, sizeof *s.objects);
    desc->camera.crop[1] = desc->camera.crop[3] = 1.0;
    s.ahead = ahead_read(path, s.directory, " ,:[]{}\"'\r\n", &desc->textures, options);
    bool read = read_scene(&s, doc_root(doc));
    ahead_destroy(s.ahead);
    mem_free(s.names);
    mem_free(s.objects);
    mem_free(s.indices);
    mem_free(s.directory);
    doc_destroy(doc);
    return read ? desc : import_failure_give_up(options, desc);
}
