#ifndef ETALON_IMAGE_POWER_SPECTRUM_H
#define ETALON_IMAGE_POWER_SPECTRUM_H

/* The radially averaged power spectrum of a field over the pixels, such as an error.
 *
 * Overlapping squares of the field (half a side apart) times a Hann window are
 * transformed, and the power is averaged over the squares and over rings of frequency
 * [Welch67]. The power is that of a pixel: independent errors of variance v have power v
 * at every frequency; errors that neighbours share have more at low and less at high
 * ones. Frequencies into which the window lets the mean of the field are left out. */

#include <stdbool.h>

#define SPECTRUM_BINS 16

struct power_spectrum {
    int count; /* of bins */
    /* Of the bins, ascending: geometric mean of the ends of the ring, cycles per pixel,
     * half an octave apart up to 0.5; and the mean power in it. */
    double frequency[SPECTRUM_BINS];
    double power[SPECTRUM_BINS];
};

/* Side of the squares for this size, pixels; 0: it is too small for a spectrum. */
int power_spectrum_side(int width, int height);
/* field[height][width]. False, with count 0, if it is too small. */
bool power_spectrum_make(const double *field, int width, int height,
                         struct power_spectrum *spectrum);

#endif
