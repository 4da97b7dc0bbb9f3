#include "chain/tally.h"

#include "base/pack.h"

/* into += sign * from. Most rows of the table are empty. */
static void combine(struct tally *into, const struct tally *from, int sign)
{
    for (int i = 0; i < MOVES_MOST; i++) {
        if (from->proposed[i] == 0)
            continue;
        into->proposed[i] += sign * from->proposed[i];
        into->accepted[i] += sign * from->accepted[i];
        into->nonzero[i] += sign * from->nonzero[i];
        into->acceptance[i] += sign * from->acceptance[i];
        into->work[i] += sign * from->work[i];
        for (int j = 0; j < FAILURES; j++)
            into->failures[i][j] += sign * from->failures[i][j];
    }
    into->large_sum += sign * from->large_sum;
    into->large_sum_squares += sign * from->large_sum_squares;
    into->large_sum_fourths += sign * from->large_sum_fourths;
    into->excluded += sign * from->excluded;
    into->zero_states += sign * from->zero_states;
    into->final_failures += sign * from->final_failures;
}

void tally_add(struct tally *into, const struct tally *from)
{
    combine(into, from, 1);
}

int64_t tally_moves(const struct tally *tally)
{
    int64_t moves = 0;
    for (int move = 0; move < MOVE_JUMP; move++)
        moves += tally->accepted[move];
    return moves;
}

struct tally tally_difference(const struct tally *later, const struct tally *earlier)
{
    struct tally d = *later;
    combine(&d, earlier, -1);
    return d;
}

int64_t tally_small(const int64_t counts[MOVES_MOST])
{
    int64_t sum = 0;
    for (int move = MOVE_LOCAL; move < MOVE_JUMP; move++)
        sum += counts[move];
    return sum;
}

int64_t tally_local(const int64_t counts[MOVES_MOST])
{
    return tally_small(counts) + counts[MOVE_JUMP] + counts[MOVE_STAY];
}

int64_t tally_first(const int64_t counts[MOVES_MOST])
{
    return counts[MOVE_LARGE] + tally_local(counts);
}

int64_t tally_paths(const struct tally *tally)
{
    int64_t paths = tally->proposed[MOVE_JUMP];
    for (int move = 0; move < MOVES_MOST; move++)
        paths += tally->proposed[move];
    return paths;
}

double tally_small_acceptance(const struct tally *tally)
{
    double sum = 0.0;
    for (int move = MOVE_LOCAL; move < MOVE_JUMP; move++)
        sum += tally->acceptance[move];
    return sum;
}

static void pack_move(struct pack *pack, struct tally *tally, int move, const char *name)
{
    pack_int64s(pack, name, &tally->proposed[move], 1);
    pack_int64s(pack, "accepted", &tally->accepted[move], 1);
    pack_int64s(pack, "nonzero", &tally->nonzero[move], 1);
    pack_double(pack, "acceptance", &tally->acceptance[move]);
    pack_double(pack, "work", &tally->work[move]);
    pack_int64s(pack, "failures", tally->failures[move], FAILURES);
}

void tally_pack(struct pack *pack, struct tally *tally,
                const char *const names[MOVES_MOST])
{
    for (int move = 0; move < MOVES_MOST; move++)
        if (names[move])
            pack_move(pack, tally, move, names[move]);
    pack_double(pack, "large_sum", &tally->large_sum);
    pack_double(pack, "large_sum_squares", &tally->large_sum_squares);
    pack_double(pack, "large_sum_fourths", &tally->large_sum_fourths);
    pack_int64s(pack, "excluded", &tally->excluded, 1);
    pack_int64s(pack, "zero_states", &tally->zero_states, 1);
    pack_int64s(pack, "final_failures", &tally->final_failures, 1);
}
