#ifndef ETALON_IMPORT_MITSUBA_INSTANCE_H
#define ETALON_IMPORT_MITSUBA_INSTANCE_H

/* <shape type="shapegroup"> and "instance". */

#include "import/mitsuba/mitsuba_object.h"

/* Shapes of a group are read when the first instance asks for them. */
bool mitsuba_instance(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
/* Adds a shape that was read to the group that is being read, else to the scene. Takes
 * its mesh. */
void mitsuba_instance_add(struct mitsuba *m, const struct shape_desc *shape);

#endif
