#ifndef ETALON_IMAGE_METRIC_H
#define ETALON_IMAGE_METRIC_H

/* Errors of a picture against a reference of the same size. Pixels that are not finite in
 * either are left out of every figure and counted. */

#include "base/err.h"
#include "image/image.h"

/* Added to the denominators of relMSE (squared radiance) and of SMAPE (radiance), so that
 * black pixels do not dominate them. */
#define METRIC_RELATIVE_FLOOR 0.01

/* The trimmed mean leaves out one in this many pixels, those with the highest errors:
 * full relMSE jumps with single pixels. METRIC_TRIM_WORDS is for captions. */
#define METRIC_TRIM       100
#define METRIC_TRIM_WORDS "without the worst 1 % of pixels"

struct metric {
    double mean_ratio; /* luminance of A over B; NaN if both are black */
    double mean_ratio_r, mean_ratio_g, mean_ratio_b;
    double rmse;           /* over all channels */
    double relmse;         /* mean of d^2 / (r^2 + 0.01) over pixels and channels */
    double relmse_trimmed; /* without the highest pixels, METRIC_TRIM, rounded down */
    double smape;          /* mean of |d| / (|a| + |r| + 0.01) [Vogels18] */
    long nonfinite;        /* pixels of A or B that are not finite (left out) */
};

/* False if the sizes differ or no pixel is finite in both. */
bool metric_compare(const struct image *a, const struct image *reference,
                    struct metric *metric, struct err *err);

/* Mean of the pixels' errors, and trimmed mean; sorts them. count > 0. */
void metric_means(double *errors, long count, double *all, double *trimmed);
/* False, with both in *err, if the sizes differ or the pictures are known to be crops of
 * different places of a film. */
bool metric_check_sizes(const struct image *a, const struct image *b, struct err *err);

/* Signed relative difference (a-b)/(|b|+0.1 mean b) of luminance as a red (a brighter) /
 * blue picture on black, full colour from `range` (> 0) on; not finite: green. */
struct image *metric_difference(const struct image *a, const struct image *b,
                                double range, struct err *err);

#endif
