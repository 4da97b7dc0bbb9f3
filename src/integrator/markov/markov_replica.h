#ifndef ETALON_INTEGRATOR_MARKOV_REPLICA_H
#define ETALON_INTEGRATOR_MARKOV_REPLICA_H

/* Independent parts of the chains. */

#include "integrator/markov/markov_state.h"

/* Number of replicas, made or to be made; 0: none. */
int markov_replicas_count(const struct markov *m);
/* Adds their memory. */
void markov_replicas_memory(const struct markov *m, struct run_memory *out);
/* Allocates, before the clock runs. */
void markov_replicas_create(struct markov *m);
/* Assigns chains to replicas, once chains are allocated to groups. */
void markov_replicas_assign(struct markov *m);
void markov_replicas_destroy(struct markov *m);
/* Before a round: converts the shares to units of b0, with the fixed b of each length. */
void markov_replicas_set_weights(struct markov *m);
/* After a round: adds a span of time if one is due. */
void markov_replicas_round(struct markov *m);
/* The replica that a chain is part of. */
int markov_replica_of(const struct markov *m, const struct group *group, int chain);
/* sqrt(R (R-1) / (m (m-1))), the factor of the deviations of m chains in R replicas. */
double markov_replica_deviation_scale(double replicas, double chains);

#endif
