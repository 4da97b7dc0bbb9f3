#ifndef ETALON_INTEGRATOR_INTEGRATOR_H
#define ETALON_INTEGRATOR_INTEGRATOR_H

/* The interface of an integrator. It advances in rounds and can give its picture and
 * statistics between any two of them. The length of a round depends on the clock only
 * under a time budget. */

#include "base/pack.h"
#include "convergence/fixed_picture.h"
#include "chain/tally.h"
#include "chain/tours_choose.h"
#include "convergence/verdict.h"
#include "image/layers.h"
#include "path/blind.h"
#include "path/dims.h"
#include "settings/settings.h"

#include <signal.h>

_Static_assert(SETTINGS_MAX_DEPTH <= DIMS_MAX_DEPTH, "paths have places for all depths");

/* Figures of one path length, for integrators whose chains each have one length. */
struct length_statistics {
    int length, chains;
    bool found; /* the bootstrap found light; else the chains started without a state */
    double b, b_se; /* in the units of the scene file */
    double p_l;
    double failure_rate;
    struct statistics whole; /* of all mutations of this length */
};

/* Figures of one kind of proposal, over all chains and the whole run. */
struct move_statistics {
    const char *name;
    double proposed, accepted;
    double acceptance; /* mean acceptance probability */
    double work;       /* mean cost (state_type.work); 0 unless it is tallied */
    double weight;     /* of a mutation of paths in the choice, at the end; 0 of others */
    double failures[FAILURES]; /* proposals without a contribution, by cause */
};

/* Paths traced by chains, [Zeng19, section 6.1]. */
struct path_counters {
    double total, excluded, final_failures, accepted;
    double second_stage;       /* of `total`: second proposals of step_pf_exact */
    double failures[FAILURES]; /* by cause, of both stages */
};

/* How chains and independent samples share the light (integrator/split.h); NAN where a
 * run has no split, or where nothing was predicted. */
struct split_figures {
    bool used;             /* some of the figures below */
    double floor, ceiling; /* c and W; INFINITY: no chain, no ceiling */
    double passes;         /* share of passes in all paths */
    double large;          /* share of the rest that large steps estimate, mean */
    double b, b_se;        /* mean target of the chains, b_T, in units of the mean */
    double samples;        /* independent samples of the guess */
    /* Predictions at the decision: relMSE at the end; errors of independent samples alone
     * and of chains alone, in units of that of the mix at equal cost. */
    double relmse, passes_alone, chains_alone;
    char reason[320];
};

extern const struct split_figures split_figures_none;

/* The choice of an integrator (integrator/race.h). */
struct race_figures {
    bool used;
    char chosen[16]; /* name in the registry; "" before the choice */
    double paths;    /* of all pilots */
    /* Paths of the chosen integrator that have as much work: what the pilots take of a
     * budget of paths. */
    double equal_paths;
    bool chains;   /* it has chains, or may have: before the choice */
    double relmse; /* predicted at the end of the run; NAN: no race was run */
    char reason[320];
};

extern const struct race_figures race_figures_none;

/* Adaptive film sampling of pt and bdpt (integrator/sample_map.h); NAN without. */
struct adaptive_figures {
    double start;     /* samples a pixel in the measured start */
    double predicted; /* relMSE times work by that start, over that of uniform samples */
};

extern const struct adaptive_figures adaptive_figures_none;

/* Figures of a run; those that an integrator does not have are NAN. b, b_se in the units
 * of the scene file (luminance, mean over the film). */
struct run_statistics {
    double paths; /* mutations, or samples of pt and bdpt */
    double bootstrap_paths;
    long chains; /* number of chains, at least two for each length */
    /* b_se of pt and bdpt comes from the variance between passes of each row (pixels are
     * strata, so differences between them do not count); INFINITY after a single pass.
     * That of chains comes from the variance of all independent paths, bootstrap and
     * large steps. */
    double b, b_se;
    /* Chains: effective number of samples that determine the error of b, (sum x^2)^2 /
     * sum x^4 over the contributions x to b; twice this is the degrees of freedom of b_se
     * [Satterthwaite46]. If it is small, the distribution has a heavy tail that this run
     * may not have sampled: then b is usually too dark and its error too small. */
    double b_samples, b_freedom;
    /* Chains: effective number of distinct bootstrap paths at which chains start, over
     * all lengths [Kong92]. */
    double seeds_effective;
    bool b_trusted; /* b_samples is large enough to trust b_se */
    bool seeds_few; /* seeds_effective is too small to trust standard errors */
    bool plarge_auto;
    bool plain_only; /* all light is from plain samples, longer paths found none */
    int start_looks; /* how often the rule was applied to the measured start */
    struct statistics start;   /* chains: of the measured start, the input of the rule */
    struct statistics whole;   /* chains: all mutations */
    struct plarge plarge;      /* chains: the rule's answer, or the manual p_l */
    double p_l_zsolnai2013;    /* chains: p_l by the published rule, NAN before its end */
    struct tours_choice tours; /* chains: the rule tours, where it was applied */
    double start_mutations;    /* chains: mutations in the measured start */
    double seconds_startup;    /* wall */
    double acceptance;         /* accepted / proposed */
    double failure_rate;       /* zero proposals / proposed, before any was excluded */
    double excluded;           /* proposals redrawn and not counted as states */
    struct path_counters counters;
    struct move_statistics
        moves[MOVES_MOST]; /* chains: in the order of the state's table */
    int move_count;
    double final_failure_rate, acceptance_rate; /* [Zeng19, section 6.1] */
    double second_acceptance;      /* mean acceptance probability of second proposals */
    double jumps, jump_acceptance; /* technique changes, and the same of them */
    struct length_statistics lengths[DIMS_MAX_DEPTH];
    int length_count; /* 0 unless each length has chains of its own */
    /* Lengths 1..plain_lengths were computed by plain samples, one a pixel and pass. */
    int plain_lengths;
    double plain_samples, plain_b, plain_b_se;
    double most_rejections_in_row; /* of any chain */
    double chains_never_moved;
    double nonfinite, saturated;
    double edges_cut; /* path/passage.h; set by run */
    struct split_figures split;
    struct race_figures race;
    struct adaptive_figures adaptive;
    double unsampled; /* share of pixels without a plain sample, which are black */
};

/* Upper bounds of the memory that a run takes besides the scene, in bytes. */
struct run_memory {
    double films;  /* films and replicas */
    double rare;   /* part of `films` that is resident only where small splats fall */
    double states; /* chains, paths, seeds, tables */
    /* Part of `states` that most runs do not take: additional bootstrap paths where the
     * planned ones are too few, splats of samples that have all of them, tapes up to
     * their ends, pixels of tours that are as long as a tape. */
    double extra;
    double pictures; /* pictures made from the films, and error bars */
};

/* What a line of progress says: figures that cost no look at pixels. */
struct run_counts {
    double paths;
    double acceptance, p_large; /* of chains, else NAN */
};

/* When a round has to end. The clock counts for time budgets only. */
struct round_limits {
    double seconds_used; /* wall seconds of rendering before `begin` */
    double begin;        /* clock_wall() */
    double until;        /* clock_wall() when the time budget ends; 0: there is none */
    const volatile sig_atomic_t *stop; /* NULL, or non-zero asks to end the round */
};

struct integrator_type;

/* The methods of an integrator. There are two sets: for Markov chains (markov.h) and for
 * independent samples (passes.h). */
struct integrator_methods {
    bool chains; /* Markov chains: has a measured start, eta_s, eta_l, eta_0 and p_l */
    /* Predicts the memory that create and advance take at most; allocates nothing. */
    void (*memory)(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out);
    /* Allocates; all work is done in advance(). The whole run is computed unless set_part
     * follows. */
    void *(*create)(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings);
    /* Computes a part of the run only: its share of the chains once the measured start,
     * which every part repeats, is over; of passes at once, unless they measure one.
     * Before any advance(), and either before pack() reads the state of that part or
     * after it has read that of a whole run. */
    void (*set_part)(void *self, struct run_part part);
    /* Runs one round. False once a mutation budget is used up. */
    bool (*advance)(void *self, const struct round_limits *limits);
    /* Whether the measured start is over: p_l is decided (chains), or the numbers of
     * samples by pixel; true at once for uniform samples. */
    bool (*started)(const void *self);
    /* The picture so far, in the units of the scene file; the sizes must agree. */
    void (*picture)(void *self, struct image *out);
    /* A picture with fixed weights (fixed_picture.h); valid until the next round. */
    void (*fixed_picture)(void *self, struct fixed_picture *out);
    /* Adds further layers by pixel, for example the map of failures. */
    void (*layers)(void *self, struct layers *out);
    void (*statistics)(const void *self, struct run_statistics *out);
    void (*counts)(const void *self, struct run_counts *out);
    /* Share of a mutation budget that is used up. */
    double (*progress)(const void *self);
    /* Writes the state between two rounds to a checkpoint, or reads it into an integrator
     * that was just created with the same scene and settings; the number of threads and
     * the budget may differ. See pack_ok for failure; after a failed read only destroy is
     * allowed. */
    void (*pack)(void *self, struct pack *pack);
    /* After the states of all parts at hand were read by pack(), each added to those
     * before (pack_set_part): makes the run whole. present[count]: the parts at hand. The
     * picture is that of what these computed. */
    void (*complete)(void *self, const bool *present, int count);
    /* The evidence for verdict.h; valid until the next round. */
    void (*evidence)(void *self, struct evidence *out);
    void (*destroy)(void *self);
};

/* First member of struct markov_integrator and struct passes_integrator. */
struct integrator_type {
    const char *name;
    const char *summary;
    const struct integrator_methods *methods;
    /* Its techniques: a set of enum technique_kind (path/blind.h). */
    unsigned (*techniques)(const struct settings *settings);
};

#endif
