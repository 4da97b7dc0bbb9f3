#include "lab/experiment.h"

#include "base/mem.h"
#include "base/text.h"
#include "settings/settings.h"

#include <ctype.h>
#include <string.h>

#define MAX_SEEDS 100000

/* Settings that the keys `seeds` and `integrators` give. */
static const char *const matrix_settings[] = {"integrator", "seed", NULL};

static bool is_folder_name(const char *name)
{
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && strchr("._-", *c) == NULL)
            return false;
    return name[0] != '\0' && name[0] != '.' && !text_equal(name, "references");
}

static bool read_name(struct experiment *e, const struct doc_node *root, struct err *err)
{
    const struct doc_node *node = doc_get(root, "experiment");
    if (node == NULL)
        return err_set(err, ERR_VALUE, &e->at, "'experiment' is missing: its name");
    struct place at = doc_place(node);
    if (!doc_to_text(node, &e->name, err))
        return false;
    return is_folder_name(e->name) ||
           err_set(err, ERR_VALUE, &at,
                   "experiment: '%s' is to name a folder: letters, digits, '_', '-' and "
                   "'.', not first, and not 'references'",
                   e->name);
}

static bool read_label(const struct doc_node *map, const char **label, struct err *err)
{
    const struct doc_node *node = doc_get(map, "label");
    if (node == NULL)
        return true;
    struct place at = doc_place(node);
    if (!doc_to_text(node, label, err))
        return false;
    for (const char *c = *label; *c; c++)
        if (iscntrl((unsigned char)*c))
            return err_set(err, ERR_VALUE, &at, "a label is one line of text");
    return true;
}

/* Reads all keys of the map as settings except those in `own`, which are read elsewhere.
 */
static bool read_axes(struct axes *axes, const struct doc_node *map,
                      const char *const *own, struct err *err)
{
    for (int i = 0; i < doc_count(map); i++)
        if (!axes_listed(doc_key(map, i), own) && !axes_read(axes, map, i, err))
            return false;
    return true;
}

/* --- references ------------------------------------------------------------------ */

static char *beside(const struct experiment *e, const char *path)
{
    char *folder = text_directory(e->at.file);
    char *joined = text_join(folder, path);
    mem_free(folder);
    return joined;
}

static bool read_reference_file(const struct experiment *e, struct reference_spec *spec,
                                const struct doc_node *node, struct err *err)
{
    if (!doc_to_text(node, &spec->given, err))
        return false;
    spec->kind = text_equal(spec->given, "none") ? REFERENCE_NONE : REFERENCE_FILE;
    spec->file = beside(e, spec->given);
    return true;
}

static bool check_rendered(const struct reference_spec *spec, struct err *err)
{
    for (size_t i = 0; i < spec->settings.count; i++)
        if (spec->settings.items[i].count != 1)
            return err_set(err, ERR_VALUE, &spec->settings.items[i].choices[1].at,
                           "a reference takes one value of each setting");
    if (axes_find(&spec->settings, "budget") == NULL)
        return err_set(err, ERR_VALUE, &spec->at,
                       "a reference that is to be rendered needs a budget: seconds or "
                       "mutations_per_pixel");
    return true;
}

static bool read_reference_map(const struct experiment *e, struct reference_spec *spec,
                               const struct doc_node *node, struct err *err)
{
    static const char *const own[] = {"file", NULL};
    /* Size and depth of a reference are those of its jobs. */
    static const char *const except[] = {"seed", "size", "max_depth", NULL};
    const struct doc_node *file = doc_get(node, "file");
    if (!axes_check_keys(node, own, except, err))
        return false;
    if (file && doc_count(node) > 1)
        return err_set(err, ERR_VALUE, &spec->at,
                       "a reference is a file or is rendered, not both");
    if (file)
        return read_reference_file(e, spec, file, err);
    spec->kind = REFERENCE_RENDERED;
    return read_axes(&spec->settings, node, own, err) && check_rendered(spec, err);
}

static bool read_reference(const struct experiment *e, struct reference_spec *spec,
                           const struct doc_node *map, struct err *err)
{
    const struct doc_node *node = doc_get(map, "reference");
    if (node == NULL)
        return true;
    spec->at = doc_place(node);
    return doc_kind(node) == DOC_MAP ? read_reference_map(e, spec, node, err)
                                     : read_reference_file(e, spec, node, err);
}

static void reference_deinit(struct reference_spec *spec)
{
    axes_deinit(&spec->settings);
    mem_free(spec->file);
}

/* --- scenes, integrators, seeds -------------------------------------------------- */

/* The file's name without its ending; that of its folder if all are called "scene". */
static char *label_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    char *stem = text_copy_n(name,
                             dot && dot > name ? (size_t)(dot - name) : strlen(name));
    if (slash == NULL || slash == path || !text_equal(stem, "scene"))
        return stem;
    const char *begin = slash;
    while (begin > path && begin[-1] != '/')
        begin--;
    if (*begin == '.')
        return stem;
    mem_free(stem);
    return text_copy_n(begin, (size_t)(slash - begin));
}

static bool check_scene_label(const struct experiment *e, size_t index, struct err *err)
{
    for (size_t i = 0; i < index; i++)
        if (text_equal(e->scenes[i].label, e->scenes[index].label))
            return err_set(err, ERR_VALUE, &e->scenes[index].at,
                           "two scenes are called '%s'; tell them apart: {scene: FILE, "
                           "label: NAME}",
                           e->scenes[index].label);
    return true;
}

static bool read_scene_map(struct experiment *e, struct experiment_scene *scene,
                           const struct doc_node *node, const char **label,
                           struct err *err)
{
    static const char *const own[] = {"scene", "label", "reference", NULL};
    const struct doc_node *path = doc_get(node, "scene");
    if (!axes_check_keys(node, own, matrix_settings, err))
        return false;
    if (path == NULL)
        return err_set(err, ERR_VALUE, &scene->at, "'scene' is missing: the file");
    return doc_to_text(path, &scene->given, err) && read_label(node, label, err) &&
           read_reference(e, &scene->reference, node, err) &&
           read_axes(&scene->axes, node, own, err);
}

static bool read_scene(struct experiment *e, const struct doc_node *node, struct err *err)
{
    struct experiment_scene *scene = &e->scenes[e->scene_count++];
    const char *label = NULL;
    scene->at = doc_place(node);
    if (doc_kind(node) == DOC_MAP ? !read_scene_map(e, scene, node, &label, err)
                                  : !doc_to_text(node, &scene->given, err))
        return false;
    scene->path = beside(e, scene->given);
    scene->label = label ? text_copy(label) : label_of(scene->given);
    return check_scene_label(e, e->scene_count - 1, err);
}

static bool read_variant(struct experiment *e, const struct doc_node *list, int index,
                         struct err *err)
{
    static const char *const own[] = {"label", NULL}, *const except[] = {"seed", NULL};
    struct experiment_variant *variant = &e->variants[e->variant_count++];
    const struct doc_node *node = doc_item(list, index);
    struct place at = doc_place(node);
    if (doc_kind(node) != DOC_MAP)
        return axes_add(&variant->axes, "integrator", node, err);
    if (!axes_check_keys(node, own, except, err))
        return false;
    if (doc_get(node, "integrator") == NULL)
        return err_set(err, ERR_VALUE, &at, "'integrator' is missing: its name");
    return read_label(node, &variant->label, err) &&
           read_axes(&variant->axes, node, own, err);
}

/* The list under `key`, which must be there and hold something. */
static const struct doc_node *list_of(const struct experiment *e,
                                      const struct doc_node *root, const char *key,
                                      struct err *err)
{
    const struct doc_node *node = doc_get(root, key);
    struct place at = node ? doc_place(node) : e->at;
    if (node && doc_kind(node) == DOC_LIST && doc_count(node) > 0)
        return node;
    err_set(err, ERR_VALUE, &at, "%s%s%s", node ? "" : "'", key,
            node ? ": expected a list with something in it" : "' is missing: a list");
    return NULL;
}

static bool read_scenes(struct experiment *e, const struct doc_node *root,
                        struct err *err)
{
    const struct doc_node *list = list_of(e, root, "scenes", err);
    if (list == NULL)
        return false;
    e->scenes = mem_alloc((size_t)doc_count(list), sizeof *e->scenes);
    for (int i = 0; i < doc_count(list); i++)
        if (!read_scene(e, doc_item(list, i), err))
            return false;
    return true;
}

static bool read_variants(struct experiment *e, const struct doc_node *root,
                          struct err *err)
{
    const struct doc_node *list = list_of(e, root, "integrators", err);
    if (list == NULL)
        return false;
    e->variants = mem_alloc((size_t)doc_count(list), sizeof *e->variants);
    for (int i = 0; i < doc_count(list); i++)
        if (!read_variant(e, list, i, err))
            return false;
    return true;
}

static bool read_seed(struct experiment *e, const struct doc_node *node, struct err *err)
{
    struct settings trial;
    struct place at = doc_place(node);
    settings_init(&trial);
    if (!doc_to_long(node, &e->seeds[e->seed_count++], err))
        return false;
    return settings_set(&trial, "seed", doc_text(node), &at, err);
}

/* `seeds: N` means 1..N. */
static bool count_seeds(struct experiment *e, const struct doc_node *node,
                        struct err *err)
{
    long count = 1;
    struct place at = node ? doc_place(node) : e->at;
    if (node && !doc_to_long(node, &count, err))
        return false;
    if (count < 1 || count > MAX_SEEDS)
        return err_set(err, ERR_VALUE, &at,
                       "seeds: %ld is not possible; give a count in [1,%d], or a list",
                       count, MAX_SEEDS);
    e->seeds = mem_alloc((size_t)count, sizeof *e->seeds);
    for (long i = 0; i < count; i++)
        e->seeds[e->seed_count++] = i + 1;
    return true;
}

static bool read_seeds(struct experiment *e, const struct doc_node *root, struct err *err)
{
    const struct doc_node *node = doc_get(root, "seeds");
    if (node == NULL || doc_kind(node) != DOC_LIST)
        return count_seeds(e, node, err);
    if (list_of(e, root, "seeds", err) == NULL)
        return false;
    e->seeds = mem_alloc((size_t)doc_count(node), sizeof *e->seeds);
    for (int i = 0; i < doc_count(node); i++)
        if (!read_seed(e, doc_item(node, i), err))
            return false;
    return true;
}

static bool read_all(struct experiment *e, struct err *err)
{
    static const char *const own[] = {
        "experiment", "description", "scenes", "integrators", "seeds", "reference", NULL};
    const struct doc_node *root = doc_root(e->doc);
    e->at = doc_place(root);
    return axes_check_keys(root, own, matrix_settings, err) && read_name(e, root, err) &&
           read_scenes(e, root, err) && read_variants(e, root, err) &&
           read_seeds(e, root, err) && read_reference(e, &e->reference, root, err) &&
           read_axes(&e->axes, root, own, err);
}

struct experiment *experiment_load(const char *path, struct err *err)
{
    struct doc *doc = doc_load(path, err);
    if (doc == NULL)
        return NULL;
    struct experiment *e = mem_alloc(1, sizeof *e);
    e->doc = doc;
    if (read_all(e, err))
        return e;
    experiment_destroy(e);
    return NULL;
}

void experiment_destroy(struct experiment *e)
{
    if (e == NULL)
        return;
    for (size_t i = 0; i < e->scene_count; i++) {
        axes_deinit(&e->scenes[i].axes);
        reference_deinit(&e->scenes[i].reference);
        mem_free(e->scenes[i].path);
        mem_free(e->scenes[i].label);
    }
    for (size_t i = 0; i < e->variant_count; i++)
        axes_deinit(&e->variants[i].axes);
    axes_deinit(&e->axes);
    reference_deinit(&e->reference);
    mem_free(e->scenes);
    mem_free(e->variants);
    mem_free(e->seeds);
    doc_destroy(e->doc);
    mem_free(e);
}
