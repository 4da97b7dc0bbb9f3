#ifndef ETALON_INTEGRATOR_MLT_STATE_H
#define ETALON_INTEGRATOR_MLT_STATE_H

/* Paths as states of a chain [Veach97, chapter 11]. The large step is a path of
 * independent bidirectional sampling; the local moves are path mutations, chosen by
 * weight among those that suit the path, and small steps of the numbers of a technique
 * that makes the path.
 *
 * A target's ctx is a struct path_space, and its eval full_path_sample: f / p, so that
 * the large step is accepted by f/p against f/p, as an independence sampler is [Liu96].
 */

#include "chain/kernel.h"
#include "chain/state.h"
#include "path/mutation.h"

enum mlt_move {
    MLT_LENS = MOVE_LOCAL,
    MLT_CAUSTIC,
    MLT_MULTICHAIN,
    MLT_BIDIRECTIONAL,
    MLT_LENS_SUBPATH,
    MLT_NUMBERS /* integrator/mlt_numbers.h; after all of mutation_types */
};
#define MLT_MOVES (MUTATIONS + 1)

struct mlt_options {
    const struct scene *scene;
    int depth; /* most edges of a path */
    struct mutation_options mutation;
    /* Of mutation_types, in that order, and MLT_NUMBERS; not negative. */
    double weights[MLT_MOVES];
    struct kernel kernel; /* of MLT_NUMBERS */
};

/* Its options are struct mlt_options, which must live as long as the state. */
extern const struct state_type state_mlt;

/* For tests. */
const struct full_path *mlt_state_current(const struct state *state);
const struct full_path *mlt_state_proposed(const struct state *state);

#endif
