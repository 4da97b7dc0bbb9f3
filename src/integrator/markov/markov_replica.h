#ifndef ETALON_INTEGRATOR_MARKOV_REPLICA_H
#define ETALON_INTEGRATOR_MARKOV_REPLICA_H

/* Chains in independent parts. */

#include "integrator/markov/markov_state.h"

/* How many there are, once made or if they were; 0: none. */
int markov_replicas_count(const struct markov *m);
/* Adds what they take. */
void markov_replicas_memory(const struct markov *m, struct run_memory *out);
/* Before the clock runs. */
void markov_replicas_create(struct markov *m);
/* Which chain is part of which, once the groups have theirs. */
void markov_replicas_assign(struct markov *m);
void markov_replicas_destroy(struct markov *m);
/* Before a round: splats in units of b0, at the b of now. */
void markov_replicas_set_weights(struct markov *m);
/* After a round: it is part of a span of time. */
void markov_replicas_round(struct markov *m);
/* Which replica a chain is part of. */
int markov_replica_of(const struct markov *m, const struct group *group, int chain);
/* What makes the deviations of so few chains those of all replicas. */
double markov_replica_deviation_scale(double replicas, double chains);

#endif
