#ifndef ETALON_CHAIN_PSS_H
#define ETALON_CHAIN_PSS_H

/* The lazy primary-sample state: three streams of numbers, each number brought up to date
 * only when it is asked for (DESIGN section 2). `current` is the state of the chain,
 * `proposed` what this mutation drew from it. A number that was last touched before the
 * last accepted large step is redrawn; one that missed accepted small steps catches up.
 * The catch-up belongs to the current state and survives rejection. */

#include "chain/kernel.h"
#include "math/ustream.h"

enum pss_stream_id { PSS_CAMERA, PSS_LIGHT, PSS_CONNECT, PSS_STREAMS };

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
    int64_t *stamp; /* accepted steps that current[i] has seen; -1: never drawn */
    struct pss_block *touched; /* what this mutation asked for */
    int touched_count;
};

struct pss {
    struct pss_stream streams[PSS_STREAMS];
    struct kernel kernel;
    struct rng *rng;    /* the chain's */
    int64_t accepted;   /* accepted steps so far */
    int64_t last_large; /* `accepted` just after the last accepted large step */
    bool large;         /* this mutation is a large step */
    /* Drawn ahead from rng, many at a time. */
    int displacements_left, uniforms_left;
    double displacements[KERNEL_BATCH], uniforms[KERNEL_BATCH];
};

/* Not to be moved afterwards: the streams point to their owner. rng is kept, and may be
 * used by others between two calls. */
void pss_init(struct pss *pss, const int capacity[PSS_STREAMS],
              const struct kernel *kernel, struct rng *rng);
void pss_deinit(struct pss *pss);
/* Every number becomes undrawn. */
void pss_reset(struct pss *pss);
/* To be called after *rng was set anew: what was drawn ahead belongs to its past. */
void pss_drop_batches(struct pss *pss);
/* Each place may be asked for once in a mutation, in any order; the numbers stay valid
 * until the next pss_begin. */
struct numbers pss_numbers(struct pss *pss);

void pss_begin(struct pss *pss, bool large);
void pss_accept(struct pss *pss);
/* Forgets the proposal. Starting the next mutation does too. */
void pss_reject(struct pss *pss);

#endif
