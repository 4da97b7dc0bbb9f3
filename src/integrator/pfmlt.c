/* MMLT whose failed proposals are treated apart [Zeng19], in three modes:
 *   exact    after a failure a second, narrower proposal [GreenMira01];
 *   counted  failures are repeats of the state, as in mmlt: the control;
 *   paper    failures are no states [Zeng19, Alg. 2]. Biased: the density is f Z, Z the
 *            probability that a proposal does not fail. */

#include "integrator/multiplex.h"

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    return multiplex_design(scene, settings, multiplex_step(settings), true);
}

/* Lengths 1 and 2 may be rendered by pt; pt cannot sample the same paths of these lengths
 * as bdpt. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_pfmlt = {
    .type = {.name = "pfmlt",
             .summary = "mmlt that treats failed proposals apart: mode exact, counted, "
                        "or paper (biased)",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = design_of,
};
