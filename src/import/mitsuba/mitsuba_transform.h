#ifndef ETALON_IMPORT_MITSUBA_TRANSFORM_H
#define ETALON_IMPORT_MITSUBA_TRANSFORM_H

/* Transforms: <translate>, <rotate>, ... in the order in which they stand. */

#include "import/mitsuba/mitsuba_tree.h"

/* *value is untouched if there is no property of that name. */
bool mitsuba_transform(struct mitsuba_node *object, const char *name, struct xform *value,
                       struct err *err);
/* +z along the way from origin to target, +y anyhow; false if they coincide. */
bool mitsuba_look_along(const double origin[3], const double target[3],
                        struct xform *out);

#endif
