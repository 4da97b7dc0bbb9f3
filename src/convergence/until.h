#ifndef ETALON_CONVERGENCE_UNTIL_H
#define ETALON_CONVERGENCE_UNTIL_H

/* When a run may end before its budget does: once its verdict is "converged", or once its
 * error bars say that relMSE is below a number. The verdict is computed at 8, 12, 18, 27,
 * ... mutations per pixel (ratio 1.5). These looks do not depend on the clock, so a run
 * with a budget in mutations ends with the same bits for any number of threads. Every
 * look is another chance to stop by accident; therefore:
 *
 * - converged: two successive looks must say so; the run is 1.5 times as long at the
 *   second.
 * - relmse below X: at look k the upper bound of relMSE's interval at level
 *   UNTIL_LEVEL / (k (k+1)) must be below X, and the verdict may have no reason but noise
 *   against the run.
 *
 * The levels sum to UNTIL_LEVEL over any number of looks (alpha
 * spending), which bounds the probability that any bound is below X while the true relMSE
 * is not.
 *
 * bench/until.sh counts how often either is wrong. */

#include "base/pack.h"
#include "convergence/verdict.h"

#define UNTIL_LEVEL     0.05
#define UNTIL_FIRST     8.0 /* mutations per pixel */
#define UNTIL_RATIO     1.5
#define UNTIL_CONFIRMED 2

struct until {
    bool wants_converged; /* the run ends once the verdict is "converged" (and:) */
    double wants_relmse;  /* once relMSE is below this; 0: not asked for */
    double next;          /* time of the next look, in mutations per pixel */
    int looks;
    /* Number of successive looks, the last one included, that said "converged". */
    int agreed;
    double bound; /* upper bound of relMSE at the last look; NAN where unknown */
    bool reached; /* the run may end */
};

void until_init(struct until *until, bool wants_converged, double wants_relmse);
/* The run waits for something. */
bool until_wanted(const struct until *until);
/* It does, and a look is due. */
bool until_due(const struct until *until, double mutations_per_pixel);
/* Looks at the verdict; returns until->reached. */
bool until_look(struct until *until, double mutations_per_pixel,
                const struct verdict *verdict);
/* To or from a checkpoint. `reached` is reset if this run has other conditions than the
 * checkpoint. */
void until_pack(struct pack *pack, struct until *until);

#endif
