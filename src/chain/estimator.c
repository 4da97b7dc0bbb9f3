#include "chain/estimator.h"

#include <math.h>

/* For targets below this the weight of a splat would leave the range of double: 1/I must
 * stay finite after multiplication by the film's scale and a bright splat. Such a state
 * is dimmer than the brightest by 270 orders of magnitude. */
#define TARGET_FLOOR 0x1p-900

double splat_weight(const struct chain_params *params, double target)
{
    double shift = params->estimator == ESTIMATOR_KELEMEN ? params->p_large * params->b0
                                                          : 0.0;
    return 1.0 / fmax(target + shift, TARGET_FLOOR); /* [Kelemen02] */
}
