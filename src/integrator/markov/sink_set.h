#ifndef ETALON_INTEGRATOR_SINK_SET_H
#define ETALON_INTEGRATOR_SINK_SET_H

/* What becomes of a chain's splats (chain/splat_sink.h): one struct for each use, which
 * the integrator fills and hands in for a round. Its `sink` must be first. */

#include "chain/splat_sink.h"
#include "image/film.h"
#include "convergence/replicas.h"

/* A picture, times `scale`: other than 1 where chains of several normalisations share a
 * film. */
struct film_sink {
    struct splat_sink sink;
    struct film *film;
    double scale;
};

struct film_sink film_sink_of(struct film *film, double scale);

/* Of failures (struct chain_sinks): at the current state's pixels r counts proposals that
 * failed and g all. r/g is the picture of 1 - Z [Zeng19]. */
struct failure_sink {
    struct splat_sink sink;
    struct film *film;
};

struct failure_sink failure_sink_of(struct film *film);

struct replica_sink {
    struct splat_sink sink;
    struct replica_lane *lane;
    const struct replica_share *shares; /* [count] */
    int count;
    double scale; /* of what a state adds, in the books, where all chains' are compared */
};

/* The shares' factors for states, or those for large steps. */
struct replica_sink replica_sink_of_states(struct replica_lane *lane,
                                           const struct replica_share *shares, int count,
                                           double scale);
struct replica_sink replica_sink_of_large(struct replica_lane *lane,
                                          const struct replica_share *shares, int count,
                                          double scale);

/* Luminance by tile, whatever the weight: of large steps, where no film shows them. */
struct tile_sink {
    struct splat_sink sink;
    double *sums;            /* [tiles] */
    const uint16_t *tile_of; /* [pixels] */
};

struct tile_sink tile_sink_of(double *sums, const uint16_t *tile_of);

/* All that one chain has. Not to be moved: `to`, which the chain sees, points to the
 * others. */
struct sink_set {
    struct chain_sinks to;
    struct film_sink film, large;
    struct failure_sink failures;
    struct replica_sink replica_states, replica_large;
    struct tile_sink tiles;
    struct replica_lane *replicas; /* NULL: none */
};

#endif
