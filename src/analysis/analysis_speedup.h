#ifndef ETALON_ANALYSIS_ANALYSIS_SPEEDUP_H
#define ETALON_ANALYSIS_ANALYSIS_SPEEDUP_H

/* How much faster a cell reaches an error than another: the time that B needs divided by
 * the time that A needs to reach the final error of the worse of the two, on their mean
 * curves (analysis_curve). Above 1: A is faster. Interval: 95 % by bootstrap over seeds,
 * expanded percentiles; with fewer than four seeds, whose bootstrap is too narrow, the t
 * interval of the log ratio by the jackknife. */

#include "analysis/interval.h"
#include "analysis/results.h"

#define ANALYSIS_SPEEDUP_SEEDS 4 /* the fewest with an interval by bootstrap */

struct analysis_speedup {
    struct interval ratio; /* x_b / x_a */
    double error;          /* the common error, raw */
    double x_a, x_b;       /* where each curve reaches it */
    bool
        at_least;  /* the better cell reached the error before its curve begins. Its first
                      x is used, so the ratio is a bound: the true one is further from 1 */
    bool resolved; /* both final errors are above the reference's noise */
    bool paired;   /* both have the same seeds, which are resampled together */
    size_t seeds;  /* of the cell that has fewer; below 2 there is no interval */
    size_t replicates,
        clipped; /* replicates; those of them in which the ratio is such a bound */
};

struct analysis_speedup analysis_speedup(const struct results_cell *a,
                                         const struct results_cell *b,
                                         enum results_axis axis,
                                         enum results_error error);

#endif
