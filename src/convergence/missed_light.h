#ifndef ETALON_CONVERGENCE_MISSED_LIGHT_H
#define ETALON_CONVERGENCE_MISSED_LIGHT_H

/* Finds light that chains miss. A chain that cannot move between places of very different
 * radiance leaves the dim place too dark for the whole run, and all replicas agree on the
 * wrong value. Large steps are independent samples, so their mean over a tile is
 * unbiased. The kelemen estimator includes them in its picture; for other estimators the
 * picture is compared with them.
 *
 * The test is one-sided. Where light is rare, the mean of few samples is usually too
 * small, so a deficit of the large steps proves nothing; but if the chains show less than
 * the large steps, the chains have missed light.
 *
 * Where few large steps have reached the light, the test has no power. But a plain chain
 * distributes its states in proportion to brightness, so a place that is so dim that it
 * has hardly any states is not resolved. Such places are found by their brightness alone.
 */

#include "convergence/verdict.h"

/* The tiles in which large steps are summed. */
struct missed_grid {
    int width, height; /* of the film, pixels */
    int size;          /* of a tile, pixels each way */
    int columns, rows, tiles;
};

/* Luminance that the picture shows in a tile, summed over its pixels. */
struct tile_shown {
    double plain;  /* contribution of plain samples, which are no chain's */
    double chains; /* contribution of chains */
    double deviations[REPLICAS_MOST]; /* of each replica from the replicas' mean */
};

/* The chains of one path length; the mean of their large steps estimates the light of
 * that length. */
struct missed_stratum {
    long first, count; /* chains */
};

struct missed_light {
    struct missed_grid grid;
    const double *large;       /* [chains][tiles], sums over a chain's large steps */
    const double *large_steps; /* [chains], number of large steps */
    const double *path_hits;   /* [tiles], bootstrap paths with light there */
    const struct missed_stratum *strata;
    int strata_count;
    double scale;  /* converts means of large steps to the units of `shown` */
    double states; /* number of counted states of all chains */
    int replicas;
    const struct tile_shown *shown; /* [tiles] */
};

/* The sums for each chain and tile take at most `bytes`, so with many chains on a large
 * film the tiles are larger than those of the verdict. On a small film they are smaller,
 * because a dim place beside a bright one does not show in a tile that holds both. */
struct missed_grid missed_grid_plan(int width, int height, double chains, double bytes);
int missed_grid_tile(const struct missed_grid *grid, long pixel);

/* Fills missed_* and dim_* of the evidence. Tests single tiles first, then blocks of 2 x
 * 2, 4 x 4, ... tiles: a small dim place does not show in a large block, and the single
 * tiles of a large dim place have too few samples each. */
void missed_light_find(const struct missed_light *in, struct evidence *out);

#endif
