/* Metropolis-Hastings whose failed proposals are no states of the chain [Zeng19, Alg. 2]:
 * they are tallied, and the next mutation is drawn anew, including its kind of step.
 *
 * This is biased. A state x is left for y with density q(y|x) min(1, f(y)/f(x)) / Z(x),
 * Z(x) the probability that a proposal from x does not fail, and f(x) Z(x) * q(y|x)/Z(x)
 * * min(1, f(y)/f(x)) = q(y|x) min(f(x), f(y)) is symmetric in x and y: the states that
 * count have the stationary density f Z. Only where Z is constant, as in the simulation
 * of [Zeng19, section 4.1], is that the target. */

#include "chain/step.h"

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_sinks *sinks)
{
    struct proposal y = step_propose(chain, params, target, sinks);
    double a = step_acceptance(chain->current->target, chain->proposed->target,
                               y.log_ratio);
    step_count(&chain->tally, y.move, chain->proposed, a);
    step_splat_proposal(chain, params, sinks, y.move, a);
    if (chain->proposed->target > 0.0) {
        step_accept_or_reject(chain, params, sinks, y.move, a);
    } else {
        /* [Zeng19, Alg. 2, lines 22 to 26] */
        chain->tally.excluded++;
        step_reject(chain);
    }
}

/* Failures count as mutations, so that a chain that cannot move ends too. */
static void advance(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_sinks *sinks,
                    long mutations)
{
    for (long i = 0; i < mutations; i++)
        mutate(chain, params, target, sinks);
}

const struct step_type step_pf_paper = {
    .name = "pf-paper",
    .stages = 1,
    .excludes = true,
    .advance = advance,
};
