#include "integrator/passes.h"

static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_PT;
}

const struct passes_integrator integrator_pt = {
    .type = {.name = "pt",
             .summary = "path tracing with next-event estimation",
             .methods = &passes_methods,
             .techniques = techniques},
    .estimate = estimate_pt,
    .light_image = false,
};
