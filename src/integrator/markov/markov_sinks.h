#ifndef ETALON_INTEGRATOR_MARKOV_SINKS_H
#define ETALON_INTEGRATOR_MARKOV_SINKS_H

/* The outputs of a chain's splats. */

#include "integrator/markov/markov_state.h"
#include "integrator/markov/sink_set.h"

/* Sets up the sinks of one chain on a thread for a round. */
void markov_sinks_init(struct sink_set *sinks, const struct markov *m, int chain,
                       int thread);
/* Flushes the queues after the chain's round. */
void markov_sinks_flush(const struct sink_set *sinks);

#endif
