#ifndef ETALON_INTEGRATOR_MARKOV_BOOTSTRAP_H
#define ETALON_INTEGRATOR_MARKOV_BOOTSTRAP_H

/* Independent paths. */

#include "integrator/markov/markov_state.h"

/* Of every length, more where they are few. Mutations are budgeted: the same for any
 * clock. */
void markov_run_bootstrap(struct markov *m, const struct round_limits *limits);
/* The most paths that there may be. */
double markov_bootstrap_most(const struct markov *m);
/* Effective number of seeds of all lengths together, 0 without light. */
double markov_effective_seeds(const struct markov *m);
/* The number of a length's path i in the streams of random numbers. */
uint64_t markov_path_number(const struct markov *m, int group, long i);

#endif
