#ifndef ETALON_ANALYSIS_BASELINE_H
#define ETALON_ANALYSIS_BASELINE_H

/* Baselines: cells (analysis/cells.h) kept as a table, one row a cell and statistic:
 *
 *   scene_label, label, budget, cell   which cell; cell stands for its contents
 *   experiment, commit                 where its runs come from
 *   runs, seed_first, seed_last        how many, and the range of their seeds
 *   statistic, n, missing              its name, runs that have it, runs that do not
 *   value, se, se_within               mean and standard error (natural logarithms for
 *                                      relmse), or the text of a setting
 *
 * What no run of the cell has is left out. */

#include "analysis/cells.h"

/* Fails with file:line if the file is no baseline: missing columns, cells that are not
 * numbers or out of range, a statistic twice, an incomplete last line. */
bool baseline_read(const char *path, struct cells *cells, struct err *err);
/* The file is replaced as a whole or not at all. */
bool baseline_write(const char *path, const struct cells *cells, struct err *err);

#endif
