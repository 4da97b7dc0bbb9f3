#ifndef ETALON_INTEGRATOR_MARKOV_SPLIT_PLAN_H
#define ETALON_INTEGRATOR_MARKOV_SPLIT_PLAN_H

/* The choice of a split's floor, ceiling and share of passes. */

#include "integrator/markov/markov_state.h"

/* planned: paths of the whole run. */
void split_plan_find(const struct markov *m, const struct pilot *pilot, double planned,
                     struct split_plan *out);

#endif
