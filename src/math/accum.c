#include "math/accum.h"

#include "base/pack.h"

#include <assert.h>
#include <math.h>

void accum_add(struct accum *a, double x)
{
    double sum = a->sum + x;
    if (fabs(a->sum) >= fabs(x))
        a->compensation += (a->sum - sum) + x;
    else
        a->compensation += (x - sum) + a->sum;
    a->sum = sum;
}

double accum_value(const struct accum *a)
{
    /* Past an infinity the compensation is NaN, the sum still right. */
    return isfinite(a->sum) ? a->sum + a->compensation : a->sum;
}

void welford_add(struct welford *w, double x)
{
    w->count += 1.0;
    double d = x - w->mean;
    w->mean += d / w->count;
    w->m2 += d * (x - w->mean);
}

/* [Chan, Golub and LeVeque 1979]. */
void welford_merge(struct welford *into, const struct welford *from)
{
    if (from->count == 0.0)
        return;
    double count = into->count + from->count;
    double d = from->mean - into->mean;
    into->m2 += from->m2 + d * d * (into->count * from->count / count);
    into->mean += d * (from->count / count);
    into->count = count;
}

double welford_variance(const struct welford *w)
{
    return w->count < 2.0 ? 0.0 : w->m2 / (w->count - 1.0);
}

double welford_se(const struct welford *w)
{
    return w->count < 2.0 ? 0.0 : sqrt(welford_variance(w) / w->count);
}

static_assert(sizeof(struct welford) == 3 * sizeof(double), "an array of doubles");

void welford_pack(struct pack *pack, const char *name, struct welford *w, size_t count)
{
    pack_doubles(pack, name, (double *)w, 3 * count);
}
