#ifndef ETALON_INTEGRATOR_MARKOV_H
#define ETALON_INTEGRATOR_MARKOV_H

/* What all Markov-chain integrators share: bootstrap, seeds, measured start, the rule,
 * rounds of many chains, films and their normalisation (DESIGN sections 3 to 5). An
 * integrator adds a target and a step. */

#include "integrator/integrator.h"

struct markov;

struct markov_design {
    const struct step_type *step;
    int capacity[PSS_STREAMS]; /* places of each stream */
    int max_splats;
    /* One target for each thread: scratch lives behind it. */
    struct target (*target_create)(const struct scene *scene,
                                   const struct settings *settings);
    void (*target_destroy)(struct target *target);
};

struct markov *markov_create(const struct scene *scene, const struct settings *settings,
                             const struct markov_design *design);
void markov_destroy(void *self);

/* The functions of integrator_type on a struct markov. */
bool markov_advance(void *self, const struct round_limits *limits);
bool markov_started(const void *self);
void markov_picture(void *self, struct image *out);
void markov_statistics(const void *self, struct run_statistics *out);
double markov_progress(const void *self);

#endif
