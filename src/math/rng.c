#include "math/rng.h"

#include "base/pack.h"

/* Finalizer of splitmix64 [Steele, Lea and Flood 2014]: a bijection of 64 bits. */
static uint64_t mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/* Every step is invertible, so distinct (seed, purpose, index) never share a state; the
 * second round makes each word depend on all three. The constants are odd multiples of
 * 2^64 over the golden ratio. */
void rng_init(struct rng *rng, uint64_t seed, enum rng_purpose purpose, uint64_t index)
{
    const uint64_t golden = 0x9e3779b97f4a7c15U;
    uint64_t a = mix(seed + golden);
    uint64_t b = mix((uint64_t)purpose + 3 * golden + a);
    uint64_t c = mix(index + 5 * golden + b);
    a ^= mix(c + 7 * golden);
    b ^= mix(a + 9 * golden);
    uint64_t d = mix(a + b + c + 11 * golden);
    rng->s[0] = a;
    rng->s[1] = b;
    rng->s[2] = c;
    rng->s[3] = d ? d : 1; /* the all-zero state is a fixed point */
}

void rng_pack(struct pack *pack, struct rng *rng)
{
    pack_int64s(pack, "rng", (int64_t *)rng->s, 4);
}
