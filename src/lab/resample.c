#include "lab/resample.h"

#include "math/rng.h"

/* Streams of halvings lie apart from those of replicates. */
#define HALVES 1000000000U
#define GROUPS 16U

static size_t below(struct rng *rng, size_t n)
{
    return (size_t)(rng_double(rng) * (double)n);
}

void resample_counts(size_t replicate, int group, size_t n, double *counts)
{
    struct rng rng;
    rng_init(&rng, RESAMPLE_SEED, RNG_RESAMPLE,
             (uint64_t)replicate * GROUPS + (uint64_t)group);
    for (size_t i = 0; i < n; i++)
        counts[i] = 0.0;
    for (size_t i = 0; i < n; i++)
        counts[below(&rng, n)] += 1.0;
}

/* Selection sampling: each value is taken with the share that is still wanted. */
void resample_halves(size_t way, size_t n, int *side)
{
    struct rng rng;
    rng_init(&rng, RESAMPLE_SEED, RNG_RESAMPLE, HALVES * GROUPS + (uint64_t)way);
    size_t wanted = n / 2;
    for (size_t i = 0; i < n; i++) {
        side[i] = below(&rng, n - i) < wanted;
        wanted -= (size_t)side[i];
    }
}
