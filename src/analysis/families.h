#ifndef ETALON_ANALYSIS_FAMILIES_H
#define ETALON_ANALYSIS_FAMILIES_H

/* Families: cells that differ in the large-step probability alone, an automatic one with
 * the manual ones that it is compared with. Cells belong together if scene and budget are
 * the same and so are the columns of their settings (integrator, mode, kernel, estimator,
 * builder, direct, allocation, sigma, s1, s2, size, max_depth, start, ...); labels count
 * only where that leaves two cells of the same p_l. `per` and `rule` matter to automatic
 * cells alone: two that differ in them share the manual ones. */

#include "analysis/results.h"

struct family {
    char *name;                           /* the label without its p_l */
    const struct results_cell *automatic; /* or NULL */
    const struct results_cell **manual;   /* ascending p_l, no two the same */
    size_t manual_count;
};

struct families {
    struct family *items;
    size_t count;
};

/* Cells without chains are in none; a lone cell is a family too. */
void families_make(const struct results *results, struct families *families);
void families_deinit(struct families *families);

#endif
