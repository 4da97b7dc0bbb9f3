#include "math/warp.h"
#include "path/mutation.h"

/* Additive recurrence: the point n is frac(n / g), frac(n / g^2), with g^3 = g + 1. Any
 * number of its first points is spread evenly over the square. */
static const double steps[2] = {0.7548776662466927, 0.5698402909980532};

/* Evenly spread positions of one chain would not be independent of its past, and their
 * proposals no longer have the density that the acceptance is computed with. So strata
 * are those of all chains at a time: of one chain, the shift alone makes the position
 * uniform. */
void film_points_next(struct film_points *points, double film[2])
{
    struct rng shift;
    rng_init(&shift, points->seed, RNG_FILM, (uint64_t)points->drawn++);
    for (int i = 0; i < 2; i++) {
        double u = (double)points->chain * steps[i] + rng_double(&shift);
        film[i] = warp_unit(u - floor(u));
    }
}
