#ifndef ETALON_CHAIN_TOURS_PIXELS_H
#define ETALON_CHAIN_TOURS_PIXELS_H

/* Weights of pixels by relMSE from a picture of independent samples. */

/* Blurs the picture by a box of at least 3x3 pixels, so wide that it has BLUR_SAMPLES of
 * the picture's `samples` on average, and sets both arrays of the weights. floor: e of
 * relMSE, in squared units of the picture. Returns the blurred picture's mean. */
double tours_pixels_weigh(double *luminance, int width, int height, double samples,
                          double floor, float *scale, float *mean);

#endif
