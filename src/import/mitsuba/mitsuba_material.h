#ifndef ETALON_IMPORT_MITSUBA_MATERIAL_H
#define ETALON_IMPORT_MITSUBA_MATERIAL_H

/* <bsdf>s. */

#include "import/mitsuba/mitsuba_mixture.h"

/* *index of the desc, or MITSUBA_MATERIAL_NONE. */
bool mitsuba_material(struct mitsuba *m, struct mitsuba_node *object, int *index,
                      struct err *err);
/* Mitsuba's default for a shape without a BSDF: grey, or black for an emitter. */
bool mitsuba_material_default(struct mitsuba *m, bool emitter, int *index,
                              struct err *err);

#endif
