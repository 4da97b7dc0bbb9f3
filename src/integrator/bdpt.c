#include "integrator/passes.h"

static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct passes_integrator integrator_bdpt = {
    .type = {.name = "bdpt",
             .summary = "bidirectional path tracing, all (s,t)",
             .methods = &passes_methods,
             .techniques = techniques},
    .estimate = estimate_bdpt,
    .light_image = true,
};
