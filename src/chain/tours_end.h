#ifndef ETALON_CHAIN_TOURS_END_H
#define ETALON_CHAIN_TOURS_END_H

/* What the pairs of visits add that lie further apart than a tape is long: the sum over
 * all pairs in a whole run, from its growth with the length of pieces of the tapes. See
 * tours_end.c for the model. */

#include "chain/tours.h"

/* The sums that the models give; for tapes of one length. */
struct tours_end;

/* visits: on a tape; whole: in a chain of the whole run, for each p. */
struct tours_end *tours_end_create(double visits, const double whole[TOURS_POINTS]);
void tours_end_destroy(struct tours_end *end);
double tours_end_bytes(void);

/* Sets the factors by which the pairs of whole tapes are to be multiplied, and the
 * standard deviations of their logarithms over the models that fit. pair[c][i]: of 2^c
 * pieces, at tours_p[i]; self[i]: the other term of the variance. Points at which a sum
 * of pairs is not positive are left out. */
void tours_end_extrapolate(const struct tours_end *end,
                           double pair[TOURS_CUTS][TOURS_POINTS],
                           const double self[TOURS_POINTS], double factor[TOURS_POINTS],
                           double spread[TOURS_POINTS]);

/* Values of p from which the growth is taken: .04 to .8. Below, weights of pairs are
 * large and sums noisy; at 1 there are no tours of more than a visit. */
enum { TOURS_END_FIRST = 2, TOURS_END_LAST = 13 };
/* Visits on a tape at least, so that a piece has more than one. */
#define TOURS_END_VISITS 16.0

#endif
