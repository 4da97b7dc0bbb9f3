#ifndef ETALON_BASE_PART_H
#define ETALON_BASE_PART_H

/* A part of a run: of its chains, or of its independent samples, those that one of
 * `count` processes computes. Every item belongs to exactly one part. */

#include <stdbool.h>
#include <stdint.h>

#define PARTS_MOST 65536

struct run_part {
    int index, count; /* index from 0; count 0: the whole run */
};

static inline bool part_is_whole(struct run_part part)
{
    return part.count == 0;
}

/* Chains go to the parts in turn: each part has its share of every path length and of
 * every replica. */
static inline bool part_owns_chain(struct run_part part, int chain)
{
    return part_is_whole(part) || chain % part.count == part.index;
}

/* Rows of passes go to the parts by Fibonacci hashing [Knuth98, section 6.4]: evenly in
 * every pass, and a row goes to other parts in other passes, so that without one of the
 * parts every pixel has about the same share of its samples. */
static inline bool part_owns_row(struct run_part part, long pass, long height, long row)
{
    uint64_t number = (uint64_t)pass * (uint64_t)height + (uint64_t)row;
    uint64_t place = number * UINT64_C(0x9e3779b97f4a7c15) >> 32;
    return part_is_whole(part) || (int)(place * (uint64_t)part.count >> 32) == part.index;
}

#endif
