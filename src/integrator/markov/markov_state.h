#ifndef ETALON_INTEGRATOR_MARKOV_STATE_H
#define ETALON_INTEGRATOR_MARKOV_STATE_H

/* The state of a run of chains. The functions on it are in the other files of this
 * folder; their includes have no cycles. */

#include "chain/bootstrap.h"
#include "chain/tours_choose.h"
#include "convergence/missed_light.h"
#include "image/film.h"
#include "integrator/light_classes.h"
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
    double states_scale, large_scale; /* scales of splats on `film` and on films.large */
    /* b by which films shared by lengths, and replicas, weigh this one: of the bootstrap,
     * and from the end of the start on of all independent paths until then. Every part of
     * a run knows these two. Above 0. */
    double fixed_b;
    double fixed_light; /* sum over rounds of a chain's mutations times fixed_b */
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

/* markov_films.c: films of chain splats, of large steps and of failures. */
struct markov_films {
    /* [count], owned */
    struct film *all[DIMS_MAX_DEPTH + 5 + 2 * LIGHT_CLASSES_MOST];
    int count;
    struct film *large; /* of them; NULL if there is none */
    /* Layers, of them: maps of steps (struct map_sink), and chain splats and large steps
     * by class of light, [light.count]; NULL if there are none. */
    struct film *steps, *small_steps, *large_steps;
    struct film *class_states[LIGHT_CLASSES_MOST], *class_large[LIGHT_CLASSES_MOST];
    struct light_classes light;
    struct film *shared; /* chain splats of groups that share, or NULL */
    int shared_chains;   /* chains of the groups that share a film */
};

/* markov_round.c: how long rounds are. */
struct markov_rounds {
    long full;        /* mutations a chain in a full round */
    long current;     /* and in the one that runs */
    double pace;      /* seconds that one mutation of every chain took in the last one */
    bool out_of_time; /* what is left is too short for one more mutation of every chain */
    /* The end of the start: paths of all chains and mutations of each until then; and the
     * paths of a mutation from then on, as the start predicts them. */
    double start_paths, paths_each;
    long start_done;
};

/* markov_start.c: the measured start. */
struct markov_start {
    long until;                   /* its end, in mutations a chain */
    double until_s;               /* and in seconds of the run, under a time budget */
    double cap_s;                 /* its latest end, in seconds of the run */
    int looks;                    /* how often the rule was asked */
    struct tally *tallies;        /* [chain_count], at its end */
    struct statistics statistics; /* of these, the input of the rule */
    double p_zsolnai;             /* p_l by the published rule, NAN before the end */
    struct tours_choice tours;    /* p_l by the rule `tours`, if that is the rule */
    double seconds;               /* wall, bootstrap included */
};

/* markov_allocate.c: shares of the chains and means of the paths of each length, without
 * one part of the bootstrap. */
struct markov_jackknife {
    double shares[JACKKNIFE][DIMS_MAX_DEPTH];
    double means[JACKKNIFE][DIMS_MAX_DEPTH];
};

/* markov_tours.c: the input of the rule `tours`. */
struct markov_tours {
    struct tape *tapes;                  /* [chain_count] */
    struct large_acceptance *acceptance; /* [group_count] */
};

/* split_plan.c: the choice of a split. */
struct split_plan {
    double floor, ceiling; /* INFINITY: passes alone; no ceiling */
    double passes;         /* share of passes in all paths */
    double p_large;        /* p_l that the chains are expected to get */
    /* Predicted: relMSE at the end; error of passes alone and of chains alone in units of
     * the chosen one's, at equal cost. NAN: not predicted. */
    double relmse, passes_alone, chains_alone;
    char reason[320];
};

/* markov_split.c: chains take a share of the light. */
struct markov_split {
    struct split split;
    struct split_plan plan;
    struct pilot *pilot; /* until the chains begin */
    double samples;      /* of the pilot */
    double seconds;      /* that these took, wall */
    /* [group_count]: sums of ((1-s) rho)^2 over the planned bootstrap paths. */
    double rest_squares[DIMS_MAX_DEPTH];
};

struct markov {
    struct run_part part; /* what is computed after the start */
    int parts_read;       /* number of parts that were read and added up */
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
    /* Independent samples of the lengths that need no chain, or of what a split leaves to
     * them; or NULL. Their share of all paths. */
    struct passes *direct;
    double passes_share;
    struct markov_split *split; /* or NULL */
    enum phase phase;
    bool no_light;  /* the bootstrap found no light for chains: no chain runs */
    long bootstrap; /* planned paths of each length */
    double b0;      /* sum over groups */
    double budget;  /* paths of all chains, 0 if the clock decides */
    /* Paths of all chains and passes so far, by which the budget is kept: predicted,
     * where only some mutations make a second path. */
    double paths;
    long done; /* mutations a chain so far */
    struct plarge plarge;
    struct markov_films films;
    struct markov_rounds rounds;
    struct markov_start start;
    struct markov_jackknife jackknife;
    struct markov_replicas replicas;
    struct markov_missed missed;
    struct markov_tours *tours; /* markov_tours.c, during the start; or NULL */
    /* [chain_count], chains of parts that are not at hand; NULL: all are, and made the
     * same number of mutations. */
    bool *missing;
    bool start_missing;    /* the splats of the start are not at hand */
    struct errors *errors; /* made by markov_errors_find */
};

#endif
