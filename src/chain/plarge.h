#ifndef ETALON_CHAIN_PLARGE_H
#define ETALON_CHAIN_PLARGE_H

/* The rule for p_l as a pure function: statistics in, large-step probability and reason
 * out [Zsolnai13, sections 2.1 and 2.2]. */

#include "chain/startup.h"

enum plarge_branch {
    PLARGE_FLAT,     /* r >= 0.1: eta_s / (2 (eta_s - eta_l)) */
    PLARGE_FLAT_ONE, /* the same, cut off at 1: the formula exceeds 1 or eta_s <= eta_l */
    PLARGE_PEAKED,   /* r < 0.1: 0.25 */
    PLARGE_DARK,     /* eta_0 = 0, no light was found: p_l stays 0.5 */
    PLARGE_TOURS,    /* the least predicted error (chain/tours_curve.h) */
};

struct plarge {
    double p_l, p_l_lo, p_l_hi; /* 99 % interval; of both branches if unsure */
    /* Standard error, Student's t; 0 where the rule gives a constant. */
    double p_l_se, p_l_freedom;
    enum plarge_branch branch;
    bool unsure;      /* 0.1 lies inside the interval of r */
    char reason[320]; /* one sentence: branch, figures, interval */
};

struct plarge plarge_zsolnai2013(const struct statistics *s);
/* Its p_l alone, of rates that are known. */
double plarge_of_rates(double eta_s, double eta_l, double eta_0);
/* To or from a checkpoint (base/pack.h). */
void plarge_pack(struct pack *pack, struct plarge *plarge);

/* The p_l that the rule would give for rates eta_s and eta_l per counted state, that is,
 * per proposal that did not fail, as [Zeng19, Alg. 2] suggests. It is reported but not
 * used. [Zsolnai13, section 2.1] maximises the explored size M p_l eta_l sqrt(1 + (1 -
 * p_l) eta_s / (p_l eta_l)) for M proposals, and the cost is proportional to M: excluded
 * proposals are traced like all others. With phi the share of failures and eta' = eta /
 * (1 - phi) the rates per counted state, M p_l (1 - phi_l) counted large steps are
 * accepted with eta_l' and M (1 - p_l) (1 - phi_s) small ones with eta_s': products M p_l
 * eta_l and M (1 - p_l) eta_s as before, so the explored size is the same function of
 * p_l. The formula with eta' gives the best share of large steps among counted states,
 * which is not the probability with which they are proposed. r = eta_l/eta_0 is eta_l' in
 * both cases. */
double plarge_counted(const struct statistics *s);

#endif
