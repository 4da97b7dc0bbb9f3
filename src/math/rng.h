#ifndef ETALON_MATH_RNG_H
#define ETALON_MATH_RNG_H

/* xoshiro256++ [Blackman and Vigna 2021], one stream for each (seed, purpose, index);
 * never one per thread, so that results do not depend on the number of threads. */

#include <stdint.h>

struct pack;

enum rng_purpose {
    RNG_BOOTSTRAP = 1, /* index: bootstrap path */
    RNG_CHAIN = 2,     /* index: chain */
    RNG_PIXEL = 3,     /* index: pixel and pass of pt and bdpt */
    RNG_SELECT = 4,    /* resampling of seeds */
    RNG_TEST = 5,
    RNG_PILOT = 6,     /* pilot of bdpt's light image */
    RNG_RESAMPLE = 7,  /* bootstrap of an analysis; index: replicate */
    RNG_COVERAGE = 8,  /* index: pixel of the alpha channel */
    RNG_GUESS = 9,     /* index: sample of a split's pilot */
    RNG_FILM = 10,     /* index: lens sub-path of a chain, the same for all chains */
    RNG_FEATURES = 11, /* index: pixel of albedo, normal and depth */
};

struct rng {
    uint64_t s[4];
};

void rng_init(struct rng *rng, uint64_t seed, enum rng_purpose purpose, uint64_t index);

static inline uint64_t rng_u64(struct rng *rng)
{
    uint64_t *s = rng->s;
    uint64_t sum = s[0] + s[3];
    uint64_t result = ((sum << 23) | (sum >> 41)) + s[0];
    uint64_t t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = (s[3] << 45) | (s[3] >> 19);
    return result;
}

/* Its position, to or from a checkpoint (base/pack.h). */
void rng_pack(struct pack *pack, struct rng *rng);

/* Uniform in [0,1), 53 bits. */
static inline double rng_double(struct rng *rng)
{
    return (double)(rng_u64(rng) >> 11) * 0x1p-53;
}

#endif
