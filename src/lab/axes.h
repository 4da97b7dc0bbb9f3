#ifndef ETALON_LAB_AXES_H
#define ETALON_LAB_AXES_H

/* The settings of an experiment as axes: each has one choice or several, and jobs are
 * made from the product. Texts and places are borrowed from the document. */

#include "base/doc.h"

struct choice {
    const char *key, *value; /* as settings_set takes them */
    struct place at;
};

struct axis {
    const char *name; /* the setting's key, or "budget" for either kind of budget */
    struct choice *choices;
    size_t count, capacity;
};

/* Zero-initialise. */
struct axes {
    struct axis *items;
    size_t count, capacity;
};

void axes_deinit(struct axes *axes);
const struct axis *axes_find(const struct axes *axes, const char *name); /* or NULL */

/* Reads entry `index` of a map as a setting: a scalar or a list of scalars. "budget" is a
 * map {seconds: S} or {mutations_per_pixel: N}, each a number or a list, or a list of
 * such maps. Every choice is checked on default settings. */
bool axes_read(struct axes *axes, const struct doc_node *map, int index, struct err *err);
/* Reads an entry of any setting but budgets, with the value `node`. */
bool axes_add(struct axes *axes, const char *key, const struct doc_node *node,
              struct err *err);

/* Fails on a key that is neither in `own` nor a setting; settings in `except` do not
 * count. Lists end with NULL; except may be NULL. */
bool axes_check_keys(const struct doc_node *map, const char *const *own,
                     const char *const *except, struct err *err);

bool axes_listed(const char *name, const char *const *list);

#endif
