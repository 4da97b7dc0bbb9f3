#ifndef ETALON_INTEGRATOR_MLT_NUMBERS_H
#define ETALON_INTEGRATOR_MLT_NUMBERS_H

/* A small step of primary sample space as a mutation of paths: the path is handed to one
 * of its techniques, drawn by the balance heuristic's weights, as the numbers with which
 * this makes it [Bitterli18]; all these numbers move by the kernel of small steps
 * [Kelemen02]; and the path that the technique makes of them is the proposal.
 *
 * With P_t the density of technique t and p = sum P_t, a path x is handed to t with
 * probability P_t(x)/p(x). The step is symmetric in the numbers, so that
 *     P_t(x) K_t(x->y) = P_t(y) K_t(y->x),
 * and q(y->x)/q(x->y) = p(x)/p(y), whichever t it was. Relative to the law of independent
 * paths the log ratio is 0. */

#include "chain/kernel.h"
#include "chain/state.h"
#include "path/full_path.h"

/* Displacements drawn in advance. */
struct mlt_numbers {
    int left;
    double displacements[KERNEL_BATCH];
};

void mlt_numbers_drop(struct mlt_numbers *batch);
/* To or from a checkpoint. */
void mlt_numbers_pack(struct pack *pack, struct mlt_numbers *batch);

/* Evaluates the proposal from x into *out; the path becomes space->sampled. Where the way
 * back does not exist, *out is empty, as FAILURE_INVERSE. */
void mlt_numbers_propose(struct mlt_numbers *batch, const struct kernel *kernel,
                         struct rng *rng, struct path_space *space,
                         const struct full_path *x, struct contrib *out);

#endif
