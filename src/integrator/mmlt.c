/* Multiplexed MLT [Hachisuka14]: a chain has one path length, and one of its numbers
 * picks the technique. */

#include "integrator/multiplex.h"

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    return multiplex_design(scene, settings, &step_mh, false);
}

/* Lengths 1 and 2 may be rendered by pt; pt cannot sample the same paths of these lengths
 * as bdpt. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_mmlt = {
    .type = {.name = "mmlt",
             .summary = "multiplexed MLT: chains of one path length, one technique at a "
                        "time",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = design_of,
};
