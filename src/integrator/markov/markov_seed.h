#ifndef ETALON_INTEGRATOR_MARKOV_SEED_H
#define ETALON_INTEGRATOR_MARKOV_SEED_H

/* The begin of a run of chains. */

#include "integrator/markov/markov_state.h"

/* Runs the bootstrap, allocates chains to lengths, creates their outputs and seeds them.
 */
void markov_begin(struct markov *m, const struct round_limits *limits);
/* Creates what chains write to and read, once the groups' brightness and chains are
 * known: films, parameters, replicas. */
void markov_create_outputs(struct markov *m);

#endif
