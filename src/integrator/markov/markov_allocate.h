#ifndef ETALON_INTEGRATOR_MARKOV_ALLOCATE_H
#define ETALON_INTEGRATOR_MARKOV_ALLOCATE_H

/* Allocates chains to path lengths. */

#include "integrator/markov/markov_state.h"

/* Called after the bootstrap. */
void markov_allocate(struct markov *m);
/* Numbers the chains by group, from the groups' chain counts. */
void markov_number_chains(struct markov *m);

#endif
