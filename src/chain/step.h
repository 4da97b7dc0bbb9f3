#ifndef ETALON_CHAIN_STEP_H
#define ETALON_CHAIN_STEP_H

/* Functions that the steps share; for chain.c and step_*.c only. A mutation is
 * step_propose, one or more decisions with step_acceptance and step_count, and, if it
 * makes a state of the chain, step_accept_or_reject. */

#include "chain/chain.h"
#include "chain/tape.h"

#include <math.h>

/* Acceptance probability of Metropolis-Hastings, min(1, I(y) q(y->x) / (I(x) q(x->y))). A
 * state without a contribution is left as soon as possible. */
double step_acceptance_asymmetric(double current, double proposed, double log_ratio);

/* The same; for a symmetric move min(1, I(y)/I(x)) [Kelemen02, section 3]. */
static inline double step_acceptance(double current, double proposed, double log_ratio)
{
    if (log_ratio != 0.0)
        return step_acceptance_asymmetric(current, proposed, log_ratio);
    if (proposed >= current)
        return proposed > 0.0 ? 1.0 : 0.0;
    return proposed / current;
}

/* Makes and evaluates a proposal. If its target is not a finite number >= 0, or its ratio
 * is not a number, it is counted and carries nothing. */
static inline struct proposal step_evaluate(struct chain *chain,
                                            const struct target *target, enum move move,
                                            struct contrib *out)
{
    struct state *state = chain->state;
    struct proposal p = state->type->propose(state, target, move, out);
    if (!(out->target >= 0.0 && out->target < HUGE_VAL && p.log_ratio < HUGE_VAL)) {
        out->nonfinite++;
        contrib_clear(out);
    }
    return p;
}

/* Draws whether the step is large, and evaluates its proposal. */
static inline struct proposal step_propose(struct chain *chain,
                                           const struct chain_params *params,
                                           const struct target *target,
                                           const struct chain_sinks *sinks)
{
    bool large = rng_double(&chain->rng) < params->p_large;
    chain->large = large;
    /* Most proposals are accepted, and then the current state is splatted. */
    splat_sinks_prefetch(&sinks->states, chain->current);
    return step_evaluate(chain, target, large ? MOVE_LARGE : MOVE_LOCAL, chain->proposed);
}

/* Counts the proposal, accepted with probability a. */
static inline void step_count(struct tally *tally, int move,
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

/* Work of the last proposal. */
static inline double step_proposal_work(const struct chain *chain)
{
    const struct state_type *type = chain->state->type;
    return type->work ? type->work(chain->state, chain->proposed) : 1.0;
}

/* Counts the work of the last proposal; count: 1 for the first of a mutation, else 0. */
static inline void step_work(struct chain *chain, const struct chain_sinks *sinks,
                             int move, double count)
{
    const struct state_type *type = chain->state->type;
    if (!sinks->tape && !type->tallies_work)
        return;
    double work = step_proposal_work(chain);
    if (type->tallies_work)
        chain->tally.work[move] += work;
    if (sinks->tape)
        tape_work(sinks->tape, chain->large, count, work);
}

static inline void step_record(const struct chain *chain, struct tape *tape, int move,
                               double a, bool accepted)
{
    enum tape_event event = move == MOVE_LARGE          ? TAPE_LARGE
                            : move != MOVE_SECOND_STAGE ? TAPE_LOCAL
                            : chain->large              ? TAPE_AFTER_LARGE
                                                        : TAPE_AFTER_SMALL;
    tape_record(tape, event, chain->proposed, a, accepted);
}

/* Hands a proposal to sinks->steps, which there is. */
void step_map(const struct chain *chain, const struct step_sink *steps, int move,
              double a);

/* Adds a first proposal, accepted with probability a, to the sinks for large steps and
 * for steps. */
static inline void step_splat_proposal(const struct chain *chain,
                                       const struct chain_params *params,
                                       const struct chain_sinks *sinks, int move,
                                       double a)
{
    const struct contrib *y = chain->proposed;
    if (move == MOVE_LARGE && sinks->large.count > 0 && y->target > 0.0) {
        bool plain = params->estimator == ESTIMATOR_PLAIN;
        double weight = plain ? 1.0 : splat_weight(params, y->target);
        splat_sinks_add(&sinks->large, y, weight, chain->rng.s[0]);
    }
    if (sinks->steps)
        step_map(chain, sinks->steps, move, a);
}

/* The chain is where it was, at the same path. */
static inline void step_stay(struct chain *chain)
{
    if (++chain->rejections_in_row > chain->most_rejections_in_row)
        chain->most_rejections_in_row = chain->rejections_in_row;
}

static inline void step_accept(struct chain *chain, int move)
{
    struct contrib *replaced = chain->current;
    chain->current = chain->proposed;
    chain->proposed = replaced;
    chain->state->type->accept(chain->state);
    if (move_keeps_path(move))
        step_stay(chain);
    else
        chain->rejections_in_row = 0;
}

static inline void step_reject(struct chain *chain)
{
    chain->state->type->reject(chain->state);
    step_stay(chain);
}

/* Decides on a proposal and makes one state of the chain. Expected-value splats: the
 * proposal with weight a, the current state with 1-a [Veach97, chapter 11]. The weight a
 * of an accepted proposal stays pending and is splatted together with the 1-a of later
 * rejections. */
static inline void step_accept_or_reject(struct chain *chain,
                                         const struct chain_params *params,
                                         const struct chain_sinks *sinks, int move,
                                         double a)
{
    bool accepted = rng_double(&chain->rng) < a;
    if (sinks->tape)
        step_record(chain, sinks->tape, move, a, accepted);
    /* FinalFailurePaths [Zeng19, section 6.1]. */
    chain->tally.final_failures += a < TALLY_FINAL_FAILURE;
    chain->pending_weight += 1.0 - a;
    if (accepted) {
        chain->tally.accepted[move]++;
        chain_flush(chain, params, sinks);
        step_accept(chain, move);
        chain->pending_weight = a;
        return;
    }
    chain->tally.zero_states += !(chain->current->target > 0.0);
    if (a > 0.0) {
        double weight = splat_weight(params, chain->proposed->target);
        splat_sinks_add(&sinks->states, chain->proposed, a * weight, chain->rng.s[0]);
    }
    step_reject(chain);
}

#endif
