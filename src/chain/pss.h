#ifndef ETALON_CHAIN_PSS_H
#define ETALON_CHAIN_PSS_H

/* The lazy primary-sample state, one type of state: three streams of numbers, each number
 * brought up to date only when it is asked for (DESIGN section 2). `current` is the state
 * of the chain, `proposed` what this mutation drew from it. A number that was last
 * touched before the last accepted large step is redrawn; one that missed accepted small
 * steps catches up. The catch-up belongs to the current state and survives rejection.
 *
 * Small and second-stage steps differ in width, so what was missed is told by a clock of
 * variance: a second-stage step advances it by 1, a small one by kernel.second_stage^2.
 */

#include "chain/kernel.h"
#include "chain/state.h"

enum pss_stream_id { PSS_CAMERA, PSS_LIGHT, PSS_CONNECT, PSS_STREAMS };

/* Moves: MOVE_LARGE, MOVE_SECOND_STAGE (kernels with a density) and this. */
#define MOVE_SMALL MOVE_LOCAL

struct pss;

/* One event's numbers: places [place, place+count). */
struct pss_block {
    uint16_t place, count;
};

struct pss_stream {
    struct ustream stream; /* must be first */
    struct pss *owner;
    int capacity; /* places; more ends the process with a message */
    double *current, *proposed;
    int64_t *stamp;            /* clock that current[i] is up to; -1: never drawn */
    struct pss_block *touched; /* what this mutation asked for */
    int touched_count;
    /* Of a small step that failed, while a second one is tried. */
    double *first_stage;
    struct pss_block *first_stage_touched;
    int first_stage_count;
};

struct pss {
    struct state state; /* must be first */
    struct pss_stream streams[PSS_STREAMS];
    struct kernel kernel;
    int64_t clock;      /* variance of all accepted steps */
    int64_t last_large; /* the clock just after the last accepted large step */
    bool large;         /* this mutation is a large step */
    int64_t variance;   /* by which accepting it advances the clock */
    double width;       /* displacements of this mutation, as multiples of small ones */
    /* Drawn ahead from rng, many at a time. */
    int displacements_left, uniforms_left;
    double displacements[KERNEL_BATCH], uniforms[KERNEL_BATCH];
};

struct pss_options {
    int capacity[PSS_STREAMS]; /* places */
    struct kernel kernel;
};

/* Its options: struct pss_options. A state of this type is a struct pss. */
extern const struct state_type state_pss;

/* What the moves are made of, for other types that have a struct pss within. */

/* Not to be moved afterwards: the streams point to their owner. rng is kept, and may be
 * used by others between two calls. */
void pss_init(struct pss *pss, const int capacity[PSS_STREAMS],
              const struct kernel *kernel, struct rng *rng);
void pss_deinit(struct pss *pss);
/* What one takes beside the struct. */
double pss_bytes(const int capacity[PSS_STREAMS]);
/* Every number becomes undrawn. */
void pss_reset(struct pss *pss);
/* To be called after *rng was set anew: what was drawn ahead belongs to its past. */
void pss_drop_batches(struct pss *pss);
/* Each place may be asked for once in a mutation, in any order; the numbers stay valid
 * until the next pss_begin. */
struct numbers pss_numbers(struct pss *pss);

void pss_begin(struct pss *pss, bool large);
/* Instead of rejecting the proposal y1: another, narrower one from the same current
 * state. y1, unless it was a large step, is kept until the next pss_begin. */
void pss_begin_second_stage(struct pss *pss);
/* After y2 of the second stage was evaluated: log of q1(y1|y2)/q1(y1|x), x the current
 * state, over the numbers that y1 was asked for until it failed; those that y2 was not
 * are drawn for it now. Which numbers these are depends on y1 alone, so leaving out the
 * others, on which nothing depends, leaves the balance as it is. q1 is the density of one
 * small step; 0 after a large one, which comes from everywhere alike. */
double pss_second_stage_log_ratio(struct pss *pss);
void pss_accept(struct pss *pss);
/* To or from a checkpoint (base/pack.h), between two mutations: all numbers with the
 * times that they are up to, and what was drawn ahead. */
void pss_pack(struct pack *pack, struct pss *pss);
/* Forgets the proposal. Starting the next mutation does too. */
void pss_reject(struct pss *pss);

#endif
