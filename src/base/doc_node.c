#include "base/doc_node.h"

#include "base/mem.h"
#include "base/text.h"

const struct doc_node *doc_root(const struct doc *doc)
{
    return doc->root;
}

enum doc_kind doc_kind(const struct doc_node *node)
{
    return node->kind;
}

struct place doc_place(const struct doc_node *node)
{
    return (struct place){node->doc->name, node->line, node->col};
}

int doc_count(const struct doc_node *node)
{
    return node->count;
}

const struct doc_node *doc_item(const struct doc_node *node, int index)
{
    return node->values[index];
}

const char *doc_key(const struct doc_node *map, int index)
{
    return map->keys[index]->text;
}

struct place doc_key_place(const struct doc_node *map, int index)
{
    return doc_place(map->keys[index]);
}

const struct doc_node *doc_get(const struct doc_node *map, const char *key)
{
    if (map->kind != DOC_MAP)
        return NULL;
    for (int i = 0; i < map->count; i++)
        if (text_equal(doc_key(map, i), key))
            return map->values[i];
    return NULL;
}

const char *doc_text(const struct doc_node *scalar)
{
    return scalar->kind == DOC_SCALAR ? scalar->text : "";
}

static bool mismatch(const struct doc_node *node, const char *wanted, struct err *err)
{
    struct place at = doc_place(node);
    if (node->kind == DOC_LIST)
        return err_set(err, ERR_VALUE, &at, "expected %s, got a list", wanted);
    if (node->kind == DOC_MAP)
        return err_set(err, ERR_VALUE, &at, "expected %s, got a map", wanted);
    if (node->text[0] == '\0')
        return err_set(err, ERR_VALUE, &at, "expected %s, got nothing", wanted);
    return err_set(err, ERR_VALUE, &at, "expected %s, got '%s'", wanted, node->text);
}

bool doc_to_double(const struct doc_node *node, double *value, struct err *err)
{
    return text_to_double(doc_text(node), value) ||
           mismatch(node, "a finite number", err);
}

bool doc_to_long(const struct doc_node *node, long *value, struct err *err)
{
    return text_to_long(doc_text(node), value) || mismatch(node, "a whole number", err);
}

bool doc_to_bool(const struct doc_node *node, bool *value, struct err *err)
{
    const char *text = doc_text(node);
    bool yes = text_equal(text, "true");
    if (!yes && !text_equal(text, "false"))
        return mismatch(node, "true or false", err);
    *value = yes;
    return true;
}

bool doc_to_text(const struct doc_node *node, const char **value, struct err *err)
{
    bool missing = node->kind == DOC_SCALAR && node->plain && node->text[0] == '\0';
    if (node->kind != DOC_SCALAR || missing)
        return mismatch(node, "text", err);
    *value = node->text;
    return true;
}

bool doc_to_doubles(const struct doc_node *node, double *values, int count,
                    struct err *err)
{
    struct place at = doc_place(node);
    if (node->kind != DOC_LIST)
        return mismatch(node, "a list of numbers", err);
    if (node->count != count)
        return err_set(err, ERR_VALUE, &at, "expected a list of %d numbers, got %d",
                       count, node->count);
    for (int i = 0; i < count; i++)
        if (!doc_to_double(node->values[i], &values[i], err))
            return false;
    return true;
}

static bool is_allowed(const char *key, const char *const *allowed)
{
    for (; *allowed; allowed++)
        if (text_equal(key, *allowed))
            return true;
    return false;
}

static bool unknown_key(const struct doc_node *key, const char *const *allowed,
                        struct err *err)
{
    struct text list = {0};
    for (const char *const *a = allowed; *a; a++)
        text_append(&list, "%s%s", a == allowed ? "" : ", ", *a);
    const char *nearest = text_nearest(key->text, allowed);
    struct place at = doc_place(key);
    err_set(err, ERR_VALUE, &at, "unknown key '%s'%s%s%s; allowed: %s", key->text,
            nearest ? " (did you mean '" : "", nearest ? nearest : "",
            nearest ? "'?)" : "", list.data ? list.data : "none");
    mem_free(list.data);
    return false;
}

bool doc_check_keys(const struct doc_node *map, const char *const *allowed,
                    struct err *err)
{
    if (map->kind != DOC_MAP)
        return mismatch(map, "a map", err);
    for (int i = 0; i < map->count; i++)
        if (!is_allowed(doc_key(map, i), allowed))
            return unknown_key(map->keys[i], allowed, err);
    return true;
}
