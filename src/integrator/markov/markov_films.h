#ifndef ETALON_INTEGRATOR_MARKOV_FILMS_H
#define ETALON_INTEGRATOR_MARKOV_FILMS_H

/* The films of path lengths, own or shared. */

#include "integrator/markov/markov_state.h"

/* Adds the memory of the films. */
void markov_films_memory(struct markov *m, struct run_memory *out);
/* Allocates all films before the clock runs, as clearing 1 GB takes a second or two. */
void markov_films_create(struct markov *m);
/* Assigns films to groups, once their brightness and numbers of chains are known. */
void markov_films_assign(struct markov *m);
/* Before a round: sets the weights of splats of groups that share a film. */
void markov_set_shared_weights(struct markov *m);
/* Factor of the shared film for the picture, divided by the b of all groups that share
 * it. */
double markov_shared_factor(const struct markov *m);

#endif
