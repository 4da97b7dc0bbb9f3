#ifndef ETALON_INTEGRATOR_MARKOV_GROUP_H
#define ETALON_INTEGRATOR_MARKOV_GROUP_H

/* The chains of a group together. */

#include "integrator/markov/markov_state.h"

double markov_pixels(const struct markov *m);
/* Of all films; not concurrent with splats. */
void markov_fold(struct markov *m);
/* Sums over the chains of a group, and over all. */
struct tally group_tally(const struct markov *m, const struct group *group);
struct tally markov_tally(const struct markov *m);
/* b of a group from its independent paths, bootstrap and large steps, and the square of
 * its standard error; emission units. */
double group_brightness(const struct markov *m, const struct group *group,
                        double *variance);
/* Its parts: how much the bootstrap's mean counts, and the variance of one path. */
double group_bootstrap_weight(const struct markov *m, const struct group *group);
double group_spread(const struct markov *m, const struct group *group);
/* Adds the sum over samples of the squares of what each adds to b, and of their squares:
 * their ratio, (sum x^2)^2 / sum x^4, is the number of samples that the error hangs on.
 */
void group_moments(const struct markov *m, const struct group *group, double *squares,
                   double *fourths);
/* Counted states of the group's chains. A chain that has found no light yet has none:
 * counted, it would darken the picture. */
double markov_states(const struct markov *m, const struct group *group);
/* The group's chains, of tallies[chain_count] of all. */
struct statistics_part group_part(const struct markov *m, const struct group *group,
                                  const struct tally *tallies);

#endif
