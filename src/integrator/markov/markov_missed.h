#ifndef ETALON_INTEGRATOR_MARKOV_MISSED_H
#define ETALON_INTEGRATOR_MARKOV_MISSED_H

/* Light that chains miss. */

#include "integrator/markov/markov_state.h"

/* Adds what it takes, where it is wanted. */
void markov_missed_memory(const struct markov *m, struct run_memory *out);
/* Once the chains are counted; nothing where it is not wanted. */
void markov_missed_create(struct markov *m);
/* While there are bootstrap paths. */
void markov_missed_count_paths(struct markov *m);
/* To or from a checkpoint. */
void markov_missed_pack(struct markov *m, struct pack *pack);
void markov_missed_destroy(struct markov *m);
/* Once the errors are found. */
void markov_missed_find(const struct markov *m, struct evidence *out);

#endif
