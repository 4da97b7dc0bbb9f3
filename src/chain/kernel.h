#ifndef ETALON_CHAIN_KERNEL_H
#define ETALON_CHAIN_KERNEL_H

/* Small steps of one number: a symmetric displacement, wrapped to [0,1). Displacements do
 * not depend on the state, so they are drawn in batches by vector code and used one by
 * one. */

#include "math/rng.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define KERNEL_BATCH 64

struct kernel;

struct kernel_type {
    const char *name;
    /* Draws KERNEL_BATCH independent displacements with the distribution of one small
     * step. */
    void (*draw)(const struct kernel *k, struct rng *rng, double d[KERNEL_BATCH]);
    /* The sum of n displacements has the distribution of one, times sqrt(n). If false,
     * missed steps are drawn one by one; that never costs more than drawing them when
     * they were made. */
    bool stable;
    /* Sum over d[count] of the log density of a small step that moves a number by d[i],
     * including all wraps around the circle. NULL: no second stage, because where the
     * density is 0 a failed step cannot be reversed. */
    double (*log_density)(const struct kernel *k, const double *d, int count);
};

/* Widths of small steps [Kelemen02, section 4], and of the Gaussian kernel. */
#define KERNEL_S1    (1.0 / 1024.0)
#define KERNEL_S2    (1.0 / 64.0)
#define KERNEL_SIGMA 0.01

/* Width of a small step over that of a second-stage step. */
#define KERNEL_SECOND_STAGE 10

/* exponential [Kelemen02, section 4]: |d| = s2 exp(-log(s2/s1) u), s1 < |d| <= s2;
 * gaussian: sd sigma. */
struct kernel {
    const struct kernel_type *type;
    double sigma, s1, s2;
    /* Set by kernel_init: log(s2/s1), and log(sigma sqrt(2 pi)). */
    double log_ratio, log_norm;
    /* A second-stage step is a small step divided by this: KERNEL_SECOND_STAGE, or 1 for
     * kernels without a second stage. The caller may set another value. */
    int second_stage;
};

extern const struct kernel_type kernel_exponential, kernel_gaussian;
extern const struct kernel_type *const kernel_types[];   /* NULL-terminated */
const struct kernel_type *kernel_find(const char *name); /* NULL if there is none */
/* Zero means one of those widths. 0 < sigma, 0 < s1 <= s2. */
void kernel_init(struct kernel *k, const struct kernel_type *type, double sigma,
                 double s1, double s2);

/* x - floor(x) of a tiny negative x rounds to 1, which is the same point as 0. */
static inline double kernel_wrap(double x)
{
    double y = x - floor(x);
    return y < 1.0 ? y : 0.0;
}

#endif
