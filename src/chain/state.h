#ifndef ETALON_CHAIN_STATE_H
#define ETALON_CHAIN_STATE_H

/* The state of a chain as the chain sees it: it proposes a successor with its
 * contribution, and then accepts or rejects it. Its type defines what it consists of
 * (numbers of primary sample space, vertices of a path, ...) and how it moves. */

#include "chain/tally.h"
#include "chain/target.h"
#include "math/rng.h"

#include <stddef.h>

struct pack;
struct state_type;

/* Work of a random event (a ray, or a connection that takes numbers) and of a connection
 * that takes none, many of which end before a ray. Chains and independent samples are
 * compared by it, so all count in this unit. On ten scenes a connection took .43 to .97
 * of the time of an event, .65 in the middle. */
#define WORK_EVENT      3
#define WORK_CONNECTION 2

/* The head of all states; set by chain_init. */
struct state {
    const struct state_type *type;
    struct rng
        *rng; /* the chain's generator; the chain draws from it between two calls */
    uint64_t seed, chain; /* the run's seed, and the number of the chain */
};

/* Facts about a proposal y from the current state x. */
struct proposal {
    int move; /* row of the type's table */
    /* ln q(y->x)/q(x->y), q the transition density of the move (its choice among local
     * moves included); 0 for symmetric moves. Densities are those with respect to the
     * law of large steps, of which the target is the contribution: so the large step's
     * own ratio is 0. In primary sample space that law is uniform. On paths it has a
     * density p; with q(x->y) per area the log ratio then is ln p(y)/p(x) besides. */
    double log_ratio;
};

/* Methods. Per mutation: propose, once or (MOVE_SECOND_STAGE) twice, then accept or
 * reject. None allocates, except init. */
struct state_type {
    const char *moves[MOVES_MOST]; /* names of the moves; NULL: no such move */
    size_t size;                   /* of the struct, which is zeroed first */
    /* init allocates what the struct points to, by options of the type; bytes is the
     * memory of that. NULL if there is nothing. */
    void (*init)(struct state *state, const void *options);
    void (*deinit)(struct state *state);
    double (*bytes)(const void *options);
    /* Called when *rng was set anew: drops numbers drawn in advance. NULL if there are
     * none. */
    void (*rng_changed)(struct state *state);
    /* Draws a successor and evaluates it into *out.
     * MOVE_LARGE: independent of the current state, which there need not be yet; numbers
     * are drawn from rng one by one in the order in which the target asks for them, as
     * the bootstrap does.
     * MOVE_LOCAL: by one of the local moves, which the state picks.
     * MOVE_SECOND_STAGE: after a proposal y1 of this mutation that carries nothing,
     * another, y2; log_ratio then has the densities of y1 from y2 and from x as well
     * [GreenMira01, with acceptance 0 of y1 from anywhere]. */
    struct proposal (*propose)(struct state *state, const struct target *target,
                               enum move move, struct contrib *out);
    void (*accept)(struct state *state); /* the last proposal becomes current */
    void (*reject)(struct state *state);
    /* Work of the last proposal, see WORK_EVENT: a whole number that depends on what was
     * traced alone, so that the sums over chains are the same on every machine. NULL: all
     * proposals cost the same. */
    double (*work)(const struct state *state, const struct contrib *proposed);
    bool tallies_work; /* the chain counts it by move */
    /* To or from a checkpoint (base/pack.h), between two mutations. */
    void (*pack)(struct pack *pack, struct state *state);
};

#endif
