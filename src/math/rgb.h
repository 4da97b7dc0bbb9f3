#ifndef ETALON_MATH_RGB_H
#define ETALON_MATH_RGB_H

/* Linear Rec. 709 colour in doubles: reflectance, radiance, throughput. */

#include <math.h>
#include <stdbool.h>

struct rgb {
    double r, g, b;
};

static inline struct rgb rgb(double r, double g, double b)
{
    return (struct rgb){r, g, b};
}

static inline struct rgb rgb_grey(double v)
{
    return (struct rgb){v, v, v};
}

static inline struct rgb rgb_add(struct rgb a, struct rgb b)
{
    return (struct rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}

static inline struct rgb rgb_mul(struct rgb a, struct rgb b)
{
    return (struct rgb){a.r * b.r, a.g * b.g, a.b * b.b};
}

static inline struct rgb rgb_scale(struct rgb a, double s)
{
    return (struct rgb){a.r * s, a.g * s, a.b * s};
}

/* Rec. 709 luminance. */
static inline double rgb_luminance(struct rgb a)
{
    return 0.2126 * a.r + 0.7152 * a.g + 0.0722 * a.b;
}

static inline bool rgb_is_black(struct rgb a)
{
    return a.r == 0.0 && a.g == 0.0 && a.b == 0.0;
}

static inline bool rgb_is_finite(struct rgb a)
{
    return isfinite(a.r + a.g + a.b);
}

static inline double rgb_max(struct rgb a)
{
    return fmax(a.r, fmax(a.g, a.b));
}

#endif
