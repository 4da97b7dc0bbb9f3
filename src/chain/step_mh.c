/* Metropolis-Hastings with large and small steps and expected-value splats [Kelemen02].
 * Both kinds of step are symmetric, so the ratio of the targets alone decides. */

#include "chain/step.h"

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_films *films)
{
    enum move move = step_propose(chain, params, target, films);
    double a = step_acceptance(chain->current->target, chain->proposed->target);
    step_count(&chain->tally, move, chain->proposed, a);
    step_record(chain, params, films, move);
    step_settle(chain, params, films, move, a);
}

static void advance(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_films *films,
                    long mutations)
{
    for (long i = 0; i < mutations; i++)
        mutate(chain, params, target, films);
}

const struct step_type step_mh = {
    .name = "mh",
    .stages = 1,
    .advance = advance,
};
