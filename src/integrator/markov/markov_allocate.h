#ifndef ETALON_INTEGRATOR_MARKOV_ALLOCATE_H
#define ETALON_INTEGRATOR_MARKOV_ALLOCATE_H

/* How many chains each length gets. */

#include "integrator/markov/markov_state.h"

/* Once its bootstrap is there. */
void markov_allocate(struct markov *m);
/* From the groups' chain counts which chains are whose. */
void markov_number_chains(struct markov *m);

#endif
