#ifndef ETALON_INTEGRATOR_UNTIL_H
#define ETALON_INTEGRATOR_UNTIL_H

/* When a run may end before its budget does: once its verdict is "converged", or once its
 * error bars say that relMSE is below a number. The verdict is looked at along the way,
 * at 8, 12, 18, 27, ... mutations per pixel (each 1.5 times the last one), whatever the
 * clock says, so that a budget in mutations ends at the same bits with any number of
 * threads. A run that is looked at often has as many chances to look good by accident:
 *
 *   converged: two looks in succession must say so: the second has half as much again of
 *   the run before it.
 *   relmse below X: at the k-th look the upper bound of relMSE's interval at level
 *   UNTIL_LEVEL / (k (k+1)) must be below X, and nothing but noise may speak against the
 *   run. These levels sum to UNTIL_LEVEL over any number of looks (alpha spending), which
 *   bounds how often any of them is below X while the truth is not.
 *
 * bench/until.sh counts how often either is wrong. */

#include "base/pack.h"
#include "integrator/verdict.h"
#include "settings/settings.h"

#define UNTIL_LEVEL     0.05
#define UNTIL_FIRST     8.0 /* mutations per pixel */
#define UNTIL_RATIO     1.5
#define UNTIL_CONFIRMED 2

struct until {
    double next; /* look, in mutations per pixel */
    int looks;
    int agreed;   /* looks in succession, up to the last one, that said "converged" */
    double bound; /* of relMSE, at the last look; NAN where it could not be told */
    bool reached; /* it may end */
};

void until_init(struct until *until);
/* A look is due, and the settings ask for looks. */
bool until_due(const struct until *until, const struct settings *settings,
               double mutations_per_pixel);
/* One look; returns until->reached. */
bool until_look(struct until *until, const struct settings *settings,
                double mutations_per_pixel, const struct verdict *verdict);
/* To or from a checkpoint. What was reached there does not count if these settings wait
 * for something else. */
void until_pack(struct pack *pack, struct until *until, const struct settings *settings);

#endif
