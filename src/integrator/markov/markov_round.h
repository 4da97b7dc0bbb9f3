#ifndef ETALON_INTEGRATOR_MARKOV_ROUND_H
#define ETALON_INTEGRATOR_MARKOV_ROUND_H

/* Every chain goes on. */

#include "integrator/markov/markov_state.h"

/* until: at most so many mutations a chain in all; 0: a full round. */
void markov_run_round(struct markov *m, long until, const struct round_limits *limits);
/* Plain samples of the lengths that need no chain, where there are some. */
void markov_run_passes(struct markov *m, const struct round_limits *limits);

#endif
