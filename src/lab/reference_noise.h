#ifndef ETALON_LAB_REFERENCE_NOISE_H
#define ETALON_LAB_REFERENCE_NOISE_H

/* noise.yaml, beside the mean.exr of a reference: the figures of image/noise.h, and by
 * which definition they were taken:
 *
 *   rmse, relmse, relmse_se, relmse_trimmed
 *   relmse_trim: 0.01            share of the pixels that relmse_trimmed leaves out
 *   relmse_weight: neighbours    weight of a pixel's noise
 *
 * Older programs left out 0.001 of the pixels, weighed each pixel by itself, and wrote
 * neither of the last two keys. Figures by another definition are not used: they are
 * taken anew from half1.exr. */

#include "image/noise.h"

struct reference_noise {
    struct noise noise; /* NAN: not known */
    bool from_pictures; /* the file has another definition, or lacks it */
};

/* Reads the noise.yaml in `folder`; mean: the picture mean.exr there. The noise is not
 * known if the file has another definition and half1.exr is not there. False if a file
 * cannot be read or does not fit. */
bool reference_noise_read(const char *folder, const struct image *mean,
                          struct reference_noise *noise, struct err *err);

/* Writes noise.yaml. */
bool reference_noise_write(const char *folder, const struct noise *noise,
                           struct err *err);
struct noise reference_noise_unknown(void);

#endif
