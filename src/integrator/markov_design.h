#ifndef ETALON_INTEGRATOR_MARKOV_DESIGN_H
#define ETALON_INTEGRATOR_MARKOV_DESIGN_H

/* What distinguishes one Markov-chain integrator from another: the chains' state, step
 * and target, and the path lengths that have chains of their own.
 *
 * Chains come in groups, each with a normalisation of its own: one for every path length
 * (mmlt, pfmlt), or one for all (pssmlt). */

#include "chain/pss.h"
#include "chain/chain.h"
#include "integrator/mlt_state.h"
#include "integrator/passes.h"
#include "settings/settings.h"

struct markov_design {
    const struct step_type *step;
    const struct state_type *state;
    struct pss_options pss; /* for state_pss; its kernel is that of the settings */
    struct mlt_options mlt; /* for state_mlt */
    int max_splats;
    /* Path lengths (edges) that have chains of their own: first..last; 0, 0: one group of
     * chains for all. */
    int first_length, last_length;
    /* Lengths up to this one are rendered by plain samples (pt); 0: none. */
    int plain_lengths;
    int depth;
    double target_bytes; /* of a target of one thread, beside its sub-paths */
    bool failure_map;
    /* Whether chains take a share of the light only (integrator/split.h); relative to a
     * guess of the picture or to its mean; and the passes that render the rest (estimate
     * NULL: the chains' large steps do). */
    bool split, guess;
    struct passes_plan passes;
    /* NULL, or: sets what the design takes from the counts of the measured start; called
     * when that is over, and again by a run that goes on from there. */
    void (*adapt)(struct markov_design *design, const struct settings *settings,
                  const struct tally *start);
    /* NULL, or: whether the scene has paths of a length at all. */
    bool (*has_length)(const struct scene *scene, int length);
    /* The target of one thread for paths of one length (0: all), of at most `depth`
     * edges; it owns its scratch memory. */
    struct target (*target_create)(const struct scene *scene,
                                   const struct settings *settings, int length);
    void (*target_destroy)(struct target *target);
};

#endif
