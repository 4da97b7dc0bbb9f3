#ifndef ETALON_INTEGRATOR_MARKOV_SINK_SET_H
#define ETALON_INTEGRATOR_MARKOV_SINK_SET_H

/* The sinks of a chain's splats (chain/splat_sink.h): one struct for each use. The
 * integrator fills them and passes them to the chain for a round. Member `sink` must be
 * first. */

#include "chain/splat_sink.h"
#include "image/film.h"
#include "convergence/replicas.h"

/* Adds to a film, times `scale`; not 1 where chains with different normalisations share a
 * film. */
struct film_sink {
    struct splat_sink sink;
    struct film *film;
    double scale;
};

struct film_sink film_sink_of(struct film *film, double scale);

/* The map of failures (struct chain_sinks): at the current state's pixels, r counts
 * failed proposals and g all proposals; r/g estimates the failure rate 1 - Z of
 * step_pf_paper.c. */
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
    double
        scale; /* scale of a state's brightness in the histogram, common to all chains */
};

/* Sinks with the shares' weights for states, or for large steps. */
struct replica_sink replica_sink_of_states(struct replica_lane *lane,
                                           const struct replica_share *shares, int count,
                                           double scale);
struct replica_sink replica_sink_of_large(struct replica_lane *lane,
                                          const struct replica_share *shares, int count,
                                          double scale);

/* Sums the luminance of large steps by tile, without their weight, for estimators without
 * a film of large steps. */
struct tile_sink {
    struct splat_sink sink;
    double *sums;            /* [tiles] */
    const uint16_t *tile_of; /* [pixels] */
};

struct tile_sink tile_sink_of(double *sums, const uint16_t *tile_of);

/* What a split leaves to independent samples (integrator/split.h): adds large proposals
 * to the sinks of large steps with the weight sample->rest times `weight`. */
struct rest_sink {
    struct splat_sink sink;
    double weight;
    const struct splat_sink *to[2]; /* the second may be NULL */
};

struct rest_sink rest_sink_of(double weight, const struct splat_sink *first,
                              const struct splat_sink *second);

/* All sinks of one chain. Must not be moved: `to`, which the chain sees, points to the
 * others. */
struct sink_set {
    struct chain_sinks to;
    struct film_sink film, large;
    struct failure_sink failures;
    struct replica_sink replica_states, replica_large;
    struct tile_sink tiles;
    struct rest_sink rest;
    struct replica_lane *replicas; /* NULL: none */
};

#endif
