#ifndef ETALON_INTEGRATOR_GUESS_H
#define ETALON_INTEGRATOR_GUESS_H

/* Weights of pixels by relMSE from a picture of independent samples. */

/* Blurs the picture by a box of at least 3x3 pixels, so wide that it has BLUR_SAMPLES of
 * the picture's `samples` on average, and sets scale to sqrt(N / (I^2 + floor)) of the
 * blurred I; N is the number of pixels. floor: e of relMSE, in squared units of the
 * picture. */
void guess_weigh(double *luminance, int width, int height, double samples, double floor,
                 float *scale);

#endif
