#ifndef ETALON_INTEGRATOR_INTEGRATOR_H
#define ETALON_INTEGRATOR_INTEGRATOR_H

/* The interface of an integrator: it advances in rounds, whose length depends on the
 * clock with a time budget alone, and can give its picture and statistics between any two
 * of them. */

#include "base/pack.h"
#include "chain/plarge.h"
#include "convergence/verdict.h"
#include "image/layers.h"
#include "path/blind.h"
#include "path/dims.h"
#include "settings/settings.h"

#include <signal.h>

_Static_assert(SETTINGS_MAX_DEPTH <= DIMS_MAX_DEPTH, "paths have places for all depths");

/* One path length of a multiplexed run. */
struct length_statistics {
    int length, chains;
    bool found;     /* the bootstrap had a hit; else the chains started from nothing */
    double b, b_se; /* in the units of the scene file */
    double p_l;
    double failure_rate;
    struct statistics whole; /* of all mutations of this length */
};

/* Paths traced by chains, [Zeng19, section 6.1]. */
struct path_counters {
    double total, excluded, final_failures, accepted;
    double second_stage;       /* of them second proposals of step_pf_exact */
    double failures[FAILURES]; /* by cause, of both stages */
};

/* Figures of a run; those that an integrator does not have are NAN. b, b_se in the units
 * of the scene file (luminance, mean over the film). */
struct run_statistics {
    double paths; /* mutations, or samples of pt and bdpt */
    double bootstrap_paths;
    long chains; /* as many as there are: at least two for each length */
    /* b_se: pt, bdpt: from the spread between passes, row by row (pixels are strata, so
     * that differences between them do not count); INFINITY after a single pass. Chains:
     * from the spread of all independent paths, bootstrap and large steps. */
    double b, b_se;
    /* Chains: number of samples that b's error hangs on, (sum x^2)^2 / sum x^4 over what
     * each adds to b; twice that are the degrees of freedom of b_se. Where they are few
     * the distribution has a tail that this run may not have met: b is too dark more
     * often than not, and its error too small. */
    double b_samples, b_freedom;
    /* Chains: effective number of bootstrap paths that chains begin at, all lengths
     * together [Kong92]. */
    double seeds_effective;
    bool b_trusted; /* there are enough of those samples */
    bool seeds_few; /* standard errors of the statistics hang on few seeds */
    bool plarge_auto;
    bool
        plain_only; /* all light is of plain samples: longer bootstrap paths found none */
    int start_looks;         /* how often the start was looked at */
    struct statistics start; /* chains: the measured start, what the rule was given */
    struct statistics whole; /* chains: all mutations */
    struct plarge plarge;    /* chains: the rule's answer, or the manual p_l */
    double start_mutations;  /* chains: in the measured start */
    double seconds_startup;  /* wall */
    double acceptance;       /* accepted / proposed */
    double failure_rate;     /* zero proposals / proposed, before any was excluded */
    double excluded;         /* proposals redrawn and not counted as states */
    struct path_counters counters;
    double final_failure_rate, acceptance_rate; /* [Zeng19, section 6.1] */
    double second_acceptance; /* mean acceptance probability of second proposals */
    struct length_statistics lengths[DIMS_MAX_DEPTH];
    int length_count; /* 0 unless each length has chains of its own */
    /* Lengths 1..plain_lengths were computed by plain samples, one a pixel and pass. */
    int plain_lengths;
    double plain_samples, plain_b, plain_b_se;
    double most_rejections_in_row; /* mutations without a move, longest of any chain */
    double chains_never_moved;
    double nonfinite, saturated;
    double unsampled; /* by plain samples: share of pixels without a sample, which are
                         black */
};

/* What a run takes of memory at most, beside the scene; in bytes. */
struct run_memory {
    double films;    /* and the pictures of a run's parts */
    double rare;     /* part of it, in memory only where small splats fall */
    double states;   /* of chains and paths; seeds, tables */
    double extra;    /* part of it: bootstrap paths where the planned ones are too few */
    double pictures; /* that are made of the films, and the errors */
};

/* How much an integrator may still do: the clock for time budgets only. */
struct round_limits {
    double seconds_used; /* wall seconds of rendering so far, at */
    double begin;        /* clock_wall() */
    double until;        /* clock_wall() when the time budget ends; 0: there is none */
    const volatile sig_atomic_t *stop; /* NULL, or non-zero asks to end the round */
};

struct integrator_type;

/* How a kind of integrator works: one for chains (markov.h), one for independent samples
 * (passes.h). */
struct integrator_methods {
    bool chains; /* Markov chains: has a measured start, eta_s, eta_l, eta_0 and p_l */
    /* What create and advance will take at most; before any of it is taken. */
    void (*memory)(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out);
    /* Cheap but for what memory() says; the work is in advance(). */
    void *(*create)(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings);
    /* One round. False once a mutation budget is used up. */
    bool (*advance)(void *self, const struct round_limits *limits);
    /* Whether p_l stands (chains) or there is nothing to measure. */
    bool (*started)(const void *self);
    /* The picture so far, in the units of the scene file; sizes must agree. */
    void (*picture)(void *self, struct image *out);
    /* Adds what else it shows by pixel. */
    void (*layers)(void *self, struct layers *out);
    void (*statistics)(const void *self, struct run_statistics *out);
    /* Share of a mutation budget that is done. */
    double (*progress)(const void *self);
    /* The state between two rounds, to a checkpoint or, on one that was just created with
     * the same scene and settings, from it; the number of threads and the budget may be
     * others. pack_ok tells; after a failure it is good for destroy alone. */
    void (*pack)(void *self, struct pack *pack);
    /* What verdict.h judges by; valid until the next round. */
    void (*evidence)(void *self, struct evidence *out);
    void (*destroy)(void *self);
};

/* The head of a struct markov_integrator or passes_integrator, which says the rest. */
struct integrator_type {
    const char *name;
    const char *summary;
    const struct integrator_methods *methods;
    /* How it samples paths: a set of enum technique_kind (path/blind.h). */
    unsigned (*techniques)(const struct settings *settings);
};

#endif
