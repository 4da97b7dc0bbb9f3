#ifndef ETALON_INTEGRATOR_PASS_TARGET_H
#define ETALON_INTEGRATOR_PASS_TARGET_H

/* The samples of passes as a target, for those who look at single ones. */

#include "chain/target.h"
#include "integrator/passes.h"

struct target pass_target_create(const struct scene *scene, int depth,
                                 estimate_function estimate);
/* Does nothing to targets of other kinds. */
void pass_target_destroy(struct target *target);

#endif
