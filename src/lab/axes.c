#include "lab/axes.h"

#include "base/mem.h"
#include "base/text.h"
#include "settings/setting.h"

void axes_deinit(struct axes *axes)
{
    for (size_t i = 0; i < axes->count; i++)
        mem_free(axes->items[i].choices);
    mem_free(axes->items);
    *axes = (struct axes){0};
}

static struct axis *find(const struct axes *axes, const char *name)
{
    for (size_t i = 0; i < axes->count; i++)
        if (text_equal(axes->items[i].name, name))
            return &axes->items[i];
    return NULL;
}

const struct axis *axes_find(const struct axes *axes, const char *name)
{
    return find(axes, name);
}

bool axes_listed(const char *name, const char *const *list)
{
    for (; list && *list; list++)
        if (text_equal(name, *list))
            return true;
    return false;
}

static struct axis *add_axis(struct axes *axes, const char *name)
{
    axes->items = mem_grow(axes->items, &axes->capacity, axes->count + 1,
                           sizeof *axes->items);
    struct axis *axis = &axes->items[axes->count++];
    *axis = (struct axis){.name = name};
    return axis;
}

static bool add_choice(struct axis *axis, const char *key, const struct doc_node *node,
                       struct err *err)
{
    struct choice choice = {.key = key, .at = doc_place(node)};
    struct settings trial;
    settings_init(&trial);
    if (!doc_to_text(node, &choice.value, err) ||
        !settings_set(&trial, key, choice.value, &choice.at, err))
        return false;
    axis->choices = mem_grow(axis->choices, &axis->capacity, axis->count + 1,
                             sizeof *axis->choices);
    axis->choices[axis->count++] = choice;
    return true;
}

static bool check_not_empty(const struct doc_node *node, const char *what,
                            struct err *err)
{
    struct place at = doc_place(node);
    if (doc_kind(node) == DOC_SCALAR || doc_count(node) > 0)
        return true;
    return err_set(err, ERR_VALUE, &at, "%s is empty: there would be no job", what);
}

static bool add_choices(struct axis *axis, const char *key, const struct doc_node *node,
                        struct err *err)
{
    if (doc_kind(node) != DOC_LIST)
        return add_choice(axis, key, node, err);
    for (int i = 0; i < doc_count(node); i++)
        if (!add_choice(axis, key, doc_item(node, i), err))
            return false;
    return check_not_empty(node, key, err);
}

bool axes_add(struct axes *axes, const char *key, const struct doc_node *node,
              struct err *err)
{
    return add_choices(add_axis(axes, key), key, node, err);
}

static bool add_budget(struct axis *axis, const struct doc_node *node, struct err *err)
{
    static const char *const kinds[] = {"seconds", "mutations_per_pixel", NULL};
    if (!doc_check_keys(node, kinds, err) || !check_not_empty(node, "budget", err))
        return false;
    for (int i = 0; i < doc_count(node); i++)
        if (!add_choices(axis, doc_key(node, i), doc_item(node, i), err))
            return false;
    return true;
}

static bool add_budgets(struct axis *axis, const struct doc_node *node, struct err *err)
{
    if (doc_kind(node) != DOC_LIST)
        return add_budget(axis, node, err);
    for (int i = 0; i < doc_count(node); i++)
        if (!add_budget(axis, doc_item(node, i), err))
            return false;
    return check_not_empty(node, "budget", err);
}

static bool is_budget(const char *key)
{
    static const char *const keys[] = {"budget", "seconds", "mutations_per_pixel", NULL};
    return axes_listed(key, keys);
}

bool axes_read(struct axes *axes, const struct doc_node *map, int index, struct err *err)
{
    const char *key = doc_key(map, index);
    const struct doc_node *value = doc_item(map, index);
    struct place at = doc_key_place(map, index);
    const char *name = is_budget(key) ? "budget" : key;
    if (axes_find(axes, name))
        return err_set(err, ERR_VALUE, &at,
                       "'%s' is a second budget here; several are a list: budget: "
                       "[{seconds: S}, {mutations_per_pixel: N}]",
                       key);
    struct axis *axis = add_axis(axes, name);
    return text_equal(key, "budget") ? add_budgets(axis, value, err)
                                     : add_choices(axis, key, value, err);
}

bool axes_check_keys(const struct doc_node *map, const char *const *own,
                     const char *const *except, struct err *err)
{
    size_t count = 0, room = 1;
    for (int i = 0; own[i]; i++)
        room++;
    for (int i = 0; settings_row(i); i++)
        room++;
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    const char **allowed = mem_alloc(room, sizeof *allowed);
    for (; *own; own++)
        allowed[count++] = *own;
    for (int i = 0; settings_row(i); i++)
        if (!axes_listed(settings_row(i)->name, except))
            allowed[count++] = settings_row(i)->name;
    bool ok = doc_check_keys(map, allowed, err);
    mem_free(allowed);
    return ok;
}
