#ifndef ETALON_ANALYSIS_ANALYSIS_SPECTRUM_H
#define ETALON_ANALYSIS_ANALYSIS_SPECTRUM_H

/* Spectra of the errors of a cell's runs (image/power_spectrum.h): errors of Markov
 * chains are shared by neighbours, so their power is high at low frequencies; those of
 * independent samples are white. The spectra of many short runs, times what a run costs,
 * are the error spectrum ensemble of [Celarek19]; costs make methods comparable whose
 * runs took different times.
 *
 * The error is that of luminance, relative as relMSE is, with the weights of
 * image/noise.h. With two seeds or more it is the difference of two runs, half of its
 * power: an unbiased estimate of the variance, for which no reference is needed. The
 * pixels with the highest differences, as many as relmse_trimmed leaves out, count as 0:
 * a single one has power at all frequencies. The law of a difference is symmetric, so
 * this adds no bias. With one seed it is the difference from the reference, of all pixels
 * (errors of bright outliers are not symmetric: without these the others would be too
 * dark together, wherever there are many, which is power at low frequencies). */

#include "analysis/results.h"
#include "image/image.h"
#include "image/power_spectrum.h"

struct analysis_spectrum {
    size_t seeds;
    struct power_spectrum mean; /* over seeds, of one run */
    /* Least and greatest power of a difference, by bin. */
    double least[SPECTRUM_BINS], greatest[SPECTRUM_BINS];
    double cost; /* CPU seconds of a run, mean over seeds */
    /* Mean power of the bins below 1/16 over that of those above 1/4 cycles per pixel: 1
     * for independent pixels; NaN if there is no bin below 1/16. */
    double low_over_high;
};

/* pictures[n] of one size; reference: NULL unless n is 1. False with the reason; cost
 * stays NaN. */
bool analysis_spectrum_pictures(const struct image *const *pictures, size_t n,
                                const struct image *reference,
                                struct analysis_spectrum *spectrum, struct err *err);

/* Reads the pictures of the cell, and with one seed its reference. */
bool analysis_spectrum_cell(const struct results *results,
                            const struct results_cell *cell,
                            struct analysis_spectrum *spectrum, struct err *err);

#endif
