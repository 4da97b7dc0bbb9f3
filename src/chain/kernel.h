#ifndef ETALON_CHAIN_KERNEL_H
#define ETALON_CHAIN_KERNEL_H

/* Small steps of one number: symmetric, wrapped to [0,1). */

#include "math/rng.h"

#include <stdint.h>

struct kernel;

struct kernel_type {
    const char *name;
    /* out[i] = one small step from x[i]. */
    void (*step)(const struct kernel *k, struct rng *rng, const double *x, double *out,
                 int count);
    /* *x after `steps` >= 1 small steps: the same law as that many draws. */
    void (*catch_up)(const struct kernel *k, struct rng *rng, double *x, int64_t steps);
};

/* exponential [Kelemen02, section 4]: |d| = s2 exp(-log(s2/s1) u), s1 <= |d| <= s2;
 * gaussian: sd sigma, n missed steps are one jump of sigma sqrt(n). */
struct kernel {
    const struct kernel_type *type;
    double sigma, s1, s2;
    double log_ratio; /* log(s2/s1), set by kernel_init */
};

extern const struct kernel_type *const kernel_types[]; /* NULL-terminated */
const struct kernel_type *kernel_find(const char *name);
/* Zero means default: sigma .01, s1 1/1024, s2 1/64. */
void kernel_init(struct kernel *k, const struct kernel_type *type, double sigma,
                 double s1, double s2);

#endif
