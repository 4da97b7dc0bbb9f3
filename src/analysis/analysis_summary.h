#ifndef ETALON_ANALYSIS_ANALYSIS_SUMMARY_H
#define ETALON_ANALYSIS_ANALYSIS_SUMMARY_H

/* Regret over all cells of an experiment, of each way to choose p_l: by a rule, or the
 * same constant everywhere. A cell is here a scene, a budget and a method with manual
 * values of p_l; regret is the error over that of the best manual value
 * (analysis_regret.h). */

#include "analysis/families.h"

struct analysis_policy {
    char *name;       /* "automatic, zsolnai2013", "p_l = 0.3" */
    double p_l;       /* NaN: automatic */
    size_t cells;     /* whose regret is known */
    size_t left_out;  /* all others: the value was not run, or is not above the noise */
    double mean;      /* geometric, over the cells */
    double worst;     /* the highest regret */
    char *worst_name; /* of that cell: "coffee, 5 s, pssmlt" */
};

struct analysis_summary {
    struct analysis_policy *items; /* the automatic ones first, then by p_l */
    size_t count, capacity;
    size_t cells; /* all */
};

void analysis_summary_make(const struct results *results, const struct families *families,
                           enum results_axis axis, enum results_error error,
                           struct analysis_summary *summary);
void analysis_summary_deinit(struct analysis_summary *summary);

/* The constant with the lowest mean, of those that every cell has; NULL if there is none.
 */
const struct analysis_policy *
analysis_best_constant(const struct analysis_summary *summary);

#endif
