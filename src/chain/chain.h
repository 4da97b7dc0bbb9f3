#ifndef ETALON_CHAIN_CHAIN_H
#define ETALON_CHAIN_CHAIN_H

/* One Markov chain on a target: its state, the contributions of the current and of the
 * proposed one, expected-value splats, tally. What a state is and how it moves is a
 * state_type; how proposals are decided on is a step_type; how much a splat weighs is
 * splat_weight, one function for accept, reject and the final flush. */

#include "base/mem.h"
#include "chain/splat_sink.h"
#include "chain/state.h"

enum estimator { ESTIMATOR_KELEMEN, ESTIMATOR_PLAIN };

/* What all chains of a phase share; constant within a round. */
struct chain_params {
    double p_large; /* probability of a large step */
    double b0;      /* kelemen: guess of b, >= 0 */
    enum estimator estimator;
};

/* After M mutations in all, and N pixels, with films of the splats [Kelemen02]:
 * plain:   pixel = N/M * b * states;  kelemen: pixel = N/M * (b * states + b0 * large).
 * The states' M counts states: not what tally.excluded does, nor second stages. */
struct chain {
    _Alignas(MEM_APART) struct rng rng; /* chains of other threads lie beside it */
    struct state *state;
    struct contrib contribs[2];
    struct contrib *current, *proposed;
    double pending_weight; /* of `current`, not splatted yet: its own a, then every 1-a */
    struct tally tally;
    int64_t rejections_in_row, most_rejections_in_row; /* since chain_seed */
};

/* Factor of F for weight 1: 1/I (plain) or 1/(I + p_l b0) (kelemen), I = target > 0. */
double chain_splat_weight(const struct chain_params *params, double target);

/* options: of the state's type. Not to be moved afterwards: the state knows the rng. */
void chain_init(struct chain *chain, const struct state_type *type, const void *options,
                int max_splats);
void chain_deinit(struct chain *chain);
/* What one takes beside its struct. */
double chain_bytes(const struct state_type *type, const void *options, int max_splats);

/* Starts from bootstrap path `index` of `seed` by replaying it; then the chain's own
 * stream (RNG_CHAIN, id) takes over. A path without a contribution will do: the first
 * non-zero proposal is then accepted. Clears the tally. */
void chain_seed(struct chain *chain, const struct target *target, uint64_t seed,
                uint64_t bootstrap_index, uint64_t id);

/* Splats the pending weight of `current`. At the end of every round and phase: the
 * parameters must be those that the mutations since the last flush were made with. */
void chain_flush(struct chain *chain, const struct chain_params *params,
                 const struct chain_sinks *sinks);

/* To or from a checkpoint (base/pack.h), flushed before; read into a chain of the same
 * making. pixels: of the film. */
void chain_pack(struct pack *pack, struct chain *chain, long pixels);

struct step_type {
    const char *name;
    int stages;    /* paths that one mutation traces at most */
    bool excludes; /* some proposals are no states of the chain */
    /* Makes `mutations` mutations: first proposals, whatever becomes of them. What is
     * traced besides (MOVE_SECOND_STAGE) comes on top. */
    void (*advance)(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_sinks *sinks,
                    long mutations);
};

extern const struct step_type step_mh; /* Metropolis-Hastings [Kelemen02] */
/* Proposals without a contribution are no states [Zeng19, Alg. 2]. Biased: the stationary
 * density is f(x) times the probability that a proposal from x does not fail. */
extern const struct step_type step_pf_paper;
/* After a failed proposal a second one from the same state; exact [GreenMira01]. The
 * state must have that move. */
extern const struct step_type step_pf_exact;

#endif
