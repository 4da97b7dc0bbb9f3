#ifndef ETALON_CHAIN_STARTUP_H
#define ETALON_CHAIN_STARTUP_H

/* The start: independent paths for b and seeds, then statistics of the first mutations
 * with standard errors from the spread between chains (DESIGN section 4). */

#include "chain/pss.h"
#include "chain/tally.h"
#include "chain/target.h"

struct bootstrap {
    long count;
    double *targets;        /* [count], scalar of each path, until they are let go */
    int32_t *pixels;        /* [count], of its first splat; -1 without one; as long */
    double b, b_se;         /* mean */
    double eta_0, eta_0_se; /* share of paths with a non-zero contribution */
    long nonfinite;         /* values or scalars that were not finite: taken as 0 */
};

/* Evaluates paths first..first+count-1; targets_by_thread[threads]. Path i's numbers come
 * from (seed, RNG_BOOTSTRAP, i), in the order they are asked for. */
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

struct statistics {
    double eta_s, eta_s_se; /* mean acceptance probability of small steps */
    double eta_l, eta_l_se; /* of large steps */
    double eta_0, eta_0_se; /* share of large proposals with non-zero contribution */
    double z_small;         /* share of small proposals with non-zero contribution */
    double eta_sl_cov;      /* covariance of the estimates of eta_s and eta_l */
    double eta_l0_cov;      /* and of eta_l and eta_0 */
    double freedom;         /* degrees of freedom of the standard errors */
    double r, r_se;         /* eta_l / eta_0, ratio estimator over chains */
    double r_lo, r_hi;      /* 99 % interval, t quantile; within [0,1] */
    double quantile;        /* the multiple of a standard error that makes 99 % */
    int64_t small, large;   /* proposals counted */
};

/* From one tally a chain (a span of its run); ratio estimators with the delta method;
 * chains are the independent units. A standard error that the data cannot tell (fewer
 * than two chains, no such proposals) is INFINITY. */
void statistics_measure(const struct tally *tallies, int chains, struct statistics *out);

/* To or from a checkpoint (base/pack.h). */
void statistics_pack(struct pack *pack, struct statistics *statistics);

/* The whole of parts that were measured apart (path lengths): means with the given
 * weights (>= 0; all 0: nothing is known), errors from within the parts; the degrees of
 * freedom are those of r [Satterthwaite46]. A part of weight 0 does not count. */
void statistics_join(const struct statistics *parts, const double *weights, int count,
                     struct statistics *out);

#endif
