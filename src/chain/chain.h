#ifndef ETALON_CHAIN_CHAIN_H
#define ETALON_CHAIN_CHAIN_H

/* One Markov chain on a target: its state, the contributions of the current and of the
 * proposed state, expected-value splats, tally. A state_type defines the state and its
 * moves; a step_type defines how proposals are accepted; splat_weight (estimator.h) is
 * the weight of a splat, used on acceptance, on rejection and in the final flush. */

#include "base/mem.h"
#include "chain/estimator.h"
#include "chain/splat_sink.h"
#include "chain/state.h"

struct chain {
    _Alignas(
        MEM_APART) struct rng rng; /* separate cache lines for chains of other threads */
    struct state *state;
    struct contrib contribs[2];
    struct contrib *current, *proposed;
    /* Weight of `current` that is not splatted yet: its own a, then 1-a for each
     * rejection. */
    double pending_weight;
    bool large; /* this mutation is a large step */
    struct tally tally;
    int64_t rejections_in_row, most_rejections_in_row; /* since chain_seed */
};

/* options: of the state's type. The chain must not be moved afterwards, as the state
 * points to its rng. */
void chain_init(struct chain *chain, const struct state_type *type, const void *options,
                int max_splats);
void chain_deinit(struct chain *chain);
/* Memory of one chain beside its struct. */
double chain_bytes(const struct state_type *type, const void *options, int max_splats);

/* Starts at bootstrap path `index` of `seed`, which it replays; then switches to the
 * chain's own stream (RNG_CHAIN, id). The path may have no contribution: then the first
 * non-zero proposal is accepted. Clears the tally. */
void chain_seed(struct chain *chain, const struct target *target, uint64_t seed,
                uint64_t bootstrap_index, uint64_t id);

/* Splats the pending weight of `current`. Called at the end of every round and phase,
 * with the parameters of the mutations since the last flush. */
void chain_flush(struct chain *chain, const struct chain_params *params,
                 const struct chain_sinks *sinks);

/* To or from a checkpoint (base/pack.h). Must be flushed before; is read into a chain
 * that was created in the same way. pixels: of the film. */
void chain_pack(struct pack *pack, struct chain *chain, long pixels);

struct step_type {
    const char *name;
    int stages;    /* greatest number of paths traced by one mutation */
    bool excludes; /* some proposals are not counted as states of the chain */
    /* Makes `mutations` mutations, counted by first proposals. Second proposals
     * (MOVE_SECOND_STAGE) come on top. */
    void (*advance)(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_sinks *sinks,
                    long mutations);
};

extern const struct step_type step_mh; /* Metropolis-Hastings [Kelemen02] */
/* Proposals without a contribution are not counted as states [Zeng19, Alg. 2]. Biased:
 * the stationary density is f(x) times the probability that a proposal from x does not
 * fail. */
extern const struct step_type step_pf_paper;
/* After a failed proposal a second one from the same state; exact [GreenMira01]. The
 * state must have that move. */
extern const struct step_type step_pf_exact;

#endif
