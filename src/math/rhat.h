#ifndef ETALON_MATH_RHAT_H
#define ETALON_MATH_RHAT_H

/* Whether several sequences of draws have the same distribution: rank-normalised split
 * R-hat and bulk effective sample size [Vehtari21, sections 3 and 4]. Sequences are
 * x[chains][draws]; each is split into halves; an odd first draw is dropped. */

#define RHAT_DRAWS_LEAST 4    /* two in each half */
#define RHAT_MOST        8192 /* chains * draws */

/* The larger of the bulk and the folded one. NAN if all draws are equal, there are fewer
 * than RHAT_DRAWS_LEAST in a sequence, or a draw is not a number. INFINITY: halves that
 * are constant, but not all alike. */
double rhat(const double *x, int chains, int draws);

/* Effective sample size: the number of independent draws with the same information,
 * within [1, S log10 S] for S draws. NAN as above. */
double rhat_effective(const double *x, int chains, int draws);

/* P-value: upper bound of the probability that sequences of independent draws have a rhat
 * as large as this or larger. A factor 2 covers the larger of two statistics; ranks are
 * approximated as normal. 1 for NAN. */
double rhat_tail(double value, int chains, int draws);

#endif
