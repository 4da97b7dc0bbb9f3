#ifndef ETALON_BASE_DOC_H
#define ETALON_BASE_DOC_H

/* A YAML (or JSON) document as a tree whose nodes know their line and column. The only
 * user of libyaml. Duplicate keys and more than one document in a file are errors. */

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>

enum doc_kind { DOC_SCALAR, DOC_LIST, DOC_MAP };

struct doc;
struct doc_node;

struct doc *doc_load(const char *path, struct err *err);
struct doc *doc_parse(const char *text, size_t size, const char *name, struct err *err);
void doc_destroy(struct doc *doc);

const struct doc_node *doc_root(const struct doc *doc);
enum doc_kind doc_kind(const struct doc_node *node);
struct place doc_place(const struct doc_node *node); /* file name lives with the doc */

/* List items and map values by index; keys of maps. */
int doc_count(const struct doc_node *node); /* 0 for scalars */
const struct doc_node *doc_item(const struct doc_node *node, int index);
const char *doc_key(const struct doc_node *map, int index);
struct place doc_key_place(const struct doc_node *map, int index);
const struct doc_node *doc_get(const struct doc_node *map, const char *key); /* or NULL */

const char *doc_text(const struct doc_node *scalar); /* "" unless a scalar */
bool doc_to_double(const struct doc_node *node, double *value, struct err *err);
bool doc_to_long(const struct doc_node *node, long *value, struct err *err);
bool doc_to_bool(const struct doc_node *node, bool *value, struct err *err);
bool doc_to_text(const struct doc_node *node, const char **value, struct err *err);
/* A list of exactly count finite numbers. */
bool doc_to_doubles(const struct doc_node *node, double *values, int count,
                    struct err *err);

/* Fails on the first key of map that is not in the NULL-terminated list: names it, the
 * nearest allowed key, and all allowed ones. */
bool doc_check_keys(const struct doc_node *map, const char *const *allowed,
                    struct err *err);

#endif
