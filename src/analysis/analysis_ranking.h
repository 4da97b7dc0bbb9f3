#ifndef ETALON_ANALYSIS_ANALYSIS_RANKING_H
#define ETALON_ANALYSIS_ANALYSIS_RANKING_H

/* Who has the lowest error at the end of the runs, of one scene and budget. Compared are
 * the methods as they come: the automatic cells, those without chains, and manual values
 * of p_l that have no automatic one beside them. If that is a single cell, all are
 * compared. */

#include "analysis/families.h"
#include "analysis/interval.h"

struct analysis_rank {
    const struct results_cell *cell;
    double error;          /* geometric mean over seeds */
    struct interval ratio; /* error over that of the best; of the best itself 1 */
    bool is_apart;         /* the ratio's interval lies above 1 */
};

struct analysis_ranking {
    struct analysis_rank *items; /* by error, ascending */
    size_t count;
    size_t seeds; /* of the cell that has the fewest */
    double noise; /* of the reference, subtracted; 0: it is still in the errors */
    bool by_bars; /* intervals are those of the error bars of each cell's first run */
};

/* group: any cell of the scene and budget. Cells whose error is not known in every run
 * are left out. The reference's noise is subtracted if every error is above twice of it.
 * The best one is chosen by the same runs, which makes its lead look a little larger than
 * it is. */
void analysis_ranking_make(const struct results *results, const struct families *families,
                           const struct results_cell *group, enum results_error error,
                           struct analysis_ranking *ranking);
void analysis_ranking_deinit(struct analysis_ranking *ranking);

#endif
