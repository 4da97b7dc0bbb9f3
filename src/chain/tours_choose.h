#ifndef ETALON_CHAIN_TOURS_CHOOSE_H
#define ETALON_CHAIN_TOURS_CHOOSE_H

/* The rule `tours`: the p_l of the least predicted error, and whether to trust it. See
 * tours_choose.c. */

#include "chain/plarge.h"
#include "chain/tours_curve.h"

/* The rule wants at least so many chains. */
#define TOURS_CHAINS_FEW 16

struct tours_choice {
    bool found; /* false: too few tours, or no curve */
    struct tours_curve curve;
    double relmse;     /* at p_l */
    double halves;     /* greatest regret of one half's p_l on the other half's curve */
    double expected;   /* regret of p_l, by the jackknife over blocks of chains */
    double allocation; /* error times cost over that with shares by predicted variances */
    struct plarge plarge; /* unsure: not to be used, for the reason that it gives */
};

/* p_l for all parts together. */
void tours_choose(const struct tours_part *parts, int count, const struct tours_run *run,
                  struct tours_choice *out);

/* Why the choice is not to be used, as a clause; "" if it is. */
const char *tours_doubt(const struct tours_choice *choice);
/* Whether a longer start would make the choice better. */
bool tours_wants_more(const struct tours_choice *choice);

struct pack;
/* To or from a checkpoint (base/pack.h). */
void tours_choice_pack(struct pack *pack, struct tours_choice *choice);

#endif
