#ifndef ETALON_IMPORT_MITSUBA_SPECTRUM_H
#define ETALON_IMPORT_MITSUBA_SPECTRUM_H

/* Plugins of Mitsuba 2 and 3 that are spectra: objects with a type, <spectrum
 * type="d65">. They are read as the colour that Mitsuba's RGB modes make of them. */

#include "import/mitsuba/mitsuba_rgb.h"

bool mitsuba_spectrum_is(const struct mitsuba_node *object);
bool mitsuba_spectrum_read(struct mitsuba *m, struct mitsuba_node *object,
                           enum mitsuba_quantity quantity, struct rgb *value,
                           struct err *err);

#endif
