/* Lens perturbation [Veach97, section 11.4.3.1; CMU17]: E S* D (D|L), and E S* L as well,
 * which no other perturbation could move. */

#include "path/mutation.h"

static bool suits(struct path_space *space, struct full_path *x)
{
    return mutation_camera_last(x) == mutation_camera_first(x) &&
           mutation_camera_suits(space, x);
}

const struct mutation mutation_lens = {
    .name = "lens",
    .suits = suits,
    .propose = mutation_camera,
    .density = mutation_camera_density,
};
