#ifndef ETALON_MATH_RHAT_H
#define ETALON_MATH_RHAT_H

/* Whether several sequences of draws look like one: rank-normalised split R-hat and bulk
 * effective sample size [Vehtari21, sections 3 and 4]. Sequences are x[chains][draws];
 * each is split in halves, of an odd number of draws the first is dropped. */

#define RHAT_DRAWS_LEAST 4    /* two in each half */
#define RHAT_MOST        8192 /* chains * draws */

/* The larger of the bulk and the folded one. NAN if all draws are equal, there are fewer
 * than RHAT_DRAWS_LEAST in a sequence, or a draw is not a number. INFINITY: halves that
 * are constant, but not all alike. */
double rhat(const double *x, int chains, int draws);

/* How many independent draws all of them are worth, within [1, S log10 S] of S. NAN as
 * above. */
double rhat_effective(const double *x, int chains, int draws);

/* The probability that sequences of independent draws of one law give a rhat as large as
 * this or larger; an upper bound (of two statistics the larger), in the normal
 * approximation to ranks. 1 for NAN. */
double rhat_tail(double value, int chains, int draws);

#endif
