#ifndef ETALON_CHAIN_BOOTSTRAP_H
#define ETALON_CHAIN_BOOTSTRAP_H

/* Independent paths before the chains: b, eta_0 and seeds (DESIGN section 4). */

#include "chain/target.h"

#include <stdint.h>

struct pack;

struct bootstrap {
    long count;
    double *targets;        /* [count], scalar of each path, until they are let go */
    int32_t *pixels;        /* [count], of its first splat; -1 without one; as long */
    double b, b_se;         /* mean */
    double eta_0, eta_0_se; /* share of paths with a non-zero contribution */
    /* Effective number of seeds, (sum f)^2 / sum f^2 over the targets f [Kong92]: chains
     * drawn in proportion to f are worth so many that begin at paths of their own. */
    double effective;
    long nonfinite; /* values or scalars that were not finite: taken as 0 */
};

/* Adds `count` paths, from number `first` on; targets_by_thread[threads]. Path i's
 * numbers come from (seed, RNG_BOOTSTRAP, i), in the order they are asked for. The
 * figures are those of before until bootstrap_summarize. */
void bootstrap_extend(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                      int max_splats, const struct target *targets_by_thread,
                      int threads);
/* Sets `effective` from all paths, b and eta_0 from the first `planned` ones: a mean over
 * paths of which some were added because of what others had found is biased. */
void bootstrap_summarize(struct bootstrap *bootstrap, long planned);
/* Both, of an empty one. */
void bootstrap_run(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                   int max_splats, const struct target *targets_by_thread, int threads);
/* Lets go of the paths; what is known of them stays. */
void bootstrap_deinit(struct bootstrap *bootstrap);
/* Systematic resampling in proportion to the target: seeds[chains] ascending. One uniform
 * u in [0,1) serves all. Seeds count from the first path on. Paths without a contribution
 * are never picked; if there is no other, the seeds are spread evenly. */
void bootstrap_select(const struct bootstrap *bootstrap, double u, long *seeds,
                      int chains);

/* To or from a checkpoint (base/pack.h): what is known of the paths, without the paths.
 */
void bootstrap_pack(struct pack *pack, struct bootstrap *bootstrap);

#endif
