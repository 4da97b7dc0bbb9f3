#ifndef ETALON_CONVERGENCE_PAST_SNAPSHOTS_H
#define ETALON_CONVERGENCE_PAST_SNAPSHOTS_H

/* A run's picture as it was earlier, in all colours. Replicas hold luminance alone, to
 * which blue adds 7 %: how far the picture has moved since tells how much noisier than
 * that each colour is. Taken whenever the run is twice as long as at the last one, and
 * two are kept, so that one is of a half to a quarter of any run. */

#include "base/pack.h"
#include "image/image.h"

struct past_snapshots {
    struct image *pictures[2]; /* the later one first */
    double lengths[2];         /* of the run then, 0: none yet; unit of the caller */
    double due;
};

/* budget: a length; the first picture is of a small part of it. */
void past_snapshots_init(struct past_snapshots *past, int width, int height,
                         double budget);
void past_snapshots_deinit(struct past_snapshots *past);
/* NULL, or what the picture of now shall be written to. */
struct image *past_snapshots_next(struct past_snapshots *past, double length);
/* The latest of no more than three quarters of `length`, or NULL. */
const struct image *past_snapshots_latest(const struct past_snapshots *past,
                                          double length);
/* To or from a checkpoint, after past_snapshots_init. */
void past_snapshots_pack(struct pack *pack, struct past_snapshots *past);

/* Of red, green, blue: sum over pixels of d^2 / (r^2 + floor), r the picture's and d how
 * far the earlier one's is from it, over the same of luminance; 1 if neither moved. */
void past_snapshots_colours(const struct image *picture, const struct image *before,
                            double floor, double out[3]);

#endif
