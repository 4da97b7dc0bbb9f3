#ifndef ETALON_IMPORT_MITSUBA_PRINCIPLED_H
#define ETALON_IMPORT_MITSUBA_PRINCIPLED_H

/* BSDFs of Mitsuba that are taken as the nearest mixture of ours. */

#include "import/mitsuba/mitsuba_object.h"

/* Metal, glass and a coat over a diffuse base, blended by metallic and spec_trans. */
bool mitsuba_principled(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err);
/* A glossy coat over a diffuse base. */
bool mitsuba_ward(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err);

#endif
