#ifndef ETALON_ANALYSIS_ANALYSIS_DRIFT_H
#define ETALON_ANALYSIS_ANALYSIS_DRIFT_H

/* Statistics of the measured start compared with those of the whole run, which includes
 * the start: eta_s, eta_l, eta_0 and r of lab/statistics, paired by seed. */

#include "analysis/interval.h"
#include "analysis/results.h"

enum { ANALYSIS_DRIFTS = 5 };

struct analysis_drift {
    const char *name;             /* eta_s, eta_l, eta_0, r, p_l */
    struct interval start, whole; /* means over seeds */
    struct interval difference;   /* whole - start */
    double p;                     /* two-sided paired t-test; NaN below two seeds */
    size_t seeds;                 /* seeds that have both */
};

/* The last, p_l, is what the rule (chain/plarge.h) gives for the three, even if the run
 * used another p_l. False for cells without chains. */
bool analysis_drift(const struct results *results, const struct results_cell *cell,
                    struct analysis_drift drifts[ANALYSIS_DRIFTS]);

#endif
