#ifndef ETALON_INTEGRATOR_RACE_ERROR_H
#define ETALON_INTEGRATOR_RACE_ERROR_H

/* Errors of pictures of which there are two halves, independent and equally good. The
 * mean of the two halves A and B has the variance E[(A - B)^2] / 4. */

#include <stdbool.h>

/* Luminance of the halves, [pixels]. */
struct race_halves {
    float *picture[2];
    double samples; /* of both, 0: left out */
    /* Not of a chain. The others' pictures are no guess of the brightness of pixels:
     * chains that stay at few places make these far too bright, and the error that they
     * make there would be small relative to that. */
    bool independent;
};

/* Gives the pictures of chains the mean brightness of the independent ones. */
void race_level(const struct race_halves *halves, int count, long pixels);
/* The weights of relMSE, of which the squares are N / (I^2 + floor), I the blurred mean
 * of the independent halves and N the number of pixels. All weigh the same: if that of
 * the most samples had most of the weight, its rare bright samples would be held against
 * a guess that they have made. floor: e^2 in the units of the pictures; in a darker
 * picture e is its mean. */
void race_weigh(const struct race_halves *halves, int count, int width, int height,
                double floor, float *scale);
/* relMSE of n independent draws a pixel from what a chain has as its target, times n. A
 * pixel of brightness I gets a Poisson number of them, n I / mean(I) in the mean, and so
 * the relative variance mean(I) / (n I). */
double race_draws_error(const struct race_halves *halves, int count, long pixels,
                        const float *scale);
/* Mean over blocks of s x s pixels of their squared relative error, times s^2. Where the
 * errors of pixels are independent it is the mean over pixels, by fewer numbers but each
 * of more samples, which more often include a rare one; errors that neighbours have in
 * common count more. Nothing is trimmed: of what is rare, the worst pixels are all that
 * pilots show. NAN without samples. */
void race_errors(const struct race_halves *halves, int count, int width, int height,
                 const float *scale, double *errors);

#endif
