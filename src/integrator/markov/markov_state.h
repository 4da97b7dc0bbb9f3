#ifndef ETALON_INTEGRATOR_MARKOV_STATE_H
#define ETALON_INTEGRATOR_MARKOV_STATE_H

/* The state of a run of chains. What works on it stands in the other files of this
 * folder, each with a header of its own; none of them needs one that needs it. */

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
    /* Targets of the paths that were planned, and the sum of their fourth powers. Those
     * that were added because the first were few are not in it (markov_bootstrap.c). */
    struct welford independent;
    double independent_fourths;
    int first_chain, chain_count;
    struct film *film; /* chain splats */
    bool shares;       /* `film` is that of several groups */
    struct chain_params params;
    double states_scale, large_scale; /* of splats on `film`, and on markov.large */
    struct plarge plarge;
};

/* A length's chains are the units that its standard errors come from. */
#define MARKOV_CHAINS_LEAST 2

/* Parts of the bootstrap, each left out in turn. */
#define JACKKNIFE 8

/* markov_replica.c: independent parts of the chains, beside the films. */
struct markov_replicas {
    struct replicas *films; /* NULL: none, and nothing below */
    struct time_spans spans;
    struct replica_share
        *shares; /* [chain_count][replicas], of the length's brightness */
    struct replica_share
        *weighted_shares; /* the same in units of b0, for the round that runs */
    int *share_counts;    /* [chain_count] */
    bool whole; /* a length has chains in all of them: their sums are its brightness */
};

/* markov_missed.c: what large steps see and chains do not, if no film of large steps
 * makes up for it. */
struct markov_missed {
    struct missed_grid grid;
    double *large;     /* [chain_count][tiles], see struct tile_sink; or NULL */
    double *path_hits; /* [tiles], with it: bootstrap paths with light there */
    uint16_t *tile_of; /* [pixels], with it */
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
    int64_t *seeds; /* [chain_count], the bootstrap path of its length that it began at */
    struct group *groups;
    struct film *large, *failures; /* NULL if there is none */
    struct film *shared;           /* chain splats of groups that share, or NULL */
    struct film *films[DIMS_MAX_DEPTH + 3]; /* [film_count], all of them, owned */
    int film_count;
    double b0;           /* sum over groups */
    int shared_chains;   /* of the groups that share */
    double shared_light; /* mutations of a chain times their b, as their splats had it */
    struct passes *direct; /* plain samples of the lengths that need no chain, or NULL */
    enum phase phase;
    bool no_light;        /* the bootstrap found no light: there is nothing to run */
    long bootstrap;       /* planned paths of each length */
    long round;           /* mutations a chain in a full round */
    double pace;          /* seconds a mutation of all chains took in the last round */
    long this_round;      /* and in the one that runs */
    double budget;        /* paths of all chains, 0 if the clock decides */
    long done;            /* mutations a chain so far */
    double paths;         /* of all chains and passes so far */
    long start_until;     /* the measured start ends here, in mutations a chain */
    double start_until_s; /* and here, in seconds, if the clock decides */
    /* Shares of the chains that each length would get without a part of the bootstrap. */
    double shares_without[JACKKNIFE][DIMS_MAX_DEPTH];
    double means_without[JACKKNIFE][DIMS_MAX_DEPTH]; /* and its paths' mean */
    int looks;
    struct tally *start_tallies; /* [chain_count], at the end of the start */
    struct statistics start;     /* of them, when p_l was decided */
    struct plarge plarge;
    bool out_of_time; /* not even one more mutation fits into the time budget */
    double seconds_startup;
    struct markov_replicas replicas;
    struct markov_missed missed;
    struct errors *errors; /* once evidence was asked for */
};

#endif
