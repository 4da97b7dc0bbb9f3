#include "import/illuminant.h"

#include <math.h>

#define FIRST 300 /* nm */
#define STEP  10

static const double d65[] = {
    0.0341,  3.2945,  20.236,  37.0535, 39.9488, 44.9117, 46.6383, 52.0891, 49.9755,
    54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
    115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046, 100.0,
    96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
    80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856, 75.087,
    63.5927, 46.4182, 66.8054, 63.3828, 64.304,  59.4519, 51.959,  57.4406, 60.3125};

#define LAST (FIRST + STEP * ((int)(sizeof d65 / sizeof d65[0]) - 1))

double illuminant_d65(double lambda)
{
    if (!(lambda >= FIRST && lambda < LAST))
        return lambda == LAST ? d65[sizeof d65 / sizeof d65[0] - 1] : 0.0;
    double at = (lambda - FIRST) / STEP;
    int i = (int)floor(at);
    return d65[i] + (at - i) * (d65[i + 1] - d65[i]);
}
