#ifndef ETALON_CHAIN_CHAIN_H
#define ETALON_CHAIN_CHAIN_H

/* One Markov chain on a target: current and proposed state, expected-value splats, tally.
 * How a step is made is a step_type; how much a splat weighs is splat_weight, one
 * function for accept, reject and the final flush. */

#include "base/mem.h"
#include "chain/pss.h"
#include "chain/tally.h"
#include "chain/target.h"
#include "image/film.h"
#include "image/replicas.h"

enum estimator { ESTIMATOR_KELEMEN, ESTIMATOR_PLAIN };

/* What all chains of a phase share; constant within a round. */
struct chain_params {
    double p_large; /* probability of a large step */
    double b0;      /* kelemen: guess of b, >= 0 */
    enum estimator estimator;
    /* What splats are multiplied by, where chains of several normalisations share a film;
     * else 1. */
    double chain_scale, large_scale;
};

/* Splats in units of b0. After M mutations in all, and N pixels [Kelemen02]:
 * plain:   pixel = N/M * b * chain;  kelemen: pixel = N/M * (b * chain + b0 * large).
 * The chain's M counts its states: not what tally.excluded does, nor timid proposals. */
struct chain_films {
    struct film *chain;
    struct film *large; /* unused by plain */
    /* NULL, or: at the current state's pixels, r counts proposals that failed and g all,
     * both of stage one. r/g is the picture of 1 - Z [Zeng19]. */
    struct film *failures;
};

/* Replicas that splats are added to besides, times these factors and in units of theirs;
 * the films' scales do not count. More than one: contrasts of a few chains. */
struct chain_share {
    int64_t first; /* where the replica's pixels begin */
    double chain, large;
};

struct chain_aim {
    struct replica_lane *lane;
    const struct chain_share *shares; /* [count] */
    int count;                        /* 0: there are no replicas */
    double scale; /* of what a state adds, in the books, where all chains' are compared */
    /* NULL, or: luminance of all large proposals by tile, where no film shows them, and
     * which tile a pixel is in. */
    double *large;
    const uint16_t *tile_of;
};

struct chain {
    _Alignas(MEM_APART) struct pss pss; /* chains of other threads lie beside it */
    struct rng rng;
    struct contrib states[2];
    struct contrib *current, *proposed;
    double held; /* splat weight owed to `current`: its own a, then every 1-a */
    struct tally tally;
    int64_t stay,
        longest_stay;     /* mutations since the last accepted one, and its record */
    struct chain_aim aim; /* set anew for every round */
};

/* Factor of F for weight 1 in the chain film: 1/I (plain) or 1/(I + p_l b0) (kelemen),
 * I = target > 0. The large film takes the second too. Either is multiplied by the film's
 * scale besides. */
double chain_splat_weight(const struct chain_params *params, double target);

/* Not to be moved afterwards (see pss_init). */
void chain_init(struct chain *chain, const int capacity[PSS_STREAMS], int max_splats,
                const struct kernel *kernel);
void chain_deinit(struct chain *chain);
/* What one takes, the struct included. */
double chain_bytes(const int capacity[PSS_STREAMS], int max_splats);

/* Starts from bootstrap path `index` of `seed` by replaying it; then the chain's own
 * stream (RNG_CHAIN, id) takes over. A path without a contribution will do: the first
 * non-zero proposal is then accepted. Clears the tally. */
void chain_seed(struct chain *chain, const struct target *target, uint64_t seed,
                uint64_t bootstrap_index, uint64_t id);

/* Splats what `current` is owed. At the end of every round and phase: the parameters must
 * be those that the mutations since the last flush were made with. */
void chain_flush(struct chain *chain, const struct chain_params *params,
                 const struct chain_films *films);

/* For steps: the proposal's contribution (a scalar that is not a finite number >= 0 is
 * counted and becomes a black state), its splats, and the two ends of a mutation. */
void chain_evaluate(struct chain *chain, const struct target *target,
                    struct contrib *out);
void chain_splat(const struct contrib *contrib, struct film *film, double weight);
/* The same to the chain's replicas, the large film's part or the chain film's. */
void chain_splat_replicas(const struct chain *chain, const struct contrib *contrib,
                          double weight, bool large);
/* A large proposal to the chain's tiles, if it has some. */
void chain_add_large(const struct chain *chain, const struct contrib *proposed);
/* (proposal failed, 1, 0) at each pixel of the current state. */
void chain_splat_failure(const struct chain *chain, struct film *film);
void chain_accept(struct chain *chain);
void chain_reject(struct chain *chain);

/* To or from a checkpoint (base/pack.h), flushed before; read into a chain of the same
 * making. pixels: of the film. */
void chain_pack(struct pack *pack, struct chain *chain, long pixels);

struct step_type {
    const char *name;
    int stages;    /* paths that one mutation traces at most */
    bool excludes; /* some proposals are no states of the chain */
    /* Makes `mutations` mutations: first proposals, whatever becomes of them. What is
     * traced besides (MOVE_TIMID) comes on top. */
    void (*advance)(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_films *films,
                    long mutations);
};

extern const struct step_type step_mh; /* Metropolis-Hastings [Kelemen02] */
/* Proposals without a contribution are no states [Zeng19, Alg. 2]. Biased: the stationary
 * density is f(x) times the probability that a proposal from x does not fail. */
extern const struct step_type step_pf_paper;
/* After a failed proposal a second, timid one; exact [GreenMira01]. Gaussian kernel. */
extern const struct step_type step_pf_exact;

#endif
