/* |d| = s2 exp(-log(s2/s1) u) with a random sign [Kelemen02, section 4]. */

#include "chain/kernel.h"
#include "chain/kernel_math.h"

#include <stddef.h>

static void draw(const struct kernel *k, struct rng *rng, double d[KERNEL_BATCH])
{
    uint64_t bits[KERNEL_BATCH];
    kernel_random_bits(rng, bits, KERNEL_BATCH);
    double slope = -k->log_ratio / KERNEL_LN2, s2 = k->s2;
    for (int i = 0; i < KERNEL_BATCH; i++) {
        double size = s2 * kernel_exp2(slope * kernel_uniform(bits[i]));
        d[i] = kernel_from_bits(kernel_bits(size) | (bits[i] << 63));
    }
}

const struct kernel_type kernel_exponential = {
    .name = "exponential",
    .draw = draw,
    .stable = false,
    .log_density = NULL,
};
