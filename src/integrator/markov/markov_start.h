#ifndef ETALON_INTEGRATOR_MARKOV_START_H
#define ETALON_INTEGRATOR_MARKOV_START_H

/* The measured start. */

#include "integrator/markov/markov_state.h"

void markov_start_plan(struct markov *m);
void markov_manual_plarge(struct markov *m);
/* What the design takes from the start, which is over: m->start.tallies are its counts.
 */
void markov_start_adapt(struct markov *m);
/* Runs one round; decides p_l at the end of the start. */
void markov_start_round(struct markov *m, const struct round_limits *limits);

#endif
