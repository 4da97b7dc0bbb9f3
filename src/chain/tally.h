#ifndef ETALON_CHAIN_TALLY_H
#define ETALON_CHAIN_TALLY_H

/* Counts of one chain, by kind of move. Plain sums, so that a span of the run is the
 * difference of two tallies; joined over chains in chain order. Plain doubles do: all
 * terms are >= 0, so n of them err by n 2^-53 of the sum at most, 1e-8 after 1e8
 * mutations of one chain. */

#include "image/contrib.h"

/* MOVE_TIMID: the second proposal of step_pf_exact. */
enum move { MOVE_SMALL, MOVE_LARGE, MOVE_TIMID, MOVES };

struct pack;

struct tally {
    int64_t proposed[MOVES];
    int64_t accepted[MOVES];
    int64_t nonzero[MOVES];   /* proposals with a non-zero contribution */
    double acceptance[MOVES]; /* sum of the acceptance probability a */
    double large_sum;         /* sum of the target over large proposals: b */
    double large_sum_squares, large_sum_fourths; /* and of its powers */
    int64_t failures[MOVES][FAILURES]; /* proposals without a contribution, by cause */
    int64_t excluded; /* proposals that are no states of the chain [Zeng19, 6.1] */
    int64_t black;    /* mutations that left a chain in a state without a contribution */
    int64_t final_failures; /* those that are, with a < TALLY_FINAL_FAILURE */
};

#define TALLY_FINAL_FAILURE 1e-6 /* [Zeng19, section 6.1] */

void tally_add(struct tally *into, const struct tally *from);
/* Accepted proposals of every kind: 0 of a chain that never moved. */
int64_t tally_moves(const struct tally *tally);
/* To or from a checkpoint (base/pack.h). */
void tally_pack(struct pack *pack, struct tally *tally);
struct tally tally_difference(const struct tally *later, const struct tally *earlier);

#endif
