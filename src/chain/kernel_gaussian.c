/* Normal displacements, two at a time from a radius and an angle [BoxMuller58]. The angle
 * is drawn within a quarter turn about an axis; two more bits choose the quarter. */

#include "chain/kernel.h"
#include "chain/kernel_math.h"

#define PAIRS (KERNEL_BATCH / 2)

static void draw(const struct kernel *k, struct rng *rng, double d[KERNEL_BATCH])
{
    uint64_t bits[KERNEL_BATCH];
    kernel_random_bits(rng, bits, KERNEL_BATCH);
    double variance = k->sigma * k->sigma;
    for (int i = 0; i < PAIRS; i++) {
        /* Centres of 2^52 cells: never 0, symmetric about 1/2. */
        double u = kernel_uniform(bits[i]) + 0x1p-53;
        double v = kernel_uniform(bits[i + PAIRS]) + 0x1p-53;
        double radius = sqrt(2.0 * variance * kernel_minus_log(u));
        double along, across;
        kernel_cos_sin(v - 0.5, &along, &across);
        along = kernel_from_bits(kernel_bits(along) | (bits[i] << 63));
        uint64_t swap = -(bits[i + PAIRS] & 1);
        uint64_t a = kernel_bits(along), b = kernel_bits(across);
        uint64_t mixed = (a ^ b) & swap;
        d[i] = radius * kernel_from_bits(a ^ mixed);
        d[i + PAIRS] = radius * kernel_from_bits(b ^ mixed);
    }
}

const struct kernel_type kernel_gaussian = {
    .name = "gaussian",
    .draw = draw,
    .stable = true,
};
