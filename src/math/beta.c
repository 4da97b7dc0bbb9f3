#include "math/beta.h"

#include <float.h>
#include <math.h>

#define TERMS_MOST 100000
#define TINY       1e-300 /* stands in for a denominator that vanishes */

double beta_log_gamma(double x)
{
    int sign;
    return lgamma_r(x, &sign);
}

static double away_from_zero(double x)
{
    return fabs(x) < TINY ? TINY : x;
}

/* Coefficient m >= 1 of the fraction 1/(1+ d_1/(1+ d_2/(1+ ...)))
 * [AbramowitzStegun64, 26.5.8]. */
static double coefficient(int m, double a, double b, double x)
{
    int half = m / 2;
    double k = half;
    if (m % 2 == 0)
        return k * (b - k) * x / ((a + 2.0 * k - 1.0) * (a + 2.0 * k));
    return -(a + k) * (a + b + k) * x / ((a + 2.0 * k) * (a + 2.0 * k + 1.0));
}

/* I_x(a,b) for x below its turning point, where the fraction converges fast; summed
 * forwards [ThompsonBarnett86]. */
static double fraction(double a, double b, double x, double y)
{
    if (!(x > 0.0))
        return 0.0;
    double c = 1.0, d = 0.0, value = 1.0;
    for (int m = 1; m < TERMS_MOST; m++) {
        double term = coefficient(m, a, b, x);
        d = 1.0 / away_from_zero(1.0 + term * d);
        c = away_from_zero(1.0 + term / c);
        value *= c * d;
        if (fabs(c * d - 1.0) <= DBL_EPSILON)
            break;
    }
    double front = beta_log_gamma(a + b) - beta_log_gamma(a) - beta_log_gamma(b) +
                   a * log(x) + b * log(y);
    return exp(front) / (a * value);
}

double beta_regularised(double a, double b, double x, double y)
{
    if (x < (a + 1.0) / (a + b + 2.0))
        return fraction(a, b, x, y);
    return 1.0 - fraction(b, a, y, x); /* [AbramowitzStegun64, 26.5.2] */
}
