#ifndef ETALON_INTEGRATOR_MARKOV_FIXED_H
#define ETALON_INTEGRATOR_MARKOV_FIXED_H

/* The picture of chains with fixed weights (convergence/fixed_picture.h). */

#include "integrator/integrator.h"

void markov_fixed_picture(void *self, struct fixed_picture *out);

#endif
