#ifndef ETALON_IMAGE_FLIP_H
#define ETALON_IMAGE_FLIP_H

/* FLIP: the difference that a viewer sees when two pictures alternate on a screen
 * [Andersson20], and HDR-FLIP, the same for pictures whose exposure is not known
 * [Andersson21]. Values are means over pixels of a difference in [0,1].
 *
 * The viewer sees 67 pixels per degree, that is 0.7 m from a screen 0.7 m wide with 3840
 * pixels, as both papers assume. */

#include "base/err.h"
#include "image/image.h"
#include "math/warp.h"

#define FLIP_PIXELS_PER_DEGREE (3840.0 * MATH_PI / 180.0)

struct flip {
    double ldr; /* LDR-FLIP of both pictures clamped to [0,1], without any tone curve */
    /* HDR-FLIP: the largest LDR-FLIP of each pixel over exposures, with the ACES curve
     * of [Narkowicz15]. They go from the one that brings the reference's largest
     * luminance to .85 to that which does so with the median, in steps of at most one
     * stop, two at least. Where the median is 0, that of the lit pixels takes its
     * place. */
    double hdr;
    int exposures;                        /* number of them */
    double exposure_first, exposure_last; /* in stops */
};

/* False if the sizes differ or no pixel is finite in both; such pixels are replaced by
 * the other picture's value, or black, and are left out of the means. Takes about .3 us
 * a pixel and exposure. */
bool flip_compare(const struct image *a, const struct image *reference, struct flip *out,
                  struct err *err);

#endif
