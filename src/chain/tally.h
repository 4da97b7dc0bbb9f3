#ifndef ETALON_CHAIN_TALLY_H
#define ETALON_CHAIN_TALLY_H

/* Counts of one chain, by move. Plain sums, so that a span of the run is the
 * difference of two tallies; joined over chains in chain order. Plain doubles do: all
 * terms are >= 0, so n of them err by n 2^-53 of the sum at most, 1e-8 after 1e8
 * mutations of one chain. */

#include "image/contrib.h"

/* Rows of every state's table of moves (chain/state.h). Large and local moves are first
 * proposals. */
enum move {
    MOVE_LARGE,        /* independent of the current state; its share is p_l */
    MOVE_SECOND_STAGE, /* second proposal of step_pf_exact */
    MOVE_LOCAL,        /* the first of the others */
    MOVES_MOST = 8,
};

struct pack;

/* [MOVES_MOST]: by row of the table; all 0 where nothing was proposed. */
struct tally {
    int64_t proposed[MOVES_MOST];
    int64_t accepted[MOVES_MOST];
    int64_t nonzero[MOVES_MOST];   /* proposals with a non-zero contribution */
    double acceptance[MOVES_MOST]; /* sum of the acceptance probability a */
    double large_sum;              /* sum of the target over large proposals: b */
    double large_sum_squares, large_sum_fourths; /* and of its powers */
    /* Proposals without a contribution, by cause. */
    int64_t failures[MOVES_MOST][FAILURES];
    int64_t excluded;       /* proposals that are no states of the chain [Zeng19, 6.1] */
    int64_t zero_states;    /* mutations that left a chain where the target is 0 */
    int64_t final_failures; /* those that are, with a < TALLY_FINAL_FAILURE */
};

#define TALLY_FINAL_FAILURE 1e-6 /* [Zeng19, section 6.1] */

void tally_add(struct tally *into, const struct tally *from);
/* Accepted proposals of every move: 0 of a chain that never moved. */
int64_t tally_moves(const struct tally *tally);
/* Sums of one of the arrays above: over local moves; over these and large steps. */
int64_t tally_local(const int64_t counts[MOVES_MOST]);
int64_t tally_first(const int64_t counts[MOVES_MOST]);
double tally_local_acceptance(const struct tally *tally);
/* To or from a checkpoint (base/pack.h). names: the table of moves; what moves without a
 * name have is not in it. */
void tally_pack(struct pack *pack, struct tally *tally,
                const char *const names[MOVES_MOST]);
struct tally tally_difference(const struct tally *later, const struct tally *earlier);

#endif
