#include "analysis/resample.h"

#include "math/rng.h"

#include <stdint.h>

/* Streams of halvings lie apart from those of replicates. */
#define HALVES UINT64_C(1000000000)
#define GROUPS UINT64_C(16)

static size_t below(struct rng *rng, size_t n)
{
    return (size_t)(rng_double(rng) * (double)n);
}

void resample_counts(size_t replicate, int group, size_t n, double *counts)
{
    struct rng rng;
    rng_init(&rng, RESAMPLE_SEED, RNG_RESAMPLE, replicate * GROUPS + (uint64_t)group);
    for (size_t i = 0; i < n; i++)
        counts[i] = 0.0;
    for (size_t i = 0; i < n; i++)
        counts[below(&rng, n)] += 1.0;
}

/* Selection sampling: each value is taken with the share that is still wanted. */
void resample_halves(size_t way, size_t n, int *side)
{
    struct rng rng;
    rng_init(&rng, RESAMPLE_SEED, RNG_RESAMPLE, HALVES * GROUPS + way);
    size_t wanted = n / 2;
    for (size_t i = 0; i < n; i++) {
        side[i] = below(&rng, n - i) < wanted;
        wanted -= (size_t)side[i];
    }
}
