#include "math/law.h"

#include "math/beta.h"

#include <float.h>
#include <math.h>

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

double law_f_upper(double x, double above, double below)
{
    if (!(x > 0.0))
        return 1.0;
    if (isinf(x))
        return 0.0;
    double whole = below + above * x; /* [AbramowitzStegun64, 26.6.2] */
    return beta_regularised(0.5 * below, 0.5 * above, below / whole, above * x / whole);
}
