#ifndef ETALON_CHAIN_PLARGE_H
#define ETALON_CHAIN_PLARGE_H

/* The pure rule: statistics in, large-step probability and reason out
 * [Zsolnai13, sections 2.1 and 2.2]. */

#include "chain/startup.h"

enum plarge_branch {
    PLARGE_FLAT,     /* r >= 0.1: eta_s / (2 (eta_s - eta_l)) */
    PLARGE_FLAT_ONE, /* the same, but that exceeds 1 or eta_s <= eta_l: 1 */
    PLARGE_PEAKED,   /* r < 0.1: 0.25 */
    PLARGE_DARK,     /* eta_0 = 0: nothing was found; 0.5 kept */
};

struct plarge {
    double p_l, p_l_lo, p_l_hi; /* 99 % interval; of both branches if unsure */
    enum plarge_branch branch;
    bool unsure;      /* 0.1 lies inside the interval of r */
    char reason[320]; /* one sentence: branch, figures, interval */
};

struct plarge plarge_zsolnai2013(const struct statistics *s);

#endif
