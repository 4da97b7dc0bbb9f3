#include "chain/large_acceptance.h"

#include "base/pack.h"

#include <math.h>
#include <string.h>

/* Place of x in (0,1) among the bins: a whole number at the lower edge of each. Within an
 * octave it is linear in x. */
static double place_of(double x)
{
    int exponent;
    double mantissa = frexp(x, &exponent); /* [1/2, 1) */
    double octave = LARGE_ACCEPTANCE_OCTAVES - 1 + exponent;
    double place = 16.0 * (octave + 2.0 * mantissa - 1.0);
    return fmin(fmax(place, 0.0), nextafter(LARGE_ACCEPTANCE_BINS, 0.0));
}

void large_acceptance_build(struct large_acceptance *table, const double *targets,
                            long count)
{
    double most = 0.0;
    memset(table, 0, sizeof *table);
    table->count = (double)count;
    for (long i = 0; i < count; i++)
        most = fmax(most, targets[i]);
    frexp(most, &table->top);
    for (long i = 0; i < count; i++) {
        double x = ldexp(targets[i], -table->top);
        if (!(x > 0.0))
            continue;
        double *bin = table->below[(int)place_of(x) + 1];
        bin[0] += 1.0;
        bin[1] += x;
        bin[2] += x * x;
    }
    for (int i = 0; i < LARGE_ACCEPTANCE_BINS; i++)
        for (int k = 0; k < 3; k++)
            table->below[i + 1][k] += table->below[i][k];
}

void large_acceptance_at(const struct large_acceptance *table, double f, double *mean,
                         double *square)
{
    double x = ldexp(f, -table->top), place = place_of(x);
    const double *lo = table->below[(int)place], *hi = table->below[(int)place + 1];
    double part = place - (int)place, sums[3];
    for (int k = 0; k < 3; k++)
        sums[k] = lo[k] + part * (hi[k] - lo[k]);
    double brighter = table->below[LARGE_ACCEPTANCE_BINS][0] - sums[0];
    *mean = fmin((brighter + sums[1] / x) / table->count, 1.0);
    *square = fmin((brighter + sums[2] / (x * x)) / table->count, *mean);
}

void large_acceptance_pack(struct pack *pack, struct large_acceptance *table)
{
    pack_double(pack, "acceptance_paths", &table->count);
    pack_int(pack, "acceptance_top", &table->top, -2000, 2000);
    pack_doubles(pack, "acceptance_sums", table->below[0],
                 (size_t)3 * (LARGE_ACCEPTANCE_BINS + 1));
}
