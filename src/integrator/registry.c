#include "integrator/registry.h"

#include "base/text.h"

const struct integrator_type *const integrator_types[] = {
    &integrator_pssmlt, &integrator_mmlt, &integrator_pfmlt,
    &integrator_bdpt,   &integrator_pt,   NULL,
};

const struct integrator_type *integrator_find(const char *name)
{
    for (int i = 0; integrator_types[i]; i++)
        if (text_equal(integrator_types[i]->name, name))
            return integrator_types[i];
    return NULL;
}
