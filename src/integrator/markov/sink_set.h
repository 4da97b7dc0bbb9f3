#ifndef ETALON_INTEGRATOR_MARKOV_SINK_SET_H
#define ETALON_INTEGRATOR_MARKOV_SINK_SET_H

/* The sinks of a chain's splats (chain/splat_sink.h): one struct for each use. The
 * integrator fills them and passes them to the chain for a round. Member `sink` must be
 * first. */

#include "chain/splat_sink.h"
#include "chain/tally.h"
#include "image/film.h"
#include "convergence/replicas.h"
#include "integrator/light_classes.h"

/* Adds to a film, times `scale`; not 1 where chains with different normalisations share a
 * film. */
struct film_sink {
    struct splat_sink sink;
    struct film *film;
    double scale;
};

struct film_sink film_sink_of(struct film *film, double scale);

/* Adds each splat to the film of its class, times `scale`; what is in no class is left
 * out. */
struct class_sink {
    struct splat_sink sink;
    const struct light_classes *classes;
    struct film *const *films; /* [classes->count] */
    double scale;
};

struct class_sink class_sink_of(const struct light_classes *classes,
                                struct film *const *films, double scale);

/* Maps of what a chain does, at the pixels of its current state.
 *   all           of first proposals: r counts failed ones and g all, so that r/g
 *                 estimates the failure rate 1 - Z of step_pf_paper.c; b is the work of
 *                 all proposals;
 *   small, large  of first proposals that are small or large steps (chain/tally.h): r
 *                 sums their acceptance probability, g counts them. */
struct map_sink {
    struct step_sink sink;
    struct film *all, *small, *large; /* or NULL; `small` and `large` go together */
};

struct map_sink map_sink_of(struct film *all, struct film *small, struct film *large,
                            bool counts_work);

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
#define REST_SINKS 3

struct rest_sink {
    struct splat_sink sink;
    double weight;
    const struct splat_sink *to[REST_SINKS]; /* or NULL */
};

struct rest_sink rest_sink_of(double weight, const struct splat_sink *film,
                              const struct splat_sink *replica,
                              const struct splat_sink *classes);

/* All sinks of one chain. Must not be moved: `to`, which the chain sees, points to the
 * others. */
struct sink_set {
    struct chain_sinks to;
    struct film_sink film, large;
    struct class_sink classes, large_classes;
    struct map_sink maps;
    struct replica_sink replica_states, replica_large;
    struct tile_sink tiles;
    struct rest_sink rest;
    struct replica_lane *replicas; /* NULL: none */
};

#endif
