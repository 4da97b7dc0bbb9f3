#ifndef ETALON_CONVERGENCE_MISSED_LIGHT_H
#define ETALON_CONVERGENCE_MISSED_LIGHT_H

/* Light that chains miss. A chain that cannot move between places of very different
 * radiance leaves the dim one too dark for as long as it runs, and its replicas agree on
 * that. Large steps are independent samples: their mean by tile is unbiased. The kelemen
 * estimator has them in its picture; for others the picture is held against them.
 *
 * The test is one-sided: where light is rare, a mean of few samples is mostly too small,
 * whereas chains that show less than these samples have missed something.
 *
 * Where few large steps have met the light the test is blind. But a plain chain spends
 * its states in proportion to brightness: places so dim that it has hardly any states
 * there are not resolved, whatever they look like. They are found by their brightness
 * alone. */

#include "convergence/verdict.h"

/* The tiles that large steps are summed in. */
struct missed_grid {
    int width, height; /* of the film, pixels */
    int size;          /* of a tile, pixels each way */
    int columns, rows, tiles;
};

/* What the picture shows in a tile: luminance, sums over its pixels. */
struct tile_shown {
    double plain;                     /* of plain samples, which no chain adds to */
    double chains;                    /* of chains */
    double deviations[REPLICAS_MOST]; /* of the replicas, from their mean */
};

/* Chains of one path length: a mean of their large steps estimates its light. */
struct missed_stratum {
    long first, count; /* chains */
};

struct missed_light {
    struct missed_grid grid;
    const double *large;       /* [chains][tiles], sums over a chain's large steps */
    const double *large_steps; /* [chains], how many it made */
    const double *path_hits;   /* [tiles], independent paths that met light there */
    const struct missed_stratum *strata;
    int strata_count;
    double scale;  /* of means of large steps, to the units of `shown` */
    double states; /* of all chains */
    int replicas;
    const struct tile_shown *shown; /* [tiles] */
};

/* Sums for each chain and tile take at most `bytes`: of many chains on a large film the
 * tiles are larger than those of the verdict. On a small one they are smaller: what is
 * dim beside what is bright does not show in a tile that holds both. */
struct missed_grid missed_grid_plan(int width, int height, double chains, double bytes);
int missed_grid_tile(const struct missed_grid *grid, long pixel);

/* Fills missed_* and dim_* of the evidence. Looks at single tiles first, then at blocks
 * of two, four, ... each way: a small dim place does not show in a large block, and a
 * large one has too few samples in each of its tiles. */
void missed_light_find(const struct missed_light *in, struct evidence *out);

#endif
