#ifndef ETALON_ANALYSIS_ANALYSIS_CURVE_H
#define ETALON_ANALYSIS_ANALYSIS_CURVE_H

/* Error against time or work: the snapshots of a run joined by straight lines in log-log,
 * and their mean over the seeds of a cell. Nothing is extrapolated. */

#include "analysis/interval.h"
#include "analysis/results.h"

/* The run's error at x, raw; NaN outside its snapshots, or where x or a value next to it
 * is not a positive number. */
double analysis_error_at(const struct results_run *run, enum results_axis axis,
                         enum results_error error, double x);
/* The ends of the run's curve along the axis; false without one. */
bool analysis_range(const struct results_run *run, enum results_axis axis, double *first,
                    double *last);
struct analysis_point {
    double x;
    struct interval raw;       /* geometric mean over seeds, 95 % t interval of the log */
    struct interval corrected; /* the same of error - noise; NaN if not resolved */
    bool resolved;             /* raw.lo lies above the noise, and so does every seed */
};

struct analysis_curve {
    struct analysis_point *points; /* x ascending */
    size_t count;                  /* 0: the seeds' curves have no x in common */
    size_t seeds;                  /* with a curve */
    size_t left_out;               /* without one */
    double noise;                  /* of the reference, subtracted in `corrected` */
};

/* At `points` (at least 2) abscissae, evenly spaced in log x over what the curves of all
 * seeds cover (one if that is a single x). */
void analysis_curve_make(const struct results_cell *cell, enum results_axis axis,
                         enum results_error error, size_t points,
                         struct analysis_curve *curve);
void analysis_curve_deinit(struct analysis_curve *curve);

/* At the end of the runs, from runs.csv. */
struct analysis_point analysis_final(const struct results_cell *cell,
                                     enum results_error error);

#endif
