#ifndef ETALON_ANALYSIS_ANALYSIS_WHY_H
#define ETALON_ANALYSIS_ANALYSIS_WHY_H

/* Why one method has a lower error than another at the same budget: error = (error of one
 * path per pixel) / (paths per pixel), so the ratio of two errors is that of their speeds
 * times that of what a path is worth. And what to doubt: error bars of a run that has not
 * converged, light that a method does not sample. */

#include "base/text.h"
#include "analysis/analysis_ranking.h"

struct analysis_why {
    double pixels;       /* of the picture */
    double speed;        /* paths per CPU second, mean over seeds */
    double error_a_path; /* error times paths per pixel, geometric mean over seeds */
    double estimated, estimated_se;  /* relMSE by the run's own error bars, means */
    double acceptance, failure_rate; /* NaN without chains */
    double b, b_se;                  /* brightness of the picture, means */
    double brightness;    /* b over its median of all methods of the scene and budget */
    bool is_off;          /* brightness differs from 1 by more than can be chance */
    const char *verdict;  /* of the first run; "" if unknown */
    const char *blind_to; /* light that the method cannot sample; "" if none */
};

void analysis_why_make(const struct results *results, const struct results_cell *cell,
                       enum results_error error, struct analysis_why *why);

/* "mmlt makes 1.7 times as many paths per CPU second as pssmlt, and has 0.4 times its
 * error per path: ...", for the best and the next method of another integrator; then what
 * to doubt of either. Nothing below two of them. */
void analysis_append_why(struct text *text, const struct results *results,
                         const struct analysis_ranking *ranking,
                         enum results_error error);

#endif
