#include "math/student.h"

#include "math/beta.h"

#include <math.h>

#define NEWTON_MOST 2000

/* P(T > t) for t >= 0. */
static double upper(double t, double freedom)
{
    if (isinf(freedom))
        return 0.5 * erfc(t / sqrt(2.0));
    double square = t * t; /* [AbramowitzStegun64, 26.7.1] */
    double x = isinf(square) ? 0.0 : freedom / (freedom + square);
    double y = isinf(square) ? 1.0 : square / (freedom + square);
    return 0.5 * beta_regularised(0.5 * freedom, 0.5, x, y);
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
    double front = beta_log_gamma(0.5 * freedom + 0.5) - beta_log_gamma(0.5 * freedom) -
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

double student_freedom(double variance, double spread)
{
    return 2.0 * variance / spread * variance; /* [Satterthwaite46] */
}
