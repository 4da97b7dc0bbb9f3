/* Metropolis-Hastings with large steps, local moves and expected-value splats
 * [Kelemen02]. */

#include "chain/step.h"

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_sinks *sinks)
{
    struct proposal y = step_propose(chain, params, target, sinks);
    /* [Kelemen02, section 3], [Zeng19 Eq. 7] */
    double a = step_acceptance(chain->current->target, chain->proposed->target,
                               y.log_ratio);
    step_count(&chain->tally, y.move, chain->proposed, a);
    step_work(chain, sinks, y.move, 1.0);
    step_splat_proposal(chain, params, sinks, y.move, a);
    step_accept_or_reject(chain, params, sinks, y.move, a);
}

static void advance(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_sinks *sinks,
                    long mutations)
{
    for (long i = 0; i < mutations; i++)
        mutate(chain, params, target, sinks);
}

const struct step_type step_mh = {
    .name = "mh",
    .stages = 1,
    .advance = advance,
};
