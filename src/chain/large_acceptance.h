#ifndef ETALON_CHAIN_LARGE_ACCEPTANCE_H
#define ETALON_CHAIN_LARGE_ACCEPTANCE_H

/* Acceptance of large steps from a state, as a function of its target alone:
 * a(f) = E_u min(1, f(u)/f), and the second moment E_u min(1, f(u)/f)^2, from the targets
 * of independent paths, zeros included [Liu96]. Kept as a histogram of the targets over
 * the logarithm of f, 16 bins an octave; inside a bin interpolated. The error is below
 * 1e-3, and scaling all targets by a power of two changes no bit of it. */

#include <stdbool.h>

struct pack;

enum {
    LARGE_ACCEPTANCE_OCTAVES =
        96, /* below the greatest target; dimmer ones share a bin */
    LARGE_ACCEPTANCE_BINS = 16 * LARGE_ACCEPTANCE_OCTAVES
};

struct large_acceptance {
    double count; /* paths */
    int top;      /* exponent of the greatest target: below 2^top */
    /* [i]: sums over all targets in bins below i of 1, f, f^2; in units of 2^top. */
    double below[LARGE_ACCEPTANCE_BINS + 1][3];
};

void large_acceptance_build(struct large_acceptance *table, const double *targets,
                            long count);
/* Sets the two moments for a state of target f > 0. */
void large_acceptance_at(const struct large_acceptance *table, double f, double *mean,
                         double *square);
/* To or from a checkpoint (base/pack.h). */
void large_acceptance_pack(struct pack *pack, struct large_acceptance *table);

#endif
