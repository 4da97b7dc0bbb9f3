#ifndef ETALON_CHAIN_KERNEL_MATH_H
#define ETALON_CHAIN_KERNEL_MATH_H

/* Elementary functions without branches or calls, so that a loop over them becomes vector
 * code, and with plain products and sums only, so that every machine gets the same bits.
 * Truncated series of the functions themselves; relative errors as stated. */

#include "math/rng.h"

#include <stdint.h>
#include <string.h>

#define KERNEL_LN2 0.69314718055994530942
#define KERNEL_PI  3.14159265358979323846

static inline uint64_t kernel_bits(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double kernel_from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Uniform in [0,1) from the upper 52 bits; the lower 12 are free for other use. */
static inline double kernel_uniform(uint64_t bits)
{
    return kernel_from_bits((bits >> 12) | UINT64_C(0x3ff0000000000000)) - 1.0;
}

/* 2^x for |x| < 1000; relative error < 1e-12. */
static inline double kernel_exp2(double x)
{
    const double shift = 0x1.8p52; /* the sum's low bits hold x rounded to an integer */
    double shifted = x + shift;
    double y = (x - (shifted - shift)) * KERNEL_LN2; /* |y| <= ln(2)/2 */
    double y2 = y * y, y4 = y2 * y2;
    double low = (1.0 + y) + y2 * (1.0 / 2.0 + y * (1.0 / 6.0));
    double mid = (1.0 / 24.0 + y * (1.0 / 120.0)) +
                 y2 * (1.0 / 720.0 + y * (1.0 / 5040.0));
    double high = (1.0 / 40320.0 + y * (1.0 / 362880.0)) + y2 * (1.0 / 3628800.0);
    double power = kernel_from_bits((kernel_bits(shifted) + 1023) << 52);
    return (low + y4 * (mid + y4 * high)) * power;
}

/* -ln x for normal x in (0,1); relative error < 1e-13. */
static inline double kernel_minus_log(double x)
{
    /* x = 2^e m with m in [sqrt(1/2), sqrt(2)): the offset moves the cut there. */
    const uint64_t offset = UINT64_C(0x3ff0000000000000) - UINT64_C(0x3fe6a09e667f3bcd);
    uint64_t bits = kernel_bits(x) + offset;
    uint64_t exponent = bits >> 52; /* e + 1023 */
    double m = kernel_from_bits((bits & UINT64_C(0xfffffffffffff)) +
                                UINT64_C(0x3fe6a09e667f3bcd));
    /* The exponent as a double, by way of the bits of 2^52 + exponent. */
    double e = kernel_from_bits(exponent | UINT64_C(0x4330000000000000)) - 0x1p52;
    double s = (m - 1.0) / (m + 1.0); /* ln m = 2 artanh s, |s| < .172 */
    double z = s * s, z2 = z * z, z4 = z2 * z2;
    double low = (1.0 / 3.0 + z * (1.0 / 5.0)) + z2 * (1.0 / 7.0 + z * (1.0 / 9.0));
    double high = (1.0 / 11.0 + z * (1.0 / 13.0)) + z2 * (1.0 / 15.0 + z * (1.0 / 17.0));
    double series = z * (low + z4 * high);
    return (1023.0 - e) * KERNEL_LN2 - 2.0 * (s + s * series);
}

/* Cosine and sine of pi/2 * r for |r| <= 1/2; absolute error < 1e-13. */
static inline void kernel_cos_sin(double r, double *cosine, double *sine)
{
    double x = r * (KERNEL_PI / 2.0);
    double z = x * x;
    double c = 1.0 / 479001600.0 - z * (1.0 / 87178291200.0);
    c = -1.0 / 3628800.0 + z * c;
    c = 1.0 / 40320.0 + z * c;
    c = -1.0 / 720.0 + z * c;
    c = 1.0 / 24.0 + z * c;
    *cosine = 1.0 + z * (-1.0 / 2.0 + z * c);
    double s = -1.0 / 39916800.0 + z * (1.0 / 6227020800.0);
    s = 1.0 / 362880.0 + z * s;
    s = -1.0 / 5040.0 + z * s;
    s = 1.0 / 120.0 + z * s;
    s = -1.0 / 6.0 + z * s;
    *sine = x + x * z * s;
}

/* The generator stays in registers for the whole batch. */
static inline void kernel_random_bits(struct rng *rng, uint64_t *bits, int count)
{
    struct rng local = *rng;
    for (int i = 0; i < count; i++)
        bits[i] = rng_u64(&local);
    *rng = local;
}

#endif
