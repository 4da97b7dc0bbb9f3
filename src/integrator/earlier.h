#ifndef ETALON_INTEGRATOR_EARLIER_H
#define ETALON_INTEGRATOR_EARLIER_H

/* A run's picture as it was earlier, in all colours. Replicas hold luminance alone, to
 * which blue adds 7 %: how far the picture has moved since tells how much noisier than
 * that each colour is. Taken whenever the run is twice as long as at the last one, and
 * two are kept, so that one is of a half to a quarter of any run. */

#include "base/pack.h"
#include "image/image.h"

struct earlier {
    struct image *pictures[2]; /* the later one first */
    double lengths[2];         /* of the run then, 0: none yet; unit of the caller */
    double due;
};

/* budget: a length; the first picture is of a small part of it. */
void earlier_init(struct earlier *e, int width, int height, double budget);
void earlier_deinit(struct earlier *e);
/* NULL, or what the picture of now shall be written to. */
struct image *earlier_wants(struct earlier *e, double length);
/* The latest of no more than three quarters of `length`, or NULL. */
const struct image *earlier_picture(const struct earlier *e, double length);
/* To or from a checkpoint, after earlier_init. */
void earlier_pack(struct pack *pack, struct earlier *e);

/* Of red, green, blue: sum over pixels of d^2 / (r^2 + floor), r the picture's and d how
 * far the earlier one's is from it, over the same of luminance; 1 if neither moved. */
void earlier_colours(const struct image *picture, const struct image *before,
                     double floor, double out[3]);

#endif
