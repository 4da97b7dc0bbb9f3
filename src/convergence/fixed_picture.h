#ifndef ETALON_CONVERGENCE_FIXED_PICTURE_H
#define ETALON_CONVERGENCE_FIXED_PICTURE_H

/* A picture of a run as sums of integers: those of the parts of a run add up to those of
 * the whole. Path lengths are weighted as the bootstrap found them, so the picture is
 * only approximately right; its noise is that of the picture. Chains and plain samples
 * have sums of their own. */

#include "math/exact_sum.h"

#define FIXED_SUMS 6

struct fixed_picture {
    const void *self;
    /* Adds the sums of a pixel: red, green and blue of chains, and of plain samples. */
    void (*add)(const void *self, long pixel, exact_sum sums[FIXED_SUMS]);
    double scales[2]; /* convert these to the units of the scene file */
    int count;        /* sums that are used: 3 or 6 */
};

#endif
