#ifndef ETALON_INTEGRATOR_MARKOV_MISSED_H
#define ETALON_INTEGRATOR_MARKOV_MISSED_H

/* Evidence of light that chains miss. */

#include "integrator/markov/markov_state.h"

/* Adds the memory, if the test is made. */
void markov_missed_memory(const struct markov *m, struct run_memory *out);
/* Allocates, once chains are allocated to lengths; nothing if the test is not made. */
void markov_missed_create(struct markov *m);
/* Counts the bootstrap paths by tile, before the paths are freed. */
void markov_missed_count_paths(struct markov *m);
/* To or from a checkpoint. */
void markov_missed_pack(struct markov *m, struct pack *pack);
void markov_missed_destroy(struct markov *m);
/* Makes the test; after markov_errors_find. */
void markov_missed_find(const struct markov *m, struct evidence *out);

#endif
