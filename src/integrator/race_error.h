#ifndef ETALON_INTEGRATOR_RACE_ERROR_H
#define ETALON_INTEGRATOR_RACE_ERROR_H

/* Errors of pictures of which there are two halves, independent and equally good. */

/* The mean of the two halves A and B has the variance E[(A - B)^2] / 4 in every pixel.
 * Its relMSE has the weights 1 / (I^2 + e^2), I a blurred picture. */
struct race_error {
    double full;    /* mean over pixels */
    double trimmed; /* without the highest (image/metric.h, METRIC_TRIM) */
    /* Light that the others show and this one does not, as squared relative difference of
     * tiles of the film; 0 unless it stands out of their noise. Of light that is rarely
     * hit two halves tell nothing if neither hit it. */
    double missing;
};

/* Luminance of the halves, [pixels]. */
struct race_halves {
    float *picture[2];
    double samples; /* of both, 0: left out */
};

/* Of all methods at once: the blurred picture is made of all of them, weighted by
 * samples: by their errors, one that finds nothing would weigh most. floor: e^2 in the
 * units of the pictures; in a darker picture e is its mean.
 */
void race_errors(const struct race_halves *halves, int count, int width, int height,
                 double floor, struct race_error *out);

#endif
