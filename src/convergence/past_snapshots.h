#ifndef ETALON_CONVERGENCE_PAST_SNAPSHOTS_H
#define ETALON_CONVERGENCE_PAST_SNAPSHOTS_H

/* Pictures of a run at earlier times, in all colours. Replicas hold luminance alone, to
 * which blue contributes 7 %; so the noise of each colour relative to that of luminance
 * is estimated from how far the picture has moved since the snapshot. A snapshot is taken
 * each time the length of the run has doubled. Two are kept, so that one of them is of a
 * quarter to half of the run. */

#include "base/pack.h"
#include "image/image.h"

struct past_snapshots {
    struct image *pictures[2]; /* newer first */
    double lengths[2]; /* length of the run at each, in the caller's unit; 0: none yet */
    double due;
};

/* budget: expected length of the run, which fixes the time of the first snapshot. */
void past_snapshots_init(struct past_snapshots *past, int width, int height,
                         double budget);
void past_snapshots_deinit(struct past_snapshots *past);
/* The image that the current picture is to be written to; NULL if no snapshot is due. */
struct image *past_snapshots_next(struct past_snapshots *past, double length);
/* The newest snapshot taken before three quarters of `length`; NULL if there is none. */
const struct image *past_snapshots_latest(const struct past_snapshots *past,
                                          double length);
/* To or from a checkpoint, after past_snapshots_init. */
void past_snapshots_pack(struct pack *pack, struct past_snapshots *past);

/* For red, green and blue: sum over pixels of d^2 / (r^2 + floor), divided by the same
 * sum for luminance, where r is the picture's value and d its difference from the
 * snapshot. 1 if neither has changed. */
void past_snapshots_colours(const struct image *picture, const struct image *before,
                            double floor, double out[3]);

#endif
