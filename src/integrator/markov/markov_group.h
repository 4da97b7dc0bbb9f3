#ifndef ETALON_INTEGRATOR_MARKOV_GROUP_H
#define ETALON_INTEGRATOR_MARKOV_GROUP_H

/* Sums over the chains of a group. */

#include "integrator/markov/markov_state.h"

double markov_pixels(const struct markov *m);
/* Sums over the chains of a group, and over all. */
struct tally group_tally(const struct markov *m, const struct group *group);
struct tally markov_tally(const struct markov *m);
/* b of a group from its independent paths, bootstrap and large steps, and the square of
 * its standard error; emission units. */
double group_brightness(const struct markov *m, const struct group *group,
                        double *variance);
/* The weight of the bootstrap's mean in b, and the variance of one path. */
double group_bootstrap_weight(const struct markov *m, const struct group *group);
double group_spread(const struct markov *m, const struct group *group);
/* Adds, for the samples' contributions x to b, sum x^2 to the second moments and sum x^4
 * to the fourth; (sum x^2)^2 / sum x^4 is the effective number of samples that determine
 * the error of b [Satterthwaite46]. */
void group_moments(const struct markov *m, const struct group *group, double *squares,
                   double *fourths);
/* Counted states of the group's chains. The time before a chain has found light does not
 * count: it would darken the picture. */
double markov_states(const struct markov *m, const struct group *group);
/* Mutations of a chain that are in the films of all lengths: of the start, in the first
 * part's films, and after it. Both have the factors by which films of parts of other
 * lengths were scaled (markov_part_scale). */
double markov_start_in_films(const struct markov *m);
double markov_main_in_films(const struct markov *m, int chain);
/* Number of mutations by which the film of large steps is divided: of all chains, and
 * without those of missing parts so many that the light of the large steps is right. */
double markov_large_count(const struct markov *m);
/* Whether the group carries enough of the light to ask for a longer start. */
bool group_matters(const struct markov *m, const struct group *group);
/* The group as a part of the statistics; tallies[chain_count] of all chains. */
struct statistics_part group_part(const struct markov *m, const struct group *group,
                                  const struct tally *tallies);

#endif
