#ifndef ETALON_CHAIN_STEP_H
#define ETALON_CHAIN_STEP_H

/* What the steps share; for step_*.c only. A mutation is step_propose, one or more
 * decisions with step_acceptance and step_count, and, if it makes a state of the chain,
 * step_settle. */

#include "chain/chain.h"

/* min(1, I(y)/I(x)) [Kelemen02, section 3]; a black state is left as soon as possible. */
static inline double step_acceptance(double current, double proposed)
{
    if (proposed >= current)
        return proposed > 0.0 ? 1.0 : 0.0;
    return proposed / current;
}

/* Draws the kind of step and evaluates its proposal. */
static inline enum move step_propose(struct chain *chain,
                                     const struct chain_params *params,
                                     const struct target *target,
                                     const struct chain_films *films)
{
    enum move move = rng_double(&chain->rng) < params->p_large ? MOVE_LARGE : MOVE_SMALL;
    pss_begin(&chain->pss, move == MOVE_LARGE);
    /* Most proposals are accepted: what the state then is owed will be splatted. The
     * replicas' pixels are not announced, that makes it slower. */
    for (int i = 0; i < chain->current->count; i++)
        film_prefetch(films->chain, chain->current->splats[i].pixel);
    chain_evaluate(chain, target, chain->proposed);
    return move;
}

/* The proposal in the books, accepted with probability a. */
static inline void step_count(struct tally *tally, enum move move,
                              const struct contrib *proposed, double a)
{
    double target = proposed->target;
    tally->proposed[move]++;
    if (target > 0.0)
        tally->nonzero[move]++;
    else
        tally->failures[move][proposed->failure]++;
    tally->acceptance[move] += a;
    if (move == MOVE_LARGE) {
        tally->large_sum += target;
        double square = target * target;
        tally->large_sum_squares += square;
        tally->large_sum_fourths += square * square;
    }
}

/* What films other than the chain's want of a first proposal, before it is settled. */
static inline void step_record(const struct chain *chain,
                               const struct chain_params *params,
                               const struct chain_films *films, enum move move)
{
    const struct contrib *y = chain->proposed;
    if (move == MOVE_LARGE && params->estimator == ESTIMATOR_KELEMEN && y->target > 0.0) {
        double weight = chain_splat_weight(params, y->target);
        chain_splat(y, films->large, weight * params->large_scale);
        chain_splat_replicas(chain, y, weight, true);
    } else if (move == MOVE_LARGE) {
        chain_add_large(chain, y);
    }
    if (films->failures)
        chain_splat_failure(chain, films->failures);
}

/* One state of the chain: expected-value splats, then the move or the stay. The weight a
 * of an accepted proposal is held back with the 1-a that will follow. */
static inline void step_settle(struct chain *chain, const struct chain_params *params,
                               const struct chain_films *films, enum move move, double a)
{
    bool accepted = rng_double(&chain->rng) < a;
    chain->tally.final_failures += a < TALLY_FINAL_FAILURE;
    chain->held += 1.0 - a;
    if (accepted) {
        chain->tally.accepted[move]++;
        chain_flush(chain, params, films);
        chain_accept(chain);
        chain->held = a;
        return;
    }
    chain->tally.black += !(chain->current->target > 0.0);
    if (a > 0.0) {
        double weight = chain_splat_weight(params, chain->proposed->target);
        chain_splat(chain->proposed, films->chain, a * weight * params->chain_scale);
        chain_splat_replicas(chain, chain->proposed, a * weight, false);
    }
    chain_reject(chain);
}

#endif
