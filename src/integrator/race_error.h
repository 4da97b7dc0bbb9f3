#ifndef ETALON_INTEGRATOR_RACE_ERROR_H
#define ETALON_INTEGRATOR_RACE_ERROR_H

/* Errors of pictures of which there are two halves, independent and equally good. */

#include <stdbool.h>

/* The mean of the two halves A and B has the variance E[(A - B)^2] / 4. */
struct race_error {
    /* Mean over blocks of s x s pixels of their squared relative error, times s^2. Where
     * the errors of pixels are independent it is the mean over pixels, by fewer numbers
     * but each of more samples, which more often include a rare one; errors that
     * neighbours have in common count more. Weights are those of relMSE, 1 / (I^2 + e^2),
     * I a blurred picture by independent samples. Nothing is trimmed: of what is rare,
     * the worst pixels are all that pilots show. */
    double relmse;
    /* Light that the others show and this one does not, as squared relative difference of
     * tiles of the film; 0 unless it stands out of their noise. Of light that is rarely
     * hit two halves tell nothing if neither hit it. */
    double missing;
};

/* Luminance of the halves, [pixels]. */
struct race_halves {
    float *picture[2];
    double samples; /* of both, 0: left out */
    /* Not of a chain. The others' pictures are no guess of the brightness of pixels:
     * chains that stay at few places make these far too bright, and the error that they
     * make there would be small relative to that. */
    bool independent;
};

/* Sum over the independent halves so far of their pictures, [pixels]. All weigh the same:
 * if that of the most samples had most of the weight, its rare bright samples would be
 * held against a guess that they have made. */
struct race_light {
    double *sum;
    double halves;
};

/* Of all methods at once; adds their independent halves to *light first. floor: e^2 in
 * the units of the pictures; in a darker picture e is its mean. */
void race_errors(const struct race_halves *halves, int count, int width, int height,
                 double floor, struct race_light *light, struct race_error *out);

#endif
