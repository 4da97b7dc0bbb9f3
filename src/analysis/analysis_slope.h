#ifndef ETALON_ANALYSIS_ANALYSIS_SLOPE_H
#define ETALON_ANALYSIS_ANALYSIS_SLOPE_H

/* How fast the error falls: least-squares slope of log error against log x over the
 * later half, in log x, of each seed's snapshots. -1 is what independent samples give. */

#include "analysis/interval.h"
#include "analysis/results.h"

struct analysis_slope {
    struct interval raw;       /* mean over seeds, 95 % t interval */
    struct interval corrected; /* of error - noise; NaN unless that is > 0 throughout */
    size_t seeds;              /* seeds with at least three snapshots in that half */
};

struct analysis_slope analysis_slope(const struct results_cell *cell,
                                     enum results_axis axis, enum results_error error);

#endif
