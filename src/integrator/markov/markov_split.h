#ifndef ETALON_INTEGRATOR_MARKOV_SPLIT_H
#define ETALON_INTEGRATOR_MARKOV_SPLIT_H

/* A run whose chains take a share of the light (integrator/split.h): its pilot, the
 * choice of the share, its targets. All are legal without a split. */

#include "integrator/markov/markov_state.h"

/* Allocates, before targets and passes are created. */
void markov_split_create(struct markov *m);
void markov_split_destroy(struct markov *m);
/* Adds the memory. */
void markov_split_memory(const struct markov *m, struct run_memory *out);
/* A target with the share of `inner`, which it owns; and back. */
struct target markov_split_target(const struct markov *m, struct target inner,
                                  int length);
struct target markov_split_unwrap(struct target target);
/* Independent paths before the chains, and how many of them are the pilot's samples. */
long markov_split_bootstrap(const struct markov *m);
long markov_split_samples(const struct markov *m);
/* Before the bootstrap: traces the pilot, and makes the guess. Then chains take all. */
void markov_split_pilot(struct markov *m, const struct round_limits *limits);
/* After the planned bootstrap paths: decides floor, ceiling and the share of passes, and
 * applies them to the paths; b0 = 0 if chains get nothing. */
void markov_split_decide(struct markov *m, const struct round_limits *limits);
/* After the allocation of chains: shares the rest between passes and large steps. */
void markov_split_share_rest(struct markov *m);
/* Frees the pilot's samples. */
void markov_split_end_pilot(struct markov *m);
/* To or from a checkpoint, after the phase. */
void markov_split_pack(struct markov *m, struct pack *pack);

#endif
