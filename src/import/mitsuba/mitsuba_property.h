#ifndef ETALON_IMPORT_MITSUBA_PROPERTY_H
#define ETALON_IMPORT_MITSUBA_PROPERTY_H

/* The properties of an object, which are children with a name. camelCase (0.5, 0.6) and
 * snake_case (3) are one: names are compared without underscores and case. What nobody
 * asks for is reported by mitsuba_report. */

#include "import/mitsuba/mitsuba_tree.h"

bool mitsuba_same_name(const char *a, const char *b);
/* Whether the NULL-terminated list has the name. */
bool mitsuba_one_of(const char *name, const char *const *list);
/* NULL if there is none of that name. */
struct mitsuba_node *mitsuba_property(struct mitsuba_node *object, const char *name);
/* Declares that these properties (NULL-terminated) have no meaning here. */
void mitsuba_ignore(struct mitsuba_node *object, const char *const *names);

/* *value is untouched if there is no property of that name. */
bool mitsuba_float(struct mitsuba_node *object, const char *name, double *value,
                   struct err *err);
bool mitsuba_integer(struct mitsuba_node *object, const char *name, int *value,
                     struct err *err);
bool mitsuba_boolean(struct mitsuba_node *object, const char *name, bool *value,
                     struct err *err);
bool mitsuba_string(struct mitsuba_node *object, const char *name, const char **value,
                    struct err *err);
bool mitsuba_point(struct mitsuba_node *object, const char *name, double value[3],
                   struct err *err);

/* --- attributes --------------------------------------------------------------------- */

/* Numbers in an attribute, separated by commas or blanks: *count of at most `room`. */
bool mitsuba_numbers(const struct mitsuba_node *node, const char *attribute, size_t room,
                     double *values, size_t *count, struct err *err);
/* Attributes x, y, z, or "value" with one number or three; absent ones are untouched. */
bool mitsuba_xyz(const struct mitsuba_node *node, double xyz[3], struct err *err);

#endif
