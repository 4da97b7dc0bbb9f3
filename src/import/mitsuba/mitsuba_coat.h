#ifndef ETALON_IMPORT_MITSUBA_COAT_H
#define ETALON_IMPORT_MITSUBA_COAT_H

/* Dielectric coats over another material: here over a diffuse one, others stay as they
 * are, with a note. */

#include "import/mitsuba/mitsuba_mixture.h"

bool mitsuba_coat_smooth(struct mitsuba *m, struct mitsuba_node *object,
                         const struct mitsuba_parts *parts, int *index, struct err *err);
bool mitsuba_coat_rough(struct mitsuba *m, struct mitsuba_node *object,
                        const struct mitsuba_parts *parts, int *index, struct err *err);

#endif
