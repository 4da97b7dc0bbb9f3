#ifndef ETALON_RUN_RUN_RANKS_H
#define ETALON_RUN_RUN_RANKS_H

/* A run whose parts are computed by the ranks of base/ranks.h, in step: all make the same
 * rounds, and agree after each what is due. Then rank 0 adds up the states of all. */

#include "run/run_state.h"

/* After a round: sets run->due. False if a rank is gone. */
bool run_ranks_agree(struct run *run, unsigned own, struct err *err);
/* Serves what is due, on rank 0: a row of the error log, a checkpoint, which is that of a
 * whole run, and, if `result` is given, the results. */
bool run_ranks_serve(struct run *run, struct run_result *result, struct err *err);

#endif
