#ifndef ETALON_IMPORT_MITSUBA_SCENE_H
#define ETALON_IMPORT_MITSUBA_SCENE_H

/* The readers of the children of <scene>. */

#include "import/mitsuba/mitsuba_object.h"

#define MITSUBA_DEPTH_MAX 64 /* edges, where Mitsuba has no limit or a larger one */

bool mitsuba_sensor(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
bool mitsuba_integrator(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
/* An element that Mitsuba does not know; *read: it carries a depth, which was taken. */
bool mitsuba_dialect(struct mitsuba *m, struct mitsuba_node *object, bool *read,
                     struct err *err);
bool mitsuba_emitter(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
bool mitsuba_shape(struct mitsuba *m, struct mitsuba_node *object, struct err *err);

/* The area emitter of a shape. */
bool mitsuba_emitter_area(struct mitsuba *m, struct mitsuba_node *object,
                          struct shape_desc *shape, struct err *err);

#endif
