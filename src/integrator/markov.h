#ifndef ETALON_INTEGRATOR_MARKOV_H
#define ETALON_INTEGRATOR_MARKOV_H

/* What all Markov-chain integrators share: bootstrap, seeds, measured start, the rule,
 * rounds of many chains, films and their normalisation. An
 * integrator adds its design. */

#include "integrator/integrator.h"
#include "integrator/markov_design.h"

struct markov_integrator {
    struct integrator_type type;
    struct markov_design (*design)(const struct scene *scene,
                                   const struct settings *settings);
};

/* A design with a failure map adds the layer failures.Y: the share of failed proposals by
 * pixel of the state from which they were proposed; -1 where there was no state. */
extern const struct integrator_methods markov_methods;

extern const struct markov_integrator integrator_pssmlt, integrator_mmlt,
    integrator_pfmlt, integrator_rjmlt, integrator_smlt, integrator_mlt;

/* What smlt has in common with pssmlt. */
struct markov_design pssmlt_design(const struct scene *scene,
                                   const struct settings *settings);

#endif
