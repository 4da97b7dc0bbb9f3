#ifndef ETALON_CHAIN_KERNEL_H
#define ETALON_CHAIN_KERNEL_H

/* Small steps of one number: a symmetric displacement, wrapped to [0,1). Displacements do
 * not depend on the state, so they are drawn in batches (vector code) and spent one by
 * one. */

#include "math/rng.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define KERNEL_BATCH 64

struct kernel;

struct kernel_type {
    const char *name;
    /* KERNEL_BATCH independent displacements, each of the law of one small step. */
    void (*draw)(const struct kernel *k, struct rng *rng, double d[KERNEL_BATCH]);
    /* The sum of n displacements has the law of one, times sqrt(n). If not, missed steps
     * are drawn one by one, which never costs more than stepping every time. */
    bool stable;
    /* Sum over d[count] of the log of the density of one small step that moves a number
     * by d[i], any number of times round the circle. NULL: no second stage, for where
     * this density is 0 a failed step cannot be undone. */
    double (*log_density)(const struct kernel *k, const double *d, int count);
};

/* How many times narrower than a small step one of the second stage is (DESIGN section
 * 3). */
#define KERNEL_SECOND_STAGE 10

/* exponential [Kelemen02, section 4]: |d| = s2 exp(-log(s2/s1) u), s1 < |d| <= s2;
 * gaussian: sd sigma. */
struct kernel {
    const struct kernel_type *type;
    double sigma, s1, s2;
    /* Set by kernel_init: log(s2/s1), and log(sigma sqrt(2 pi)). */
    double log_ratio, log_norm;
    /* A second-stage step is a small one divided by this: KERNEL_SECOND_STAGE, or 1 where
     * there is none. The caller may set another. */
    int second_stage;
};

extern const struct kernel_type kernel_exponential, kernel_gaussian;
extern const struct kernel_type *const kernel_types[];   /* NULL-terminated */
const struct kernel_type *kernel_find(const char *name); /* NULL if there is none */
/* Zero means default: sigma .01, s1 1/1024, s2 1/64. 0 < sigma, 0 < s1 <= s2. */
void kernel_init(struct kernel *k, const struct kernel_type *type, double sigma,
                 double s1, double s2);

/* x - floor(x) of a tiny negative x rounds to 1, which is the same point as 0. */
static inline double kernel_wrap(double x)
{
    double y = x - floor(x);
    return y < 1.0 ? y : 0.0;
}

#endif
