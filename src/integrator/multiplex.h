#ifndef ETALON_INTEGRATOR_MULTIPLEX_H
#define ETALON_INTEGRATOR_MULTIPLEX_H

/* Chains over multiplexed paths, one length each [Hachisuka14]: what mmlt, pfmlt and
 * rjmlt share. They differ in the step, and in the moves of the state. */

#include "integrator/markov.h"

struct markov_design multiplex_design(const struct scene *scene,
                                      const struct settings *settings,
                                      const struct step_type *step, bool failure_map);
/* The step that the setting `mode` means. */
const struct step_type *multiplex_step(const struct settings *settings);

#endif
