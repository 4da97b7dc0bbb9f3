#ifndef ETALON_CONVERGENCE_PAST_SNAPSHOTS_H
#define ETALON_CONVERGENCE_PAST_SNAPSHOTS_H

/* Pictures of a run at earlier times, in all colours. Replicas hold luminance alone, to
 * which blue contributes 7 %; so the noise of each colour relative to that of luminance
 * is estimated from how far the picture has moved since the snapshot. A snapshot is taken
 * each time the length of the run has doubled. Two are kept, so that one of them is of a
 * quarter to half of the run. They are pictures with fixed weights (fixed_picture.h), and
 * are to be compared with such a picture. A part of a run (base/part.h) keeps their sums,
 * which are added to those of other parts. */

#include "base/pack.h"
#include "convergence/fixed_picture.h"
#include "image/image.h"

struct past_snapshots {
    struct image *pictures[2]; /* newer first */
    double lengths[2]; /* length of the run at each, in the caller's unit; 0: none yet */
    double due;
    exact_sum *sums[2]; /* [height][width][count] of each; NULL unless parts are added */
    double scales[2][2];
    int count; /* as in struct fixed_picture */
};

/* budget: expected length of the run, which fixes the time of the first snapshot. count:
 * sums to keep for other parts, as in struct fixed_picture; 0: none. */
void past_snapshots_init(struct past_snapshots *past, int width, int height,
                         double budget, int count);
void past_snapshots_deinit(struct past_snapshots *past);
/* Memory in bytes. */
double past_snapshots_bytes(int width, int height, int count);
bool past_snapshots_due(const struct past_snapshots *past, double length);
/* Takes one, which is due. */
void past_snapshots_take(struct past_snapshots *past, double length,
                         const struct fixed_picture *picture);
/* Forgets the sums that are kept for other parts. */
void past_snapshots_clear(struct past_snapshots *past);
/* Writes a picture with fixed weights. */
void fixed_picture_write(const struct fixed_picture *picture, struct image *out);
/* After those of other parts were added (past_snapshots_pack): makes the pictures, times
 * `factor`. */
void past_snapshots_complete(struct past_snapshots *past, double factor);
/* The newest snapshot taken before three quarters of `length`; NULL if there is none. */
const struct image *past_snapshots_latest(const struct past_snapshots *past,
                                          double length);
/* Copies the pictures and their times. */
void past_snapshots_take_pictures(struct past_snapshots *past,
                                  const struct past_snapshots *from);
/* To or from a checkpoint, after past_snapshots_init; pictures, or sums if it keeps them.
 */
void past_snapshots_pack(struct pack *pack, struct past_snapshots *past);

/* For red, green and blue: sum over pixels of d^2 / (r^2 + floor), divided by the same
 * sum for luminance, where r is the picture's value and d its difference from the
 * snapshot `before`. 1 if neither has changed. */
void past_snapshots_colours(const struct image *picture, const struct image *before,
                            double floor, double out[3]);

#endif
