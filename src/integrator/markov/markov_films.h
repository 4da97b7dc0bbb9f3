#ifndef ETALON_INTEGRATOR_MARKOV_FILMS_H
#define ETALON_INTEGRATOR_MARKOV_FILMS_H

/* Films, shared or not. */

#include "integrator/markov/markov_state.h"

/* Adds what films will take. */
void markov_films_memory(const struct markov *m, struct run_memory *out);
/* All that there will be, before the clock runs: a GB takes a second or two. */
void markov_films_create(struct markov *m);
/* Which group gets which, once they have their brightness and their chains. */
void markov_films_assign(struct markov *m);
/* Before a round: what the splats of groups that share a film count for. */
void markov_set_shared_weights(struct markov *m);
/* What the shared film is multiplied by for the picture, over b of all that share. */
double markov_shared_factor(const struct markov *m);

#endif
