#include "chain/tally.h"

void tally_add(struct tally *into, const struct tally *from)
{
    for (int i = 0; i < MOVES; i++) {
        into->proposed[i] += from->proposed[i];
        into->accepted[i] += from->accepted[i];
        into->nonzero[i] += from->nonzero[i];
        into->acceptance[i] += from->acceptance[i];
    }
    into->large_sum += from->large_sum;
    into->large_sum_squares += from->large_sum_squares;
}

struct tally tally_difference(const struct tally *later, const struct tally *earlier)
{
    struct tally d = *later;
    for (int i = 0; i < MOVES; i++) {
        d.proposed[i] -= earlier->proposed[i];
        d.accepted[i] -= earlier->accepted[i];
        d.nonzero[i] -= earlier->nonzero[i];
        d.acceptance[i] -= earlier->acceptance[i];
    }
    d.large_sum -= earlier->large_sum;
    d.large_sum_squares -= earlier->large_sum_squares;
    return d;
}
