#ifndef ETALON_CHAIN_TALLY_H
#define ETALON_CHAIN_TALLY_H

/* Counts of one chain, by move. They are plain sums, so the counts of a part of a run are
 * the difference of two tallies; tallies are added in the order of chains. Plain doubles
 * suffice: all terms are >= 0, so n terms have a relative error of n 2^-53 at most, 1e-8
 * after 1e8 mutations. */

#include "image/contrib.h"

/* Rows of every state's table of moves (chain/state.h). Large and local moves are first
 * proposals. */
enum move {
    MOVE_LARGE, /* independent of the current state; proposed with probability p_l */
    MOVE_SECOND_STAGE, /* second proposal of step_pf_exact */
    MOVE_LOCAL,        /* first of the local moves */
    /* The last of them keep the path, so they are no small steps: eta_s is without them
     * (chain/pss_jump.h). */
    MOVE_JUMP = 8, /* other numbers of the same path */
    MOVE_STAY = 9, /* a jump that drew the technique that the path has: nothing changes */
    MOVES_MOST,
};

static inline bool move_keeps_path(int move)
{
    return move >= MOVE_JUMP;
}

struct pack;

/* [MOVES_MOST]: by row of the table; all 0 where nothing was proposed. */
struct tally {
    int64_t proposed[MOVES_MOST];
    int64_t accepted[MOVES_MOST];
    int64_t nonzero[MOVES_MOST];   /* proposals with a non-zero contribution */
    double acceptance[MOVES_MOST]; /* sum of the acceptance probability a */
    double work[MOVES_MOST]; /* sum of what proposals cost; see state_type.tallies_work */
    double
        large_sum; /* sum of the targets of large proposals, from which b is estimated */
    double large_sum_squares, large_sum_fourths; /* sums of their powers */
    /* Proposals without a contribution, by cause. */
    int64_t failures[MOVES_MOST][FAILURES];
    int64_t
        excluded; /* proposals not counted as states of the chain [Zeng19, section 6.1] */
    int64_t zero_states;    /* mutations after which the target is 0 */
    int64_t final_failures; /* proposals with a < TALLY_FINAL_FAILURE */
};

#define TALLY_FINAL_FAILURE 1e-6 /* [Zeng19, section 6.1] */

void tally_add(struct tally *into, const struct tally *from);
/* Accepted proposals of all moves; 0 if the chain never moved. */
int64_t tally_moves(const struct tally *tally);
/* Sums of one of these arrays over small steps, that is local moves but those that keep
 * the path; over local moves; over local and large moves. */
int64_t tally_small(const int64_t counts[MOVES_MOST]);
int64_t tally_local(const int64_t counts[MOVES_MOST]);
int64_t tally_first(const int64_t counts[MOVES_MOST]);
/* Paths traced: a jump (but not one that stays) traces that of the state again. */
int64_t tally_paths(const struct tally *tally);
double tally_small_acceptance(const struct tally *tally);
/* To or from a checkpoint (base/pack.h). names: the table of moves; what moves without a
 * name have is not in it. */
void tally_pack(struct pack *pack, struct tally *tally,
                const char *const names[MOVES_MOST]);
struct tally tally_difference(const struct tally *later, const struct tally *earlier);

#endif
