#include "math/dist.h"

#include "base/mem.h"
#include "math/accum.h"
#include "math/warp.h"

/* Sums the weights divided by the power of two above the largest (exact, and no overflow
 * on the way) into cdf[]; returns that power's exponent in *exponent. False if the
 * weights do not make a distribution. */
static bool accumulate(const double *weights, int count, double *cdf, int *exponent)
{
    double max = 0.0;
    for (int i = 0; i < count; i++) {
        if (!(weights[i] >= 0.0) || isinf(weights[i]))
            return false;
        max = fmax(max, weights[i]);
    }
    frexp(max, exponent);
    struct accum sum = {0};
    cdf[0] = 0.0;
    for (int i = 0; i < count; i++) {
        accum_add(&sum, ldexp(weights[i], -*exponent));
        cdf[i + 1] = fmax(cdf[i], accum_value(&sum));
    }
    return max > 0.0;
}

static void build_guide(struct dist *dist)
{
    dist->buckets = 1;
    while (dist->buckets < dist->count && dist->buckets < 1 << 24)
        dist->buckets *= 2;
    dist->guide = mem_alloc((size_t)dist->buckets + 1, sizeof(int32_t));
    int i = 0;
    for (int k = 0; k < dist->buckets; k++) {
        while (dist->cdf[i + 1] <= (double)k / dist->buckets)
            i++;
        dist->guide[k] = i;
    }
    dist->guide[dist->buckets] = dist->count - 1;
}

bool dist_build(struct dist *dist, const double *weights, int count)
{
    *dist = (struct dist){0};
    if (count < 1)
        return false;
    double *cdf = mem_alloc((size_t)count + 1, sizeof(double));
    int exponent = 0;
    bool good = accumulate(weights, count, cdf, &exponent);
    double total = cdf[count], sum = ldexp(total, exponent);
    if (!good || isinf(sum)) {
        mem_free(cdf);
        return false;
    }
    for (int i = 1; i <= count; i++)
        cdf[i] /= total; /* exactly 1 from the last positive weight on */
    *dist = (struct dist){.count = count, .sum = sum, .cdf = cdf};
    build_guide(dist);
    return true;
}

void dist_deinit(struct dist *dist)
{
    mem_free(dist->cdf);
    mem_free(dist->guide);
    *dist = (struct dist){0};
}

double dist_pdf(const struct dist *dist, int index)
{
    return dist->cdf[index + 1] - dist->cdf[index];
}

int dist_sample(const struct dist *dist, double u, double *probability, double *rest)
{
    const double *cdf = dist->cdf;
    int bucket = (int)(u * dist->buckets); /* exact: a power of two */
    int lo = dist->guide[bucket], hi = dist->guide[bucket + 1] + 1;
    while (hi - lo > 1) { /* cdf[lo] <= u, and u < cdf[hi] */
        int mid = lo + (hi - lo) / 2;
        if (cdf[mid] <= u)
            lo = mid;
        else
            hi = mid;
    }
    *probability = cdf[lo + 1] - cdf[lo];
    if (rest) {
        double x = (u - cdf[lo]) / *probability;
        *rest = x < WARP_BELOW_ONE ? x : WARP_BELOW_ONE;
    }
    return lo;
}

bool dist_invert(const struct dist *dist, int index, double rest, double *u)
{
    double lo = dist->cdf[index], hi = dist->cdf[index + 1];
    *u = warp_within(lo, hi, rest);
    return lo < hi && rest >= 0.0 && rest < 1.0;
}

size_t dist_bytes(const struct dist *dist)
{
    if (!dist->cdf)
        return 0;
    return ((size_t)dist->count + 1) * sizeof *dist->cdf +
           ((size_t)dist->buckets + 1) * sizeof *dist->guide;
}
