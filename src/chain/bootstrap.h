#ifndef ETALON_CHAIN_BOOTSTRAP_H
#define ETALON_CHAIN_BOOTSTRAP_H

/* Independent paths before the chains: b, eta_0 and seeds. */

#include "chain/target.h"

#include <stdint.h>

struct pack;

struct bootstrap {
    long count;
    double *targets; /* [count], target of each path, until bootstrap_deinit */
    /* [count], pixel of its first splat, -1 without one; until bootstrap_deinit. */
    int32_t *pixels;
    double b, b_se;         /* mean */
    double eta_0, eta_0_se; /* share of paths with a non-zero contribution */
    /* Effective number of seeds, (sum f)^2 / sum f^2 over the targets f [Kong92]: chains
     * that start at paths drawn in proportion to f are worth as much as this many chains
     * with distinct seeds. */
    double effective;
    long nonfinite; /* values or targets that were not finite, taken as 0 */
};

/* Adds `count` paths, numbered from `first` on; targets_by_thread[threads]. The numbers
 * of path i come from the stream (seed, RNG_BOOTSTRAP, i), in the order in which they are
 * asked for. The figures are not updated before bootstrap_summarize. */
void bootstrap_extend(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                      int max_splats, const struct target *targets_by_thread,
                      int threads);
/* Computes `effective` from all paths, but b and eta_0 from the first `planned` ones: if
 * paths are added because of what others found, the mean over all is biased. */
void bootstrap_summarize(struct bootstrap *bootstrap, long planned);
/* Both, for an empty bootstrap. */
void bootstrap_run(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                   int max_splats, const struct target *targets_by_thread, int threads);
/* Frees the paths; the figures stay. */
void bootstrap_deinit(struct bootstrap *bootstrap);
/* Systematic resampling in proportion to the targets: seeds[chains] ascending, numbered
 * from the first path. One uniform number u in [0,1) serves all seeds. Paths without a
 * contribution are never picked; if all are without, the seeds are spread evenly. */
void bootstrap_select(const struct bootstrap *bootstrap, double u, long *seeds,
                      int chains);

/* To or from a checkpoint (base/pack.h): the figures, without the paths. */
void bootstrap_pack(struct pack *pack, struct bootstrap *bootstrap);

#endif
