#ifndef ETALON_INTEGRATOR_MARKOV_STATE_H
#define ETALON_INTEGRATOR_MARKOV_STATE_H

/* The inside of markov: only markov*.c include this. */

#include "chain/bootstrap.h"
#include "integrator/batches.h"
#include "integrator/markov.h"
#include "integrator/passes.h"
#include "integrator/sinks.h"
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
    struct batches batches;
    struct replica_share
        *shares; /* [chain_count][replicas], of the length's brightness */
    struct replica_share *weighed; /* the same in units of b0, for the round that runs */
    int *share_counts;             /* [chain_count] */
    bool whole; /* a length has chains in all of them: their sums are its brightness */
};

/* markov_missed.c: what large steps see and chains do not, if no film of large steps
 * makes up for it. */
struct markov_missed {
    int size, columns, rows, tiles; /* size: pixels each way */
    double *large;     /* [chain_count][tiles], see struct tile_sink; or NULL */
    double *met;       /* [tiles], with it: bootstrap paths with light there */
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
    bool dark;            /* the bootstrap found no light: there is nothing to run */
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
    bool late; /* not even one more mutation fits into the time budget */
    double seconds_startup;
    struct markov_replicas replicas;
    struct markov_missed missed;
    struct errors *errors; /* once evidence was asked for */
};

/* What each file gives the others. It uses those before it, and none after it;
 * markov.c, markov_pack.c, markov_result.c and markov_evidence.c give nothing but what is
 * in markov.h. */

/* --- markov_group.c: the chains of a group together -------------------------------- */

double markov_pixels(const struct markov *m);
/* Of all films; not concurrent with splats. */
void markov_fold(struct markov *m);
/* Sums over the chains of a group, and over all. */
struct tally group_tally(const struct markov *m, const struct group *group);
struct tally markov_tally(const struct markov *m);
/* b of a group from its independent paths, bootstrap and large steps, and the square of
 * its standard error; emission units. */
double group_brightness(const struct markov *m, const struct group *group,
                        double *variance);
/* Its parts: how much the bootstrap's mean counts, and the variance of one path. */
double group_bootstrap_weight(const struct markov *m, const struct group *group);
double group_spread(const struct markov *m, const struct group *group);
/* Adds the sum over samples of the squares of what each adds to b, and of their squares:
 * their ratio, (sum x^2)^2 / sum x^4, is the number of samples that the error hangs on.
 */
void group_moments(const struct markov *m, const struct group *group, double *squares,
                   double *fourths);
/* Counted states of the group's chains. A chain that has found no light yet has none:
 * counted, it would darken the picture. */
double markov_states(const struct markov *m, const struct group *group);
/* The group's chains, of tallies[chain_count] of all. */
struct statistics_part group_part(const struct markov *m, const struct group *group,
                                  const struct tally *tallies);
/* --- markov_allocate.c: how many chains each length gets --------------------------- */

/* Once its bootstrap is there. */
void markov_allocate(struct markov *m);
/* From the groups' chain counts which chains are whose. */
void markov_number_chains(struct markov *m);

/* --- markov_mixing.c: what p_l and shares bring  --------------------------------- */

/* all: tally of all chains; start[chain_count]: at the end of the start. */
struct statistics_mixing markov_mixing(const struct markov *m, const struct tally *all,
                                       const struct tally *start);
/* Adds what the numbers of chains bring; tallies[chain_count]. */
void markov_add_allocation(const struct markov *m, const struct tally *tallies,
                           struct statistics_mixing *mixing);
/* Statistics of all chains from a tally each, lengths weighted by their share of b. */
void markov_measure(const struct markov *m, const struct tally *tallies,
                    struct statistics *out);

/* --- markov_replica.c: chains in independent parts --------------------------------- */

/* How many there are, once made or if they were; 0: none. */
int markov_replicas_count(const struct markov *m);
/* Adds what they take. */
void markov_replicas_memory(const struct markov *m, struct run_memory *out);
/* Before the clock runs. */
void markov_replicas_create(struct markov *m);
/* Which chain is part of which, once the groups have theirs. */
void markov_replicas_share(struct markov *m);
void markov_replicas_destroy(struct markov *m);
/* Before a round: splats in units of b0, at the b of now. */
void markov_replicas_weigh(struct markov *m);
/* After a round: it is part of a batch. */
void markov_replicas_round(struct markov *m);
/* Which replica a chain is part of. */
int markov_replica_of(const struct markov *m, const struct group *group, int chain);
/* What makes the deviations of so few chains those of all replicas. */
double markov_replica_stretch(double replicas, double chains);

/* --- markov_films.c: films, shared or not ------------------------------------------ */

/* Adds what films will take. */
void markov_films_memory(const struct markov *m, struct run_memory *out);
/* All that there will be, before the clock runs: a GB takes a second or two. */
void markov_films_create(struct markov *m);
/* Which group gets which, once they have their brightness and their chains. */
void markov_films_assign(struct markov *m);
/* Before a round: what the splats of groups that share a film count for. */
void markov_weigh_shared(struct markov *m);
/* What the shared film is multiplied by for the picture, over b of all that share. */
double markov_shared_factor(const struct markov *m);

/* --- markov_errors.c: of the picture, from the replicas ---------------------------- */

/* Of the picture as it is, to be asked for by pixel through *out, until the next one. */
void markov_errors_find(struct markov *m, struct evidence *out);
void markov_errors_destroy(struct errors *e);
/* Luminance of the chain films' part of the picture. */
double markov_errors_value(const struct errors *e, long pixel);

/* --- markov_missed.c: light that chains miss --------------------------------------- */

/* Adds what it takes, where it is wanted. */
void markov_missed_memory(const struct markov *m, struct run_memory *out);
/* Once the chains are counted; nothing where it is not wanted. */
void markov_missed_create(struct markov *m);
/* While there are bootstrap paths. */
void markov_missed_meet(struct markov *m);
/* To or from a checkpoint. */
void markov_missed_pack(struct markov *m, struct pack *pack);
void markov_missed_destroy(struct markov *m);
/* Once the errors are found. */
void markov_missed_find(const struct markov *m, struct evidence *out);

/* --- markov_sinks.c: where a chain's splats go ------------------------------------- */

/* Of one chain on a thread, for a round. */
void markov_sinks_init(struct sink_set *sinks, const struct markov *m, int chain,
                       int thread);
/* When the chain has made its round. */
void markov_sinks_flush(const struct sink_set *sinks);

/* --- markov_round.c: every chain goes on ------------------------------------------- */

/* until: at most so many mutations a chain in all; 0: a full round. */
void markov_run_round(struct markov *m, long until, const struct round_limits *limits);
/* Plain samples of the lengths that need no chain, where there are some. */
void markov_run_passes(struct markov *m, const struct round_limits *limits);

/* --- markov_start.c: the measured start -------------------------------------------- */

void markov_start_plan(struct markov *m);
void markov_manual_plarge(struct markov *m);
/* One round; decides p_l at the start's end. */
void markov_start_round(struct markov *m, const struct round_limits *limits);

/* --- markov_bootstrap.c: independent paths ----------------------------------------- */

/* Of every length, more where they are few. Mutations are budgeted: the same for any
 * clock. */
void markov_run_bootstrap(struct markov *m, const struct round_limits *limits);
/* The most paths that there may be. */
double markov_bootstrap_most(const struct markov *m);
/* Effective number of seeds of all lengths together, 0 without light. */
double markov_effective_seeds(const struct markov *m);
/* The number of a length's path i in the streams of random numbers. */
uint64_t markov_path_number(const struct markov *m, int group, long i);

/* --- markov_seed.c: where chains begin --------------------------------------------- */

/* Independent paths of every length, chains for each, and all that chains need. */
void markov_begin(struct markov *m, const struct round_limits *limits);
/* What groups of known brightness and chains need: films, parameters, replicas. */
void markov_equip(struct markov *m);

#endif
