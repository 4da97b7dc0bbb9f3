#ifndef ETALON_INTEGRATOR_MARKOV_H
#define ETALON_INTEGRATOR_MARKOV_H

/* What all Markov-chain integrators share: bootstrap, seeds, measured start, the rule,
 * rounds of many chains, films and their normalisation (DESIGN sections 3 to 5). An
 * integrator adds a target and a step.
 *
 * Chains come in groups, each with a normalisation of its own: one for every path length
 * (mmlt, pfmlt), or one for all (pssmlt). */

#include "chain/pss.h"
#include "integrator/integrator.h"

struct markov;

struct markov_design {
    const struct step_type *step;
    const struct state_type *state;
    struct pss_options pss; /* for state_pss; its kernel is that of the settings */
    int max_splats;
    /* Path lengths (edges) that have chains of their own: first..last; 0, 0: one group of
     * chains for all. */
    int first_length, last_length;
    /* Lengths up to this one are no chain's, but plain samples' (pt's); 0: none. */
    int plain_lengths;
    int depth;
    bool failure_map;
    /* NULL, or: whether the scene has paths of a length at all. */
    bool (*has_length)(const struct scene *scene, int length);
    /* The target of one thread for paths of one length (0: all); scratch lives behind it,
     * for paths of at most `depth` edges. */
    struct target (*target_create)(const struct scene *scene,
                                   const struct settings *settings, int length);
    void (*target_destroy)(struct target *target);
};

struct markov *markov_create(const struct scene *scene, const struct settings *settings,
                             const struct markov_design *design);
void markov_destroy(void *self);
/* What one of that design will take at most. */
void markov_memory(const struct scene *scene, const struct settings *settings,
                   const struct markov_design *design, struct run_memory *out);

/* The functions of integrator_type on a struct markov. */
bool markov_advance(void *self, const struct round_limits *limits);
bool markov_started(const void *self);
void markov_picture(void *self, struct image *out);
void markov_statistics(const void *self, struct run_statistics *out);
double markov_progress(const void *self);
void markov_pack(void *self, struct pack *pack);
void markov_evidence(void *self, struct evidence *out);
/* Share of failed proposals by pixel of the state that made them, [height][width]; -1
 * where no state was. */
void markov_failure_map(void *self, float *out);

#endif
