#ifndef ETALON_INTEGRATOR_MARKOV_PART_H
#define ETALON_INTEGRATOR_MARKOV_PART_H

/* Parts of a run of chains (base/part.h). All parts make the measured start alike, with
 * all chains. Its splats are kept by the first part; from its end on each part continues
 * its own chains. Chains, with their tallies, belong to their part; films and replicas
 * add up.
 */

#include "integrator/markov/markov_state.h"

/* At the end of the start, or after a state of then was read. */
void markov_part_begin(struct markov *m);
/* The method of struct integrator_methods. */
void markov_complete(void *self, const bool *present, int count);
/* Before a part is added that made `done` mutations a chain: scales the sums so far to as
 * many. Under a mutation budget all parts made the same number, and nothing changes. */
void markov_part_scale(struct markov *m, long done);

#endif
