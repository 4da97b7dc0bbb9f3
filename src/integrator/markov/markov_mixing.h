#ifndef ETALON_INTEGRATOR_MARKOV_MIXING_H
#define ETALON_INTEGRATOR_MARKOV_MIXING_H

/* How errors of p_l and of the numbers of chains enter the statistics. */

#include "integrator/markov/markov_state.h"

/* all: tally of all chains; start[chain_count]: tallies at the end of the start. */
struct statistics_mixing markov_mixing(const struct markov *m, const struct tally *all,
                                       const struct tally *start);
/* Adds the error from the numbers of chains; tallies[chain_count]. */
void markov_add_allocation(const struct markov *m, const struct tally *tallies,
                           struct statistics_mixing *mixing);
/* Statistics of all chains from a tally each, lengths weighted by their share of b. */
void markov_measure(const struct markov *m, const struct tally *tallies,
                    struct statistics *out);

#endif
