#ifndef ETALON_INTEGRATOR_REGISTRY_H
#define ETALON_INTEGRATOR_REGISTRY_H

#include "integrator/integrator.h"

extern const struct integrator_type *const integrator_types[]; /* NULL-terminated */
const struct integrator_type *integrator_find(const char *name);

#endif
