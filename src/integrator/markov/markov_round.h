#ifndef ETALON_INTEGRATOR_MARKOV_ROUND_H
#define ETALON_INTEGRATOR_MARKOV_ROUND_H

/* Rounds of all chains. */

#include "integrator/markov/markov_state.h"

#define PLAIN_SHARE 0.25 /* of all paths, where some lengths need no chain */

/* until: total mutations a chain at which the round must end; 0: a full round. */
void markov_run_round(struct markov *m, long until, const struct round_limits *limits);
/* Traces plain samples of the lengths that need no chain, if there are any. */
void markov_run_passes(struct markov *m, const struct round_limits *limits);
/* At the end of the start: predicts how many paths a mutation will make. */
void markov_predict_paths(struct markov *m);

#endif
