/* Metropolis-Hastings with large and small steps and expected-value splats [Kelemen02].
 * Both kinds of step are symmetric, so the ratio of the targets alone decides. */

#include "chain/chain.h"

/* min(1, I(y)/I(x)) [Kelemen02, section 3]; a black state is left as soon as possible. */
static double acceptance(double current, double proposed)
{
    if (proposed >= current)
        return proposed > 0.0 ? 1.0 : 0.0;
    return proposed / current;
}

static void count(struct tally *tally, enum move move, const struct contrib *proposed,
                  double a)
{
    double target = proposed->target;
    tally->proposed[move]++;
    if (target > 0.0)
        tally->nonzero[move]++;
    else
        tally->failures[move][proposed->failure]++;
    tally->acceptance[move] += a;
    tally->final_failures += a < TALLY_FINAL_FAILURE;
    if (move == MOVE_LARGE) {
        tally->large_sum += target;
        tally->large_sum_squares += target * target;
    }
}

/* The weight a of an accepted proposal is held back with the 1-a that will follow. */
static void splat_proposed(const struct chain *chain, const struct chain_params *params,
                           const struct chain_films *films, enum move move, double a,
                           bool accepted)
{
    const struct contrib *y = chain->proposed;
    double weight = chain_splat_weight(params, y->target);
    if (a > 0.0 && !accepted)
        chain_splat(y, films->chain, a * weight * params->chain_scale);
    if (move == MOVE_LARGE && params->estimator == ESTIMATOR_KELEMEN)
        chain_splat(y, films->large, weight * params->large_scale);
}

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_films *films)
{
    enum move move = rng_double(&chain->rng) < params->p_large ? MOVE_LARGE : MOVE_SMALL;
    pss_begin(&chain->pss, move == MOVE_LARGE);
    /* Most proposals are accepted: what the state then is owed will be splatted. */
    for (int i = 0; i < chain->current->count; i++)
        film_expect(films->chain, chain->current->splats[i].pixel);
    chain_evaluate(chain, target, chain->proposed);

    double a = acceptance(chain->current->target, chain->proposed->target);
    bool accepted = rng_double(&chain->rng) < a;
    count(&chain->tally, move, chain->proposed, a);
    if (chain->proposed->target > 0.0)
        splat_proposed(chain, params, films, move, a, accepted);
    chain->held += 1.0 - a;
    if (accepted) {
        chain->tally.accepted[move]++;
        chain_flush(chain, params, films);
        chain_accept(chain);
        chain->held = a;
    } else {
        chain_reject(chain);
    }
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
