#ifndef ETALON_INTEGRATOR_MARKOV_SEED_H
#define ETALON_INTEGRATOR_MARKOV_SEED_H

/* Where chains begin. */

#include "integrator/markov/markov_state.h"

/* Independent paths of every length, chains for each, and all that chains need. */
void markov_begin(struct markov *m, const struct round_limits *limits);
/* What groups of known brightness and chains need: films, parameters, replicas. */
void markov_create_outputs(struct markov *m);

#endif
