/* Normal displacements, two at a time from a radius and an angle [BoxMuller58]. The angle
 * is drawn within a quarter turn about an axis; two more bits choose the quarter. */

#include "chain/kernel.h"
#include "chain/kernel_math.h"

#define PAIRS (KERNEL_BATCH / 2)

static void draw(const struct kernel *k, struct rng *rng, double d[KERNEL_BATCH])
{
    uint64_t bits[KERNEL_BATCH];
    kernel_random_bits(rng, bits, KERNEL_BATCH);
    /* Three loops: sqrt may set errno, which would prevent the others from being
     * vectorised. The uniforms are midpoints of 2^52 cells: never 0, symmetric about 1/2.
     */
    double radius[PAIRS], scale = 2.0 * k->sigma * k->sigma;
    for (int i = 0; i < PAIRS; i++)
        radius[i] = scale * kernel_minus_log(kernel_uniform(bits[i]) + 0x1p-53);
    for (int i = 0; i < PAIRS; i++)
        radius[i] = sqrt(radius[i]);
    for (int i = 0; i < PAIRS; i++) {
        uint64_t other = bits[i + PAIRS];
        double along, across;
        kernel_cos_sin(kernel_uniform(other) + 0x1p-53 - 0.5, &along, &across);
        uint64_t a = kernel_bits(along) | (bits[i] << 63), b = kernel_bits(across);
        uint64_t swapped = (a ^ b) & -(other & 1);
        d[i] = radius[i] * kernel_from_bits(a ^ swapped);
        d[i + PAIRS] = radius[i] * kernel_from_bits(b ^ swapped);
    }
}

/* Log density of the wrapped normal distribution: the term of the nearest image of d,
 * plus log1p of the others relative to it; terms below 2^-60 of it are left out. */
static double log_density(const struct kernel *k, const double *d, int count)
{
    double half_precision = 0.5 / (k->sigma * k->sigma), sum = 0.0;
    for (int i = 0; i < count; i++) {
        double near = fabs(d[i] - floor(d[i] + 0.5)), others = 0.0;
        for (int n = 1; n * (n - 2.0 * near) * half_precision < 42.0; n++)
            others += exp(-n * (n - 2.0 * near) * half_precision) +
                      exp(-n * (n + 2.0 * near) * half_precision);
        sum -= near * near * half_precision;
        if (others > 0.0)
            sum += log1p(others);
    }
    return sum - count * k->log_norm;
}

const struct kernel_type kernel_gaussian = {
    .name = "gaussian",
    .draw = draw,
    .stable = true,
    .log_density = log_density,
};
