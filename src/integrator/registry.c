#include "integrator/registry.h"

#include "base/text.h"
#include <math.h>
#include "integrator/automatic.h"
#include "integrator/markov.h"
#include "integrator/passes.h"

const struct integrator_type *const integrator_types[] = {
    &integrator_pssmlt.type, &integrator_mmlt.type,
    &integrator_pfmlt.type,  &integrator_rjmlt.type,
    &integrator_smlt.type,   &integrator_mlt.type,
    &integrator_bdpt.type,   &integrator_pt.type,
    &integrator_auto,        NULL,
};

const struct split_figures split_figures_none = {
    .floor = (double)NAN,
    .ceiling = (double)NAN,
    .passes = (double)NAN,
    .large = (double)NAN,
    .b = (double)NAN,
    .b_se = (double)NAN,
    .samples = (double)NAN,
    .relmse = (double)NAN,
    .passes_alone = (double)NAN,
    .chains_alone = (double)NAN,
};

const struct race_figures race_figures_none = {.paths = (double)NAN,
                                               .relmse = (double)NAN};

const struct adaptive_figures adaptive_figures_none = {.start = (double)NAN,
                                                       .predicted = (double)NAN};

const struct integrator_type *integrator_find(const char *name)
{
    for (int i = 0; integrator_types[i]; i++)
        if (text_equal(integrator_types[i]->name, name))
            return integrator_types[i];
    return NULL;
}
