#ifndef ETALON_INTEGRATOR_MARKOV_SINKS_H
#define ETALON_INTEGRATOR_MARKOV_SINKS_H

/* Where a chain's splats go. */

#include "integrator/markov/markov_state.h"
#include "integrator/markov/sink_set.h"

/* Of one chain on a thread, for a round. */
void markov_sinks_init(struct sink_set *sinks, const struct markov *m, int chain,
                       int thread);
/* When the chain has made its round. */
void markov_sinks_flush(const struct sink_set *sinks);

#endif
