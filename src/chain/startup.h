#ifndef ETALON_CHAIN_STARTUP_H
#define ETALON_CHAIN_STARTUP_H

/* Statistics of chains with standard errors from independent units: all chains that
 * started at the same bootstrap path are one unit. */

#include "chain/tally.h"

struct pack;

/* *_freedom: degrees of freedom of Student's t for that error [Satterthwaite46]. A
 * standard error that cannot be estimated is INFINITY, with 1. */
struct statistics {
    double eta_s, eta_s_se, eta_s_freedom; /* mean acceptance probability, small steps */
    double eta_l, eta_l_se, eta_l_freedom; /* of large steps */
    /* Share of large proposals with non-zero contribution. */
    double eta_0, eta_0_se, eta_0_freedom;
    double z_small;            /* the same of small proposals */
    double r, r_se, r_freedom; /* eta_l / eta_0 */
    double r_lo, r_hi;         /* 99 % interval, within [0,1] */
    double q, q_se, q_freedom; /* eta_l / eta_s, which decides p_l */
    /* Accepted first proposals, and first proposals without a contribution, over all
     * first proposals; every chain has the same weight. */
    double acceptance, acceptance_se, acceptance_freedom;
    double failure_rate, failure_rate_se, failure_rate_freedom;
    double seeds;         /* number of distinct paths at which chains started */
    int64_t small, large; /* proposals counted */
};

/* Chains with a common normalisation b. */
struct statistics_part {
    const struct tally *tallies; /* [chains], counts of a part of each chain's run */
    /* [chains], bootstrap path at which each started, equal ones adjacent; NULL: all
     * differ. */
    const int64_t *seeds;
    int chains;
    double b, b_variance, b_freedom; /* weight of the part >= 0, and its error */
};

/* eta_s, eta_l and eta_0 of the whole are means over the parts weighted by b; those of a
 * part are ratios of sums over its chains. See startup.c for the errors. */
void statistics_measure(const struct statistics_part *parts, int count,
                        struct statistics *out);

/* The error that p_l, which the start decided, adds to acceptance [0] and failure rate
 * [1] of the run. */
struct statistics_mixing {
    double
        slope[2]; /* derivatives by the start's q, which has the same units as the run */
    double variance[2], freedom; /* variance that does not come from q */
};

/* Statistics of a run whose p_l was decided by its start, with the same parts and chains:
 * the errors of acceptance and failure rate include that of p_l. */
void statistics_measure_after(const struct statistics_part *parts,
                              const struct statistics_part *start, int count,
                              const struct statistics_mixing *mixing,
                              struct statistics *out);

/* To or from a checkpoint (base/pack.h). */
void statistics_pack(struct pack *pack, struct statistics *statistics);

#endif
