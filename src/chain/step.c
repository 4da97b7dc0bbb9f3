#include "chain/step.h"

#include <math.h>

/* Computed in logs, as neither ratio need be in the range of double. The exponents of the
 * targets are subtracted separately, so that scaling the target by a power of two changes
 * no bit. */
double step_acceptance_asymmetric(double current, double proposed, double log_ratio)
{
    if (!(proposed > 0.0 && current > 0.0))
        return proposed > 0.0 ? 1.0 : 0.0;
    int from, to;
    double mantissas = frexp(proposed, &to) / frexp(current, &from);
    double log_a = log(mantissas) + (to - from) * M_LN2 + log_ratio;
    return log_a < 0.0 ? exp(log_a) : 1.0;
}

void step_map(const struct chain *chain, const struct step_sink *steps, int move,
              double a)
{
    struct step_event event = {.move = move,
                               .first = move != MOVE_SECOND_STAGE,
                               .failed = !(chain->proposed->target > 0.0),
                               .acceptance = a};
    if (steps->counts_work)
        event.work = step_proposal_work(chain);
    steps->add(steps, chain->current, &event);
}
