#ifndef ETALON_IMPORT_MITSUBA_SKY_H
#define ETALON_IMPORT_MITSUBA_SKY_H

/* Emitters "sky", "sun" and "sunsky". */

#include "import/mitsuba/mitsuba_object.h"

/* The environment's map, factor and turn, after its "to_world". */
bool mitsuba_sky(struct mitsuba *m, struct mitsuba_node *object, struct light_desc *light,
                 struct err *err);

#endif
