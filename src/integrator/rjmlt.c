/* Reversible jump MLT [Bitterli18]: mmlt, and some of the mutations change the technique
 * and keep the path, by numbers that inverse sampling finds. Failed proposals as in
 * pfmlt, if a mode asks for that; by default they are repeats of the state. */

#include "chain/pss_jump.h"
#include "integrator/multiplex.h"

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    const struct step_type *step = multiplex_step(settings);
    struct markov_design design = multiplex_design(scene, settings, step,
                                                   step != &step_mh);
    design.state = &state_pss_jump;
    design.pss.jump = settings->jump;
    return design;
}

/* Lengths 1 and 2 may be rendered by pt; pt cannot sample the same paths of these lengths
 * as bdpt. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_rjmlt = {
    .type = {.name = "rjmlt",
             .summary = "mmlt with jumps between the techniques of a path",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = design_of,
};
