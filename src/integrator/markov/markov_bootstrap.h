#ifndef ETALON_INTEGRATOR_MARKOV_BOOTSTRAP_H
#define ETALON_INTEGRATOR_MARKOV_BOOTSTRAP_H

/* The bootstrap of all path lengths. */

#include "integrator/markov/markov_state.h"

/* Traces the planned paths of every length; then additional ones where they are few, as
 * seeds. Under a mutation budget the result does not depend on the clock. */
void markov_bootstrap_planned(struct markov *m, const struct round_limits *limits);
void markov_bootstrap_more(struct markov *m, const struct round_limits *limits);
/* Upper bound of the number of paths. */
double markov_bootstrap_most(const struct markov *m);
/* Effective number of seeds over all lengths; 0 without light. */
double markov_effective_seeds(const struct markov *m);
/* Number of path i of a group in the random streams. */
uint64_t markov_path_number(const struct markov *m, int group, long i);

#endif
