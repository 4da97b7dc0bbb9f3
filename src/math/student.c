#include "math/student.h"

#include <math.h>

#define TERMS_MOST  100000
#define NEWTON_MOST 2000
#define TINY        1e-300 /* stands in for a denominator that vanishes */

static double log_gamma(double x)
{
    int sign;
    return lgamma_r(x, &sign);
}

static double away_from_zero(double x)
{
    return fabs(x) < TINY ? TINY : x;
}

/* Coefficient m >= 1 of the fraction 1/(1+ d_1/(1+ d_2/(1+ ...))). */
static double coefficient(int m, double a, double b, double x)
{
    int half = m / 2;
    double k = half;
    if (m % 2 == 0)
        return k * (b - k) * x / ((a + 2.0 * k - 1.0) * (a + 2.0 * k));
    return -(a + k) * (a + b + k) * x / ((a + 2.0 * k) * (a + 2.0 * k + 1.0));
}

/* I_x(a,b) for x below its turning point, where the fraction converges fast; y = 1 - x
 * [AbramowitzStegun64, 26.5.8], [ThompsonBarnett86]. */
static double beta_fraction(double a, double b, double x, double y)
{
    if (!(x > 0.0))
        return 0.0;
    double c = 1.0, d = 0.0, value = 1.0;
    for (int m = 1; m < TERMS_MOST; m++) {
        double term = coefficient(m, a, b, x);
        d = 1.0 / away_from_zero(1.0 + term * d);
        c = away_from_zero(1.0 + term / c);
        value *= c * d;
        if (fabs(c * d - 1.0) < 1e-16)
            break;
    }
    double front = log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * log(x) +
                   b * log(y);
    return exp(front) / (a * value);
}

/* P(T > t) for t >= 0. */
static double upper(double t, double freedom)
{
    if (isinf(freedom))
        return 0.5 * erfc(t / sqrt(2.0));
    double square = t * t, a = 0.5 * freedom, b = 0.5;
    double x = isinf(square) ? 0.0 : freedom / (freedom + square);
    double y = isinf(square) ? 1.0 : square / (freedom + square);
    if (x < (a + 1.0) / (a + b + 2.0))
        return 0.5 * beta_fraction(a, b, x, y);
    return 0.5 - 0.5 * beta_fraction(b, a, y, x);
}

double student_tail(double t, double freedom)
{
    if (isnan(t) || !(freedom > 0.0))
        return (double)NAN;
    return t >= 0.0 ? upper(t, freedom) : 1.0 - upper(-t, freedom);
}

static double density(double t, double freedom)
{
    const double pi = 3.14159265358979323846;
    if (isinf(freedom))
        return exp(-0.5 * t * t) / sqrt(2.0 * pi);
    double front = log_gamma(0.5 * freedom + 0.5) - log_gamma(0.5 * freedom) -
                   0.5 * log(freedom * pi);
    return exp(front - 0.5 * (freedom + 1.0) * log1p(t * t / freedom));
}

double student_quantile(double p, double freedom)
{
    if (!(p >= 0.0 && p <= 1.0) || !(freedom > 0.0))
        return (double)NAN;
    if (p < 0.5)
        return -student_quantile(1.0 - p, freedom);
    double beyond = 1.0 - p, t = 0.0;
    if (beyond == 0.0)
        return (double)INFINITY;
    /* The tail is convex in t > 0: Newton from 0 rises to the root and never passes it.
     */
    for (int i = 0; i < NEWTON_MOST; i++) {
        double step = (upper(t, freedom) - beyond) / density(t, freedom);
        if (!(step > 1e-15 * t))
            break;
        t += step;
    }
    return t;
}
