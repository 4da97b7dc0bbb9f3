#ifndef ETALON_INTEGRATOR_MARKOV_STATE_H
#define ETALON_INTEGRATOR_MARKOV_STATE_H

/* The state of a run of chains. The functions on it are in the other files of this
 * folder; their includes have no cycles. */

#include "chain/bootstrap.h"
#include "convergence/missed_light.h"
#include "image/film.h"
#include "integrator/markov_design.h"
#include "integrator/passes.h"
#include "math/accum.h"

/* Chains that share a normalisation. With C of them, D mutations each, N pixels:
 *   plain:   picture = N b film / states, states: of the chains (C D unless some of the
 *            proposals are excluded);
 *   kelemen: picture = N / (C D) (b film + b0 large).
 * The large films of all groups are one, in units of the whole b0 and C (large_scale);
 * for groups that share a film see markov_films.c. */
struct group {
    int length;                 /* edges; 0: all */
    struct bootstrap bootstrap; /* of this length */
    /* Mean and variance of the planned paths' targets, and the sum of their fourth
     * powers, without the paths that were added for their seeds (markov_bootstrap.c). */
    struct welford independent;
    double independent_fourths;
    int first_chain, chain_count;
    struct film *film; /* chain splats */
    bool shares;       /* `film` is shared by several groups */
    struct chain_params params;
    double states_scale, large_scale; /* scales of splats on `film` and on markov.large */
    struct plarge plarge;
};

/* The standard errors of a length come from the differences between its chains. */
#define MARKOV_CHAINS_LEAST 2

/* Parts of the bootstrap for the jackknife. */
#define JACKKNIFE 8

/* markov_replica.c: small pictures of independent parts of the chains. */
struct markov_replicas {
    struct replicas *films; /* NULL: no replicas, and the rest is empty */
    struct time_spans spans;
    struct replica_share
        *shares; /* [chain_count][replicas], of the length's brightness */
    struct replica_share
        *weighted_shares; /* the same in units of b0, for the current round */
    int *share_counts;    /* [chain_count] */
    /* Every length has chains in all replicas, so their sums are its brightness. */
    bool whole;
};

/* markov_missed.c: sums of large steps by tile, for estimators without a film of large
 * steps. */
struct markov_missed {
    struct missed_grid grid;
    double *large;     /* [chain_count][tiles], see struct tile_sink; or NULL */
    double *path_hits; /* [tiles], with `large`: bootstrap paths with light there */
    uint16_t *tile_of; /* [pixels], with `large` */
};

enum phase { PHASE_BOOTSTRAP, PHASE_START, PHASE_MAIN };

struct markov {
    const struct scene *scene;
    const struct settings *settings;
    struct markov_design design;
    int threads, chain_count, group_count;
    int lengths[DIMS_MAX_DEPTH]; /* [group_count] */
    struct target *targets;      /* [group_count][threads] */
    struct chain *chains;        /* [chain_count], group by group */
    int *group_of;               /* [chain_count] */
    int64_t *seeds; /* [chain_count], number of the bootstrap path at which it started */
    struct group *groups;
    struct film *large, *failures; /* NULL if there is none */
    struct film *shared;           /* chain splats of groups that share, or NULL */
    struct film *films[DIMS_MAX_DEPTH + 3]; /* [film_count], all of them, owned */
    int film_count;
    double b0;         /* sum over groups */
    int shared_chains; /* chains of the groups that share a film */
    /* Sum over rounds of a chain's mutations times the b of the groups that share, see
     * markov_films.c. */
    double shared_light;
    struct passes *direct; /* plain samples of the lengths that need no chain, or NULL */
    enum phase phase;
    bool no_light;   /* the bootstrap found no light: no chain runs */
    long bootstrap;  /* planned paths of each length */
    long round;      /* mutations a chain in a full round */
    double pace;     /* seconds that one mutation of every chain took in the last round */
    long this_round; /* mutations a chain in the current round */
    double budget;   /* paths of all chains, 0 if the clock decides */
    long done;       /* mutations a chain so far */
    double paths;    /* of all chains and passes so far */
    long start_until;     /* end of the measured start, in mutations a chain */
    double start_until_s; /* and in seconds, under a time budget */
    /* Share of the chains of each length without one part of the bootstrap, and the mean
     * of its paths. */
    double shares_without[JACKKNIFE][DIMS_MAX_DEPTH];
    double means_without[JACKKNIFE][DIMS_MAX_DEPTH]; /* of the paths kept */
    int looks;
    struct tally *start_tallies; /* [chain_count], at the end of the start */
    struct statistics start;     /* statistics of these, the input of the rule */
    struct plarge plarge;
    bool
        out_of_time; /* the time left is too short for one more mutation of every chain */
    double seconds_startup;
    struct markov_replicas replicas;
    struct markov_missed missed;
    struct errors *errors; /* made by markov_errors_find */
};

#endif
