/* Delayed rejection of failed proposals [GreenMira01]. If the first proposal y1 has f(y1)
 * = 0, a second one y2 from the same state x is accepted with
 *
 *     min(1, f(y2) q1(y1|y2) q2(x|y2) (1 - a1(y2,y1))
 *            / (f(x) q1(y1|x) q2(y2|x) (1 - a1(x,y1)))),
 *
 * where a1, the probability of accepting y1, is 0 from any state, so the factors (1 - a1)
 * are 1. The state computes the ratio of the densities q1 of the first and q2 of the
 * second move (in primary sample space: pss_second_stage_log_ratio). */

#include "chain/step.h"

static void try_second_stage(struct chain *chain, const struct chain_params *params,
                             const struct target *target, const struct chain_sinks *sinks)
{
    struct proposal y = step_evaluate(chain, target, MOVE_SECOND_STAGE, chain->proposed);
    /* Acceptance of the second stage, see above [GreenMira01]. */
    double a = step_acceptance_asymmetric(chain->current->target, chain->proposed->target,
                                          y.log_ratio);
    step_count(&chain->tally, y.move, chain->proposed, a);
    step_work(chain, sinks, y.move, 0.0);
    if (sinks->steps)
        step_map(chain, sinks->steps, y.move, a);
    step_accept_or_reject(chain, params, sinks, y.move, a);
}

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_sinks *sinks)
{
    struct proposal y = step_propose(chain, params, target, sinks);
    double a = step_acceptance(chain->current->target, chain->proposed->target,
                               y.log_ratio);
    step_count(&chain->tally, y.move, chain->proposed, a);
    step_work(chain, sinks, y.move, 1.0);
    step_splat_proposal(chain, params, sinks, y.move, a);
    /* A jump has no density, and one that failed no second stage. */
    if (chain->proposed->target > 0.0 || move_keeps_path(y.move))
        step_accept_or_reject(chain, params, sinks, y.move, a);
    else
        try_second_stage(chain, params, target, sinks);
}

static void advance(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_sinks *sinks,
                    long mutations)
{
    assert(chain->state->type->moves[MOVE_SECOND_STAGE]);
    for (long i = 0; i < mutations; i++)
        mutate(chain, params, target, sinks);
}

const struct step_type step_pf_exact = {
    .name = "pf-exact",
    .stages = 2,
    .advance = advance,
};
