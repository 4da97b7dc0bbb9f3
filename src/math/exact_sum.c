#include "math/exact_sum.h"

#include "base/pack.h"

#include <string.h>

#define CHUNK 512

/* Each sum as its lower and its upper word. */
static void pack_chunk(struct pack *pack, const char *name, exact_sum *sums, size_t count)
{
    int64_t words[2 * CHUNK] = {0};
    for (size_t i = 0; i < count; i++) {
        words[2 * i] = (int64_t)(uint64_t)sums[i];
        words[2 * i + 1] = (int64_t)(sums[i] >> 64);
    }
    pack_int64s(pack, name, words, 2 * count);
    if (!pack_reads(pack) || !pack_ok(pack))
        return;
    for (size_t i = 0; i < count; i++) {
        exact_bits bits = (exact_bits)(exact_sum)words[2 * i + 1] << 64;
        exact_sum read = (exact_sum)(bits | (uint64_t)words[2 * i]);
        sums[i] = pack_adds(pack) ? exact_add(sums[i], read) : read;
    }
}

void exact_pack(struct pack *pack, const char *name, exact_sum *sums, size_t count)
{
    for (size_t i = 0; i < count; i += CHUNK)
        pack_chunk(pack, name, sums + i, count - i < CHUNK ? count - i : CHUNK);
}
