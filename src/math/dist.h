#ifndef ETALON_MATH_DIST_H
#define ETALON_MATH_DIST_H

/* Discrete distributions by inversion [Pharr16, section 13.3.1], with a guide table:
 * monotone in u, so that a small step of a chain stays small. An entry of weight zero is
 * never picked, not even by u = 0 or the last double below 1. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dist {
    int count;
    double sum;     /* of the weights given */
    double *cdf;    /* [count+1], 0 .. 1 */
    int32_t *guide; /* [buckets+1]: entry that holds u = k/buckets */
    int buckets;    /* power of two */
};

/* Weights must be finite and >= 0 with a positive, finite sum, else false (and *dist is
 * empty). */
bool dist_build(struct dist *dist, const double *weights, int count);
void dist_deinit(struct dist *dist);
/* Probability of an entry, exactly that of dist_sample: below 2^-53 of the sum it may be
 * 0 for an entry of positive weight. */
double dist_pdf(const struct dist *dist, int index);
/* Index with its probability; *rest (may be NULL) is u rescaled to [0,1) within it. */
int dist_sample(const struct dist *dist, double u, double *probability, double *rest);
/* A number with which dist_sample gives this index and this rest. False if none does. */
bool dist_invert(const struct dist *dist, int index, double rest, double *u);

/* Memory of the table. */
size_t dist_bytes(const struct dist *dist);

#endif
