#ifndef ETALON_INTEGRATOR_MULTIPLEX_H
#define ETALON_INTEGRATOR_MULTIPLEX_H

/* Chains over multiplexed paths, one length each [Hachisuka14]: what mmlt and pfmlt
 * share. They differ in the step. */

#include "integrator/markov.h"

struct markov_design multiplex_design(const struct scene *scene,
                                      const struct settings *settings,
                                      const struct step_type *step, bool failure_map);

#endif
