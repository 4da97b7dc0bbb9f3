#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_scene.h"

#include <stdlib.h>
#include <string.h>

static void add_id(struct mitsuba *m, const char *name, struct mitsuba_node *node)
{
    m->ids = mem_grow(m->ids, &m->id_capacity, m->id_count + 1, sizeof *m->ids);
    m->ids[m->id_count++] = (struct mitsuba_id){name, node};
}

/* Collects every object with an id at any depth. */
static void collect_ids(struct mitsuba *m, struct mitsuba_node *node)
{
    for (size_t i = 0; i < node->child_count; i++) {
        struct mitsuba_node *child = node->children[i];
        const char *id = mitsuba_attribute(child, "id");
        if (id && !text_equal(child->name, "ref") && !text_equal(child->name, "alias"))
            add_id(m, id, child);
        collect_ids(m, child);
    }
}

/* Once all ids are known: <alias id="old" as="new"/>. */
static bool collect_aliases(struct mitsuba *m, struct mitsuba_node *node, struct err *err)
{
    for (size_t i = 0; i < node->child_count; i++) {
        struct mitsuba_node *child = node->children[i];
        const char *as = mitsuba_attribute(child, "as");
        if (!collect_aliases(m, child, err))
            return false;
        if (!text_equal(child->name, "alias"))
            continue;
        struct mitsuba_node *target = as ? mitsuba_find(m, child, err) : NULL;
        if (!as)
            err_set(err, ERR_SYNTAX, &child->place, "<alias> wants id and as");
        if (!target)
            return false;
        m->aliases = mem_grow(m->aliases, &m->alias_capacity, m->alias_count + 1,
                              sizeof *m->aliases);
        m->aliases[m->alias_count++] = (struct mitsuba_id){as, target};
    }
    return true;
}

static int compare_ids(const void *a, const void *b)
{
    const struct mitsuba_id *x = a, *y = b;
    int order = strcmp(x->name, y->name);
    if (order != 0)
        return order;
    return (x->node->place.line > y->node->place.line) -
           (x->node->place.line < y->node->place.line);
}

static bool sort_ids(struct mitsuba *m, struct err *err)
{
    if (m->id_count > 0)
        qsort(m->ids, m->id_count, sizeof *m->ids, compare_ids);
    for (size_t i = 1; i < m->id_count; i++)
        if (text_equal(m->ids[i].name, m->ids[i - 1].name))
            return err_set(err, ERR_VALUE, &m->ids[i].node->place,
                           "the id \"%s\" is taken (%s:%d)", m->ids[i].name,
                           m->ids[i - 1].node->place.file,
                           m->ids[i - 1].node->place.line);
    return true;
}

/* "0.6.0" is of old, "3.0.0" is not. */
static bool read_version(struct mitsuba *m, struct err *err)
{
    const char *version = mitsuba_attribute(m->root, "version");
    if (!version) {
        log_remark(&m->desc->log, &m->root->place,
                   "<scene> has no version; the defaults of Mitsuba 3 are taken");
        return true;
    }
    char *end;
    long major = strtol(version, &end, 10);
    if (end == version || major < 0 || (*end != '.' && *end != '\0'))
        return err_set(err, ERR_VALUE, &m->root->place, "\"%.40s\" is no version",
                       version);
    m->major = major > 1000 ? 1000 : (int)major;
    m->old = major == 0;
    return true;
}

static bool skip(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    (void)m, (void)object, (void)err;
    return true;
}

/* Materials, textures and the like are read when a shape asks for them. */
static const struct {
    const char *element;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
} rows[] = {
    {"integrator", mitsuba_integrator},
    {"sensor", mitsuba_sensor},
    {"emitter", mitsuba_emitter},
    {"shape", mitsuba_shape},
    {"bsdf", skip},
    {"texture", skip},
    {"film", skip},
    {"default", skip},
    {"include", skip},
    {"alias", skip},
};

#define ROWS (sizeof rows / sizeof rows[0])

static bool read_object(struct mitsuba *m, struct mitsuba_node *child, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    struct mitsuba_node *object = mitsuba_resolve(m, child, err);
    if (!object)
        return false;
    for (size_t i = 0; i < ROWS; i++) {
        if (text_equal(object->name, rows[i].element))
            return rows[i].read(m, object, err);
        known[i] = rows[i].element;
    }
    bool dialect;
    if (!mitsuba_dialect(m, object, &dialect, err))
        return false;
    if (dialect)
        return true;
    const char *nearest = text_nearest(object->name, known);
    log_note(&m->desc->log, &object->place, "<%s> is not read%s%s%s", object->name,
             nearest ? "; did you mean <" : "", nearest ? nearest : "",
             nearest ? ">?" : "");
    return true;
}

/* Each on its own, so that all that is wrong is told at once. */
static bool read_objects(struct mitsuba *m, const struct import_options *options,
                         struct err *err)
{
    bool good = true, more = true;
    for (size_t i = 0; more && i < m->root->child_count; i++) {
        struct err failure = {0};
        if (read_object(m, m->root->children[i], &failure))
            continue;
        good = false;
        more = import_failure_add(options, &failure, err);
        m->entered = m->two_sided = 0;
    }
    return good;
}

static bool read_scene(struct mitsuba *m, const char *path,
                       const struct import_options *options, struct err *err)
{
    m->root = mitsuba_tree_read(m->desc, path, options, err);
    if (!m->root)
        return false;
    collect_ids(m, m->root);
    if (!read_version(m, err) || !sort_ids(m, err) || !collect_aliases(m, m->root, err))
        return false;
    for (size_t i = 0; i < m->alias_count; i++)
        add_id(m, m->aliases[i].name, m->aliases[i].node);
    if (!sort_ids(m, err))
        return false;
    return read_objects(m, options, err);
}

static char *join_definitions(const struct import_options *options)
{
    struct text text = {0};
    for (int i = 0; options && i < options->definition_count; i++)
        text_append(&text, "%s%s", i > 0 ? " " : "", options->definitions[i]);
    return text.data;
}

struct scene_desc *import_mitsuba(const char *path, const struct import_options *options,
                                  struct err *err)
{
    struct mitsuba m = {
        .desc = scene_desc_create(path), .major = 3, .defaults = {-1, -1}};
    m.directory = text_directory(path);
    m.desc->definitions = join_definitions(options);
    m.desc->max_depth = MITSUBA_DEPTH_MAX; /* Mitsuba's own: no limit */
    m.ahead = ahead_read(path, m.directory, "\"'\n", &m.desc->textures, options);
    bool read = read_scene(&m, path, options, err);
    ahead_destroy(m.ahead);
    mitsuba_tree_destroy(m.root);
    mem_free(m.ids);
    mem_free(m.aliases);
    mem_free(m.directory);
    return read ? m.desc : import_failure_give_up(options, m.desc);
}
