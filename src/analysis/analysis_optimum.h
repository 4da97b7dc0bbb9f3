#ifndef ETALON_ANALYSIS_ANALYSIS_OPTIMUM_H
#define ETALON_ANALYSIS_ANALYSIS_OPTIMUM_H

/* The range of best large-step probabilities, as [Zsolnai13, Table 1] has it: the manual
 * values whose error at equal time is not significantly higher than that of the best one.
 * One-sided paired t-tests of log error by seed against the lowest mean of logs, each at
 * the Sidak level of 5 % over the other values. The reference value is chosen by the
 * data, but the truly best value is excluded only if its test against one of the others
 * fails, and each test has that level; so it is in the set with 95 % probability. (Holm's
 * procedure gives no such bound: it suits comparisons with a value that was fixed
 * beforehand.) */

#include "analysis/families.h"

#define ANALYSIS_OPTIMUM_ALPHA 0.05

struct analysis_optimum_value {
    const struct results_cell *cell;
    double p_l;
    double mean;  /* geometric, of the error at x, raw */
    double worse; /* geometric mean of its ratio to the best's */
    double p;     /* of the one-sided test; 1 for the best; NaN if not compared */
    bool in_set;
};

struct analysis_optimum {
    double x;                              /* where they are compared */
    struct analysis_optimum_value *values; /* ascending p_l */
    size_t count;
    size_t best;      /* index; meaningless if seeds < 2 */
    double lo, hi;    /* range of the set; NaN if unknown */
    double level;     /* of each test */
    double p_l_auto;  /* mean over seeds; NaN without an automatic cell */
    bool auto_inside; /* p_l_auto is within this range */
    size_t left_out;  /* manual values that cannot be compared */
    size_t seeds;     /* in common to all that are compared; below 2 there is no set */
    const char *why;  /* what is missing, in words; "" if nothing is */
};

void analysis_optimum_make(const struct family *family, enum results_axis axis,
                           enum results_error error, struct analysis_optimum *optimum);
void analysis_optimum_deinit(struct analysis_optimum *optimum);

#endif
