#ifndef ETALON_ANALYSIS_INTERVAL_H
#define ETALON_ANALYSIS_INTERVAL_H

/* An estimate with its confidence interval, from independent replicates (seeds). If it is
 * unknown (fewer than two replicates, a value that is not finite), it is NaN, and so are
 * lo and hi; `value` alone may be known. */

#include <stdbool.h>
#include <stddef.h>

#define INTERVAL_LEVEL 0.95 /* of every interval, unless said otherwise */

struct interval {
    double value, lo, hi;
};

struct interval interval_nothing(void);
bool interval_is_known(const struct interval *interval); /* lo and hi too */

/* Mean of x[n] with Student's t interval. */
struct interval interval_mean(const double *x, size_t n);
/* exp of the interval of the mean of log x: a geometric mean; NaN unless all x > 0. */
struct interval interval_log_mean(const double *x, size_t n);
/* Geometric mean of a[n] over that of b[m], independent: Welch's t interval [Welch47] of
 * the difference of mean logs. NaN unless all are > 0; without ends below two of either.
 */
struct interval interval_log_ratio(const double *a, size_t n, const double *b, size_t m);
/* Percentiles of `count` bootstrap replicates of an estimate from n values, expanded as
 * in [Hesterberg15]: each tail has the probability that the normal distribution has
 * beyond sqrt(n/(n-1)) times Student's quantile, as plain percentiles are too narrow for
 * few seeds. Sorts the replicates; one that is NaN makes the interval NaN. */
struct interval interval_percentile(double value, double *replicates, size_t count,
                                    size_t n);

#endif
