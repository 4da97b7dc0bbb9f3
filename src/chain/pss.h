#ifndef ETALON_CHAIN_PSS_H
#define ETALON_CHAIN_PSS_H

/* The lazy primary-sample state, one type of state: three streams of numbers, each number
 * brought up to date only when it is asked for. `current` is the state
 * of the chain, `proposed` what this mutation drew from it. A number that was last
 * touched before the last accepted large step is redrawn; one that missed accepted small
 * steps catches up. The catch-up belongs to the current state and survives rejection.
 *
 * Small and second-stage steps differ in width, so missed steps are measured by their
 * variance: the clock advances by 1 for a second-stage step and by kernel.second_stage^2
 * for a small one. */

#include "chain/kernel.h"
#include "chain/state.h"
#include "math/found_numbers.h"

enum pss_stream_id { PSS_CAMERA, PSS_LIGHT, PSS_CONNECT, PSS_STREAMS };

/* Moves: MOVE_LARGE, MOVE_SECOND_STAGE (kernels with a density) and this. */
#define MOVE_SMALL MOVE_LOCAL

struct pss;

/* The numbers of one random event: places [place, place+count). */
struct pss_block {
    uint16_t place, count;
};

struct pss_stream {
    struct ustream stream; /* must be first */
    struct pss *owner;
    int capacity; /* places; asking for more ends the process with a message */
    double *current, *proposed;
    int64_t *stamp; /* clock up to which current[i] is caught up; -1: never drawn */
    struct pss_block *touched; /* blocks that this mutation asked for */
    int touched_count;
    /* Numbers of a failed small step, during the second stage. */
    double *first_stage;
    struct pss_block *first_stage_touched;
    int first_stage_count;
};

struct pss {
    struct state state; /* must be first */
    struct pss_stream streams[PSS_STREAMS];
    struct kernel kernel;
    int64_t clock;      /* variance of all accepted steps */
    int64_t last_large; /* clock just after the last accepted large step */
    bool large;         /* this mutation is a large step */
    int64_t variance;   /* advance of the clock on acceptance */
    double width; /* width of this mutation's displacements relative to small steps */
    /* Numbers drawn in advance from rng, in batches. */
    int displacements_left, uniforms_left;
    double displacements[KERNEL_BATCH], uniforms[KERNEL_BATCH];
};

/* Other numbers with the same contribution, for chain/pss_jump.h; ctx: of the target.
 * Drawn so that the density f(u) is kept: if u has it, so have they. Evaluates `current`
 * again, into *again. The values of *found are below 0 before. */
typedef enum inversion (*pss_invert)(void *ctx, const struct numbers *current,
                                     struct rng *rng, struct found *found,
                                     struct contrib *again);

struct pss_options {
    int capacity[PSS_STREAMS]; /* places */
    struct kernel kernel;
    double jump; /* chain/pss_jump.h: share of jumps among local moves, and */
    pss_invert invert;
    /* NULL, or: whether samples of this target have other numbers at all; else no jumps
     * are proposed. */
    bool (*invertible)(void *ctx);
};

/* State type of primary sample space. Its options are struct pss_options; a state of this
 * type is a struct pss. */
extern const struct state_type state_pss;

/* The parts of moves, for other state types that contain a struct pss. */

/* Must not be moved afterwards, as the streams point to it. Keeps a pointer to rng, which
 * others may use between two calls. */
void pss_init(struct pss *pss, const int capacity[PSS_STREAMS],
              const struct kernel *kernel, struct rng *rng);
void pss_deinit(struct pss *pss);
/* Memory besides the struct. */
double pss_bytes(const int capacity[PSS_STREAMS]);
/* Marks every number as never drawn. */
void pss_reset(struct pss *pss);
/* Called after *rng was set anew: drops the numbers that were drawn in advance. */
void pss_drop_batches(struct pss *pss);
/* The next uniform number, as large steps draw them. */
double pss_uniform(struct pss *pss);
/* Each place may be asked for once in a mutation, in any order; the numbers stay valid
 * until the next pss_begin. */
struct numbers pss_numbers(struct pss *pss);

void pss_begin(struct pss *pss, bool large);
/* Notes that the mutation asks for these places, and returns where their numbers go; ends
 * the process with a message where there are no such places. */
double *pss_touch(struct pss_stream *s, int place, int count);
/* Instead of rejecting the proposal y1: begins another, narrower one from the same
 * current state. y1 is kept until the next pss_begin unless it was a large step. */
void pss_begin_second_stage(struct pss *pss);
/* Log of q1(y1|y2)/q1(y1|x) after the evaluation of y2, where x is the current state, and
 * q1 the density of one small step, over the numbers that y1 asked for until it failed.
 * Numbers that y2 did not ask for are drawn for it now. The set of these numbers depends
 * on y1 alone, and nothing depends on the others, so detailed balance holds without them
 * [GreenMira01]. 0 after a large step, whose density is the same from everywhere. */
double pss_second_stage_log_ratio(struct pss *pss);
void pss_accept(struct pss *pss);
/* To or from a checkpoint (base/pack.h), between two mutations: all numbers with their
 * clocks, and the numbers drawn in advance. */
void pss_pack(struct pack *pack, struct pss *pss);
/* Drops the proposal. Starting the next mutation does so too. */
void pss_reject(struct pss *pss);

#endif
