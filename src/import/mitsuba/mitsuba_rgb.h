#ifndef ETALON_IMPORT_MITSUBA_RGB_H
#define ETALON_IMPORT_MITSUBA_RGB_H

/* Elements that stand for a colour: rgb, srgb, spectrum, a number for grey. */

#include "import/mitsuba/mitsuba_object.h"

/* Whether the element is one of them. */
bool mitsuba_rgb_is(const struct mitsuba_node *node);
/* Reads the colour in linear Rec. 709; negative components are clamped and counted. */
bool mitsuba_rgb_read(struct mitsuba *m, const struct mitsuba_node *node,
                      struct rgb *value, struct err *err);

#endif
