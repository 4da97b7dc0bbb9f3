/* Selectively Metropolised light transport [Bitterli19]: independent samples render what
 * they do well, chains the rest; see split.c. The chains are those of pssmlt over bdpt or
 * pt, with passes of the same estimator, or those of mmlt, with passes of bdpt. */

#include "integrator/markov.h"
#include "integrator/multiplex.h"
#include "path/estimate.h"

#include <string.h>

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    bool pt = strcmp(settings->builder, "pt") == 0;
    bool multiplexed = settings_multiplexed(settings);
    struct markov_design design = multiplexed
                                      ? multiplex_design(scene, settings, &step_mh, false)
                                      : pssmlt_design(scene, settings);
    design.split = design.guess = true;
    design.passes = (struct passes_plan){
        .depth = design.depth,
        .estimate = pt            ? estimate_pt
                    : multiplexed ? estimate_bdpt_techniques
                                  : estimate_bdpt,
        .light_image = !pt,
    };
    return design;
}

static unsigned techniques(const struct settings *settings)
{
    return strcmp(settings->builder, "pt") == 0 ? TECHNIQUES_PT : TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_smlt = {
    .type = {.name = "smlt",
             .summary = "selective MLT: independent samples where they do, chains where "
                        "they do not",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = design_of,
};
