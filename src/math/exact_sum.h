#ifndef ETALON_MATH_EXACT_SUM_H
#define ETALON_MATH_EXACT_SUM_H

/* Sums in 128-bit fixed point: exact and associative, so the same bits in any order and
 * for any division of a run into parts. A step is 2^-72 of the caller's unit; a value
 * beyond 2^46 units is clamped, so that 256 of them cannot overflow, and sums wrap. */

#include <math.h>
#include <stddef.h>
#include <stdint.h>

__extension__ typedef __int128 exact_sum;
__extension__ typedef unsigned __int128 exact_bits;

#define EXACT_BITS  72
#define EXACT_LIMIT 0x1p46 /* units */

static inline exact_sum exact_add(exact_sum a, exact_sum b)
{
    return (exact_sum)((exact_bits)a + (exact_bits)b);
}

/* The product with a whole number; wraps. */
static inline exact_sum exact_times(exact_sum a, int64_t factor)
{
    return (exact_sum)((exact_bits)a * (exact_bits)(exact_sum)factor);
}

/* A value in units, to the nearest step; a NaN is 0. Whole multiples of 2^-20 units and
 * the rest are converted one by one: a conversion of a double to 128 bits calls a
 * function. */
static inline exact_sum exact_of(double value)
{
    if (!(fabs(value) <= EXACT_LIMIT))
        value = isnan(value) ? 0.0 : copysign(EXACT_LIMIT, value);
    int64_t whole = (int64_t)(value * 0x1p16);
    double rest = (value - (double)whole * 0x1p-16) * 0x1p72; /* below 2^56, exact */
    return (exact_sum)((exact_bits)(exact_sum)whole << (EXACT_BITS - 16)) +
           (int64_t)(rest + copysign(0.5, rest));
}

/* In units, rounded once up to the last step of the sum of two doubles. */
static inline double exact_value(exact_sum sum)
{
    return (double)(int64_t)(sum >> 64) * 0x1p-8 + (double)(uint64_t)sum * 0x1p-72;
}

struct pack;

/* To or from a checkpoint (base/pack.h); sums over the parts of a run. */
void exact_pack(struct pack *pack, const char *name, exact_sum *sums, size_t count);

#endif
