#ifndef ETALON_ANALYSIS_ANALYSIS_SPEEDUP_H
#define ETALON_ANALYSIS_ANALYSIS_SPEEDUP_H

/* How much sooner a cell comes to an error than another: the time that B needs over the
 * time that A needs to reach the error that the worse of them has at its end, on their
 * mean curves (analysis_curve). Above 1: A is faster. */

#include "analysis/interval.h"
#include "analysis/results.h"

struct analysis_speedup {
    struct interval
        ratio;       /* x_b / x_a; 95 % by bootstrap over seeds, expanded percentiles */
    double error;    /* that both are to reach, raw */
    double x_a, x_b; /* where they do */
    bool at_least;   /* the better one was there before its curve begins: with x at its
                      * first abscissa the ratio is a bound, further from 1 in truth */
    bool resolved;   /* both end above the reference's noise */
    bool paired;     /* the same seeds: resampled together */
    size_t seeds;    /* of the cell that has fewer; below 2 there is no interval */
    size_t replicates, clipped; /* of them, how many had to take such a bound */
};

struct analysis_speedup analysis_speedup(const struct results_cell *a,
                                         const struct results_cell *b,
                                         enum results_axis axis,
                                         enum results_error error);

#endif
