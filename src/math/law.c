#include "math/law.h"

#include <float.h>
#include <math.h>

#define TERMS 400

/* Newton on the lower tail from a start on the outer side, where it cannot overshoot:
 * the log of the tail is concave. */
double law_normal_quantile(double p)
{
    double tail = p < 0.5 ? p : 1.0 - p, x = -sqrt(fmax(-2.0 * log(2.0 * tail), 0.0));
    for (int i = 0; i < 60; i++) {
        double value = 0.5 * erfc(-x * M_SQRT1_2);
        double slope = exp(-0.5 * x * x) / sqrt(2.0 * M_PI);
        double step = value / slope * log(value / tail);
        x -= step;
        if (fabs(step) < 4.0 * DBL_EPSILON * (1.0 + fabs(x)))
            break;
    }
    return p < 0.5 ? x : -x;
}

/* The continued fraction of the incomplete beta function, by Lentz's method; converges
 * fast for x < (a + 1) / (a + b + 2). */
static double beta_fraction(double a, double b, double x)
{
    double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
    d = 1.0 / (fabs(d) < DBL_MIN ? DBL_MIN : d);
    double value = d;
    for (int m = 1; m <= TERMS; m++) {
        double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
        double before = value;
        for (int half = 0; half < 2; half++) {
            double term = half ? odd : even;
            d = 1.0 + term * d;
            c = 1.0 + term / c;
            d = 1.0 / (fabs(d) < DBL_MIN ? DBL_MIN : d);
            c = fabs(c) < DBL_MIN ? DBL_MIN : c;
            value *= d * c;
        }
        if (fabs(value - before) <= DBL_EPSILON * fabs(value))
            break;
    }
    return value;
}

/* Regularised; y = 1 - x, given apart so that neither end loses digits. */
static double beta_incomplete(double a, double b, double x, double y)
{
    if (x <= 0.0)
        return 0.0;
    if (y <= 0.0)
        return 1.0;
    double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log(y));
    if (x < (a + 1.0) / (a + b + 2.0))
        return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, y) / b;
}

double law_f_upper(double x, double above, double below)
{
    if (!(x > 0.0))
        return 1.0;
    if (isinf(x))
        return 0.0;
    double whole = below + above * x;
    return beta_incomplete(0.5 * below, 0.5 * above, below / whole, above * x / whole);
}

/* T^2 follows F with (1, freedom). Bisection: called once a picture. */
double law_t_quantile(double share, double freedom)
{
    double low = 0.0, high = 1.0;
    while (law_f_upper(high * high, 1.0, freedom) > 1.0 - share)
        high *= 2.0;
    for (int i = 0; i < 100; i++) {
        double middle = 0.5 * (low + high);
        if (law_f_upper(middle * middle, 1.0, freedom) > 1.0 - share)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}
