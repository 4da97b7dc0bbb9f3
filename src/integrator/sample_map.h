#ifndef ETALON_INTEGRATOR_SAMPLE_MAP_H
#define ETALON_INTEGRATOR_SAMPLE_MAP_H

/* How many samples each pixel gets in a pass (adaptive sampling). With n samples pixel i
 * has the error e_i / n and has cost n c_i. Of all divisions of the same work the sum of
 * the errors is least where n is in proportion to sqrt(e_i / c_i). What a pixel has from
 * the start, one sample in each pass, counts as a part of its n.
 *
 * e_i and c_i are estimates from few samples, so they are smoothed over a window. If
 * samples of a pixel decided how many more it gets, the mean of all of them would be
 * biased: a pixel whose first ones missed the light by chance would get few others, which
 * weigh little beside them. So pixels have two colours, as the squares of a chessboard,
 * and whatever decides about a pixel comes from pixels of the other colour alone. Given
 * these, its number of samples is a constant, and the mean of all its camera samples is
 * unbiased; the total, by which the light image is divided, is fixed but for rounding. */

#include <stdint.h>

#define SAMPLE_MAP_MEAN  4    /* samples a pixel in a pass, mean over the film */
#define SAMPLE_MAP_LEAST 0.25 /* of the mean: one sample */
#define SAMPLE_MAP_MOST  64.0 /* of the mean */

static inline int sample_map_colour(int x, int y)
{
    return (x + y) & 1;
}

/* The first pixel of a row that has the colour; each second one follows. */
static inline int sample_map_first(int colour, int y)
{
    return (colour + y) & 1;
}

/* What a start of passes of one sample a pixel tells. */
struct sample_start {
    int width, height;
    const float *errors; /* [height][width]: e_i, relative variances of one sample */
    const float *work;   /* [height][width]: c_i, in any unit */
    double samples;      /* of a pixel */
    double share;        /* of these in the samples of the whole run */
};

/* each: [height][width], samples in a pass. Pixels of a colour get the mean where those
 * of the other predict no gain. Returns the predicted error times work of the whole run
 * over that of uniform samples. */
double sample_map_make(const struct sample_start *start, uint32_t *each);

#endif
