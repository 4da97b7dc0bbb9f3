#ifndef ETALON_IMPORT_MITSUBA_PRINCIPLED_H
#define ETALON_IMPORT_MITSUBA_PRINCIPLED_H

/* The principled BSDFs, and those that are taken as the nearest of ours. */

#include "import/mitsuba/mitsuba_object.h"

bool mitsuba_principled(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err);
/* The diffuse reflection and transmission of principledthin. */
bool mitsuba_principled_thin(struct mitsuba *m, struct mitsuba_node *object, int *index,
                             struct err *err);
/* A glossy coat over a diffuse base. */
bool mitsuba_ward(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err);

#endif
