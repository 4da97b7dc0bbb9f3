#ifndef ETALON_MATH_ACCUM_H
#define ETALON_MATH_ACCUM_H

/* Compensated sums, and means and variances in one pass. Merging is done in a fixed order
 * by the caller, so that results do not depend on the number of threads. */

#include <stddef.h>

struct pack;

/* Neumaier's compensated sum: error independent of the number of terms. */
struct accum {
    double sum, compensation;
};
void accum_add(struct accum *a, double x);
double accum_value(const struct accum *a);

/* Welford's running mean and sum of squared deviations. */
struct welford {
    double count, mean, m2;
};
void welford_add(struct welford *w, double x);
void welford_merge(struct welford *into, const struct welford *from);
double welford_variance(const struct welford *w); /* unbiased; 0 below two values */
double welford_se(const struct welford *w);       /* standard error of the mean */
/* To or from a checkpoint (base/pack.h). */
void welford_pack(struct pack *pack, const char *name, struct welford *w, size_t count);

#endif
