#ifndef ETALON_ANALYSIS_ANALYSIS_DRIFT_H
#define ETALON_ANALYSIS_ANALYSIS_DRIFT_H

/* Statistics of the measured start against those of the whole run, which holds the start
 * in it: eta_s, eta_l, eta_0 and r of lab/statistics, paired by seed. */

#include "analysis/interval.h"
#include "analysis/results.h"

enum { ANALYSIS_DRIFTS = 5 };

struct analysis_drift {
    const char *name;             /* eta_s, eta_l, eta_0, r, p_l */
    struct interval start, whole; /* means over seeds */
    struct interval difference;   /* whole - start */
    double p;                     /* two-sided paired t-test; NaN below two seeds */
    size_t seeds;                 /* with both */
};

/* The last, p_l, is what the rule (chain/plarge.h) says of the three, whether or not the
 * run went by it. False for cells without chains. */
bool analysis_drift(const struct results *results, const struct results_cell *cell,
                    struct analysis_drift drifts[ANALYSIS_DRIFTS]);

#endif
