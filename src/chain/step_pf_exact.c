/* Delayed rejection of failed proposals [GreenMira01]. If the first proposal y1 has
 * f(y1) = 0, a second, timid one y2 from the same state x is accepted with
 *
 *     min(1, f(y2) q1(y1|y2) (1 - a1(y2,y1)) / (f(x) q1(y1|x) (1 - a1(x,y1)))),
 *
 * where a1, the probability of accepting y1, is 0 from anywhere, so that its factors
 * are 1. q1 is the density of the first step, its kind given, over the numbers that y1
 * was asked for until it failed. Which those are depends on y1 alone, so leaving out the
 * others, on which nothing depends, leaves the balance as it is. A large y1 comes from
 * everywhere alike: its q1 cancels. */

#include "chain/step.h"

#include <assert.h>

/* In logs, for neither ratio needs to be a number that double can hold; the exponents of
 * the targets apart, so that a power of two in the target changes no bit. */
static double timid_acceptance(double current, double proposed, double log_ratio)
{
    if (!(current > 0.0))
        return 1.0;
    int from, to;
    double mantissas = frexp(proposed, &to) / frexp(current, &from);
    double log_a = log(mantissas) + (to - from) * M_LN2 + log_ratio;
    return log_a < 0.0 ? exp(log_a) : 1.0;
}

static void try_timid(struct chain *chain, const struct chain_params *params,
                      const struct target *target, const struct chain_films *films)
{
    double a = 0.0;
    pss_begin_timid(&chain->pss);
    chain_evaluate(chain, target, chain->proposed);
    if (chain->proposed->target > 0.0)
        a = timid_acceptance(chain->current->target, chain->proposed->target,
                             pss_timid_log_ratio(&chain->pss));
    step_count(&chain->tally, MOVE_TIMID, chain->proposed, a);
    step_settle(chain, params, films, MOVE_TIMID, a);
}

static void mutate(struct chain *chain, const struct chain_params *params,
                   const struct target *target, const struct chain_films *films)
{
    enum move move = step_propose(chain, params, target, films);
    double a = step_acceptance(chain->current->target, chain->proposed->target);
    step_count(&chain->tally, move, chain->proposed, a);
    step_record(chain, params, films, move);
    if (chain->proposed->target > 0.0)
        step_settle(chain, params, films, move, a);
    else
        try_timid(chain, params, target, films);
}

static void advance(struct chain *chain, const struct chain_params *params,
                    const struct target *target, const struct chain_films *films,
                    long mutations)
{
    assert(chain->pss.kernel.type->log_density);
    for (long i = 0; i < mutations; i++)
        mutate(chain, params, target, films);
}

const struct step_type step_pf_exact = {
    .name = "pf-exact",
    .stages = 2,
    .advance = advance,
};
