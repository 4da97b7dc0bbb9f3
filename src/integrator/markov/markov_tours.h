#ifndef ETALON_INTEGRATOR_MARKOV_TOURS_H
#define ETALON_INTEGRATOR_MARKOV_TOURS_H

/* The rule `tours` in a run: tapes of the chains in the measured start, and p_l from
 * them. */

#include "integrator/markov/markov_state.h"

/* Mutations of a chain in a start that the rule is asked after, at least. */
#define MARKOV_TOURS_LEAST 64

/* Why the run has no tapes though the rule is asked for, as a clause, so that it goes as
 * one by the published rule does; "" if nothing bars them. */
const char *markov_tours_bar(const struct markov *m);
/* Adds the memory. */
void markov_tours_memory(const struct markov *m, struct run_memory *out);
/* Begins the tapes: after the chains are seeded, before the bootstrap paths are freed. */
void markov_tours_begin(struct markov *m);
/* Applies the rule, between two rounds of the start. planned: mutations of a chain in the
 * whole run; fixed_work: of plain samples for each mutation. Sets the groups' p_l where
 * the rule can be trusted, and leaves those of others. Returns whether a longer start
 * would make p_l better. */
bool markov_tours_choose(struct markov *m, double planned, double fixed_work,
                         double p_zsolnai, struct tours_choice *out);
/* Whether all tapes are full, so that a longer start tells nothing new. */
bool markov_tours_full(const struct markov *m);
/* Frees the tapes; legal without any. */
void markov_tours_destroy(struct markov *m);
/* To or from a checkpoint. */
void markov_tours_pack(struct markov *m, struct pack *pack);

#endif
