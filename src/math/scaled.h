#ifndef ETALON_MATH_SCALED_H
#define ETALON_MATH_SCALED_H

/* Numbers beyond the range of doubles: products of many densities. value = m 2^e. A power
 * of two in the factors changes e alone, so that lengths in other units give the same
 * bits. */

#include <math.h>
#include <stdint.h>
#include <string.h>

struct scaled {
    double m;
    long e;
};

/* 2^e, for |e| <= 1000. */
static inline double scaled_power(long e)
{
    uint64_t bits = (uint64_t)(e + 0x3ff) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* x as m 2^e with m in [.5,1), as frexp has it, which takes several times as long. */
static inline struct scaled scaled(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int e = (int)(bits >> 52 & 0x7ff);
    double m;
    if (e == 0 || e == 0x7ff) { /* zero, subnormal, not finite */
        m = frexp(x, &e);
        return (struct scaled){m, x == 0.0 ? 0 : e};
    }
    bits = (bits & ~((uint64_t)0x7ff << 52)) | (uint64_t)0x3fe << 52;
    memcpy(&m, &bits, sizeof m);
    return (struct scaled){m, e - 0x3fe};
}

static inline struct scaled scaled_normal(struct scaled a)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.*): of weights that cannot be drawn */
    struct scaled b = scaled(a.m);
    return (struct scaled){b.m, b.m == 0.0 ? 0 : a.e + b.e};
}

static inline struct scaled scaled_by(struct scaled a, double factor)
{
    a.m *= factor;
    return a.m > 0x1p-200 && a.m < 0x1p200 ? a : scaled_normal(a);
}

static inline struct scaled scaled_mul(struct scaled a, struct scaled b)
{
    a = scaled_normal(a);
    b = scaled_normal(b);
    return (struct scaled){a.m * b.m, a.e + b.e};
}

static inline struct scaled scaled_div(struct scaled a, struct scaled b)
{
    a = scaled_normal(a);
    b = scaled_normal(b);
    return (struct scaled){a.m / b.m, a.e - b.e};
}

/* The quotient as a double; it may overflow to infinity, or to 0. */
static inline double scaled_ratio(struct scaled a, struct scaled b)
{
    struct scaled q = scaled_div(a, b);
    if (q.e < -1000 || q.e > 1000)
        return ldexp(q.m, q.e > 5000 ? 5000 : q.e < -5000 ? -5000 : (int)q.e);
    return q.m * scaled_power(q.e);
}

static inline double scaled_log(struct scaled a)
{
    a = scaled_normal(a);
    return log(a.m) + (double)a.e * 0.69314718055994530942;
}

#endif
