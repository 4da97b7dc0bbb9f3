#ifndef ETALON_IMPORT_PBRT_COLOUR_SPACE_H
#define ETALON_IMPORT_PBRT_COLOUR_SPACE_H

/* The colour spaces that v4's directive ColorSpace names. */

#include "math/rgb.h"

/* From the space of that number (0: sRGB) to linear Rec. 709: of light, whose white keeps
 * its own colour, and of what reflects, whose white stays white. */
struct rgb pbrt_colour_space_light(int space, struct rgb value);
struct rgb pbrt_colour_space_reflectance(int space, struct rgb value);

#endif
