#ifndef ETALON_CHAIN_TOURS_PIXELS_H
#define ETALON_CHAIN_TOURS_PIXELS_H

/* The weights of pixels for chain/tours.h, from the picture that the tapes contain. */

#include "chain/tours.h"

/* Adds the tape's splats by their expected values to luminance[pixels], times `factor`;
 * factor = N b / M gives the mean of M mutations, in the units of b. */
void tours_picture_add(const struct tape *tape, const struct tours_target *target,
                       double factor, double *luminance);

/* Blurs the picture by a box of at least 3x3 pixels, so wide that it has BLUR_SAMPLES of
 * the picture's `samples` on average, and sets both arrays of the weights. floor: e of
 * relMSE, in squared units of the picture. Returns the blurred picture's mean. */
double tours_pixels_weigh(double *luminance, int width, int height, double samples,
                          double floor, float *scale, float *mean);

#endif
