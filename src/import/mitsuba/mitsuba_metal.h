#ifndef ETALON_IMPORT_MITSUBA_METAL_H
#define ETALON_IMPORT_MITSUBA_METAL_H

/* The conductors that Mitsuba knows by name, from measured spectra of their index. */

#include "math/rgb.h"

#include <stdbool.h>

/* Relative to vacuum, in linear Rec. 709; false if there is none of that name. A suffix
 * "_palik" (whose measurement) is accepted where it makes no difference. */
bool mitsuba_metal_find(const char *name, struct rgb *eta, struct rgb *k);
/* The nearest known name, or NULL. */
const char *mitsuba_metal_nearest(const char *name);

#endif
