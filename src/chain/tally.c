#include "chain/tally.h"

#include "base/pack.h"

/* into += sign * from */
static void combine(struct tally *into, const struct tally *from, int sign)
{
    for (int i = 0; i < MOVES; i++) {
        into->proposed[i] += sign * from->proposed[i];
        into->accepted[i] += sign * from->accepted[i];
        into->nonzero[i] += sign * from->nonzero[i];
        into->acceptance[i] += sign * from->acceptance[i];
        for (int j = 0; j < FAILURES; j++)
            into->failures[i][j] += sign * from->failures[i][j];
    }
    into->large_sum += sign * from->large_sum;
    into->large_sum_squares += sign * from->large_sum_squares;
    into->large_sum_fourths += sign * from->large_sum_fourths;
    into->excluded += sign * from->excluded;
    into->black += sign * from->black;
    into->final_failures += sign * from->final_failures;
}

void tally_add(struct tally *into, const struct tally *from)
{
    combine(into, from, 1);
}

int64_t tally_moves(const struct tally *tally)
{
    int64_t moves = 0;
    for (int move = 0; move < MOVES; move++)
        moves += tally->accepted[move];
    return moves;
}

struct tally tally_difference(const struct tally *later, const struct tally *earlier)
{
    struct tally d = *later;
    combine(&d, earlier, -1);
    return d;
}

void tally_pack(struct pack *pack, struct tally *tally)
{
    pack_int64s(pack, "proposed", tally->proposed, MOVES);
    pack_int64s(pack, "accepted", tally->accepted, MOVES);
    pack_int64s(pack, "nonzero", tally->nonzero, MOVES);
    pack_doubles(pack, "acceptance", tally->acceptance, MOVES);
    pack_double(pack, "large_sum", &tally->large_sum);
    pack_double(pack, "large_sum_squares", &tally->large_sum_squares);
    pack_double(pack, "large_sum_fourths", &tally->large_sum_fourths);
    for (int i = 0; i < MOVES; i++)
        pack_int64s(pack, "failures", tally->failures[i], FAILURES);
    pack_int64s(pack, "excluded", &tally->excluded, 1);
    pack_int64s(pack, "black", &tally->black, 1);
    pack_int64s(pack, "final_failures", &tally->final_failures, 1);
}
