#ifndef ETALON_INTEGRATOR_AUTOMATIC_H
#define ETALON_INTEGRATOR_AUTOMATIC_H

/* `auto`: the integrator that wins a race of short pilots (race.h), with its own
 * defaults. */

#include "integrator/integrator.h"

extern const struct integrator_type integrator_auto;

#endif
