#include "import/mitsuba/mitsuba_object.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

#include <stdlib.h>
#include <string.h>

static bool unknown_id(struct mitsuba *m, const struct mitsuba_node *node, const char *id,
                       struct err *err)
{
    const char **known = mem_alloc(m->id_count + 1, sizeof *known);
    for (size_t i = 0; i < m->id_count; i++)
        known[i] = m->ids[i].name;
    suggest_fail(err, &node->place, "id", id, known);
    mem_free(known);
    return false;
}

static int compare_ids(const void *a, const void *b)
{
    return strcmp(((const struct mitsuba_id *)a)->name,
                  ((const struct mitsuba_id *)b)->name);
}

struct mitsuba_node *mitsuba_find(struct mitsuba *m, struct mitsuba_node *node,
                                  struct err *err)
{
    struct mitsuba_id key = {mitsuba_attribute(node, "id"), NULL};
    node->used = true;
    if (!key.name) {
        err_set(err, ERR_SYNTAX, &node->place, "<%s> wants an id", node->name);
        return NULL;
    }
    struct mitsuba_id *found = m->id_count > 0 ? bsearch(&key, m->ids, m->id_count,
                                                         sizeof *m->ids, compare_ids)
                                               : NULL;
    if (!found) {
        unknown_id(m, node, key.name, err);
        return NULL;
    }
    return found->node;
}

struct mitsuba_node *mitsuba_resolve(struct mitsuba *m, struct mitsuba_node *node,
                                     struct err *err)
{
    return text_equal(node->name, "ref") ? mitsuba_find(m, node, err) : node;
}

bool mitsuba_child(struct mitsuba *m, const struct mitsuba_node *object,
                   const char *element, struct mitsuba_node **child, struct err *err)
{
    *child = NULL;
    for (size_t i = 0; i < object->child_count; i++) {
        struct mitsuba_node *target = mitsuba_resolve(m, object->children[i], err);
        if (!target)
            return false;
        if (*child || !text_equal(target->name, element))
            continue;
        object->children[i]->used = target->used = true;
        *child = target;
    }
    return true;
}

bool mitsuba_enter(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    if (object->busy)
        return err_set(err, ERR_VALUE, &object->place, "this <%s> refers to itself",
                       object->name);
    if (m->entered == MITSUBA_NEST_DEPTH)
        return err_set(err, ERR_VALUE, &object->place,
                       "more than %d objects inside one another", MITSUBA_NEST_DEPTH);
    m->entered++;
    object->busy = true;
    return true;
}

void mitsuba_leave(struct mitsuba *m, struct mitsuba_node *object)
{
    m->entered--;
    object->busy = false;
}

const char *mitsuba_type(const struct mitsuba_node *object)
{
    const char *type = mitsuba_attribute(object, "type");
    return type ? type : "";
}

/* How a picture is computed and written, not what is in the scene. */
static bool is_technical(const struct mitsuba_node *object)
{
    static const char *const names[] = {"film", "integrator", "sampler", "rfilter"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (text_equal(object->name, names[i]))
            return true;
    return false;
}

void mitsuba_report(struct mitsuba *m, const struct mitsuba_node *object)
{
    void (*tell)(struct log * log, const struct place *at, const char *format,
                 ...) = is_technical(object) ? log_remark : log_note;
    for (size_t i = 0; i < object->child_count; i++) {
        const struct mitsuba_node *child = object->children[i];
        const char *name = mitsuba_attribute(child, "name");
        if (child->used && text_equal(child->name, "animation"))
            tell(&m->desc->log, &child->place,
                 "nothing moves here: of an <animation> only the start is used");
        if (child->used)
            continue;
        tell(&m->desc->log, &child->place, "unused <%s>%s%s%s of <%s type=\"%s\">",
             child->name, name ? " \"" : "", name ? name : "", name ? "\"" : "",
             object->name, mitsuba_type(object));
    }
}

void mitsuba_unknown(struct mitsuba *m, const struct mitsuba_node *object,
                     const char *const *known, const char *instead)
{
    const char *type = mitsuba_type(object);
    const char *nearest = text_nearest(type, known);
    if (nearest)
        log_note(&m->desc->log, &object->place,
                 "unknown %s \"%s\" (did you mean \"%s\"?): %s", object->name, type,
                 nearest, instead);
    else
        log_note(&m->desc->log, &object->place, "unknown %s \"%s\": %s", object->name,
                 type, instead);
}
