#ifndef ETALON_ANALYSIS_RESAMPLE_H
#define ETALON_ANALYSIS_RESAMPLE_H

/* Draws with replacement for a bootstrap over seeds, the same in every run of the
 * program: a stream for each replicate. */

#include <stddef.h>

#define RESAMPLE_SEED       1
#define RESAMPLE_REPLICATES 2000

/* How often each of n values is drawn in n draws. `group` (0, 1, ...) gives draws that
 * are independent of those of another group. */
void resample_counts(size_t replicate, int group, size_t n, double *counts);

/* A way to halve n values: side[i] is 0 or 1, ones number n/2 rounded down. */
void resample_halves(size_t way, size_t n, int *side);

#endif
