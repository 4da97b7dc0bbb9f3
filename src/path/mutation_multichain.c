/* Multi-chain perturbation [Veach97, section 11.4.3.3; CMU17]: E S+ D S+ D (D|L), and any
 * number of chains: E S* (D S+)+ (D (D|L) | L). */

#include "path/mutation.h"

static bool suits(struct path_space *space, struct full_path *x)
{
    return mutation_camera_last(x) > mutation_camera_first(x) &&
           mutation_camera_suits(space, x);
}

const struct mutation mutation_multichain = {
    .name = "multichain",
    .suits = suits,
    .propose = mutation_camera,
    .density = mutation_camera_density,
};
