#ifndef ETALON_CHAIN_STARTUP_H
#define ETALON_CHAIN_STARTUP_H

/* Statistics of chains with standard errors from units that are independent: the chains
 * that began at one path of the bootstrap, together (DESIGN section 4). */

#include "chain/tally.h"

struct pack;

/* Every *_freedom is the degrees of freedom of Student's law of that error
 * [Satterthwaite46]. A standard error that the data cannot tell is INFINITY, with 1. */
struct statistics {
    double eta_s, eta_s_se, eta_s_freedom; /* mean acceptance probability, small steps */
    double eta_l, eta_l_se, eta_l_freedom; /* of large steps */
    /* Share of large proposals with non-zero contribution. */
    double eta_0, eta_0_se, eta_0_freedom;
    double z_small;            /* the same of small proposals */
    double r, r_se, r_freedom; /* eta_l / eta_0 */
    double r_lo, r_hi;         /* 99 % interval, within [0,1] */
    double q, q_se, q_freedom; /* eta_l / eta_s: what decides p_l */
    /* Moves, and proposals without a contribution, over proposals of stage one: of all
     * chains alike, whatever their weights. */
    double acceptance, acceptance_se, acceptance_freedom;
    double failure_rate, failure_rate_se, failure_rate_freedom;
    double seeds;         /* distinct paths that chains began at */
    int64_t small, large; /* proposals counted */
};

/* Chains with a normalisation of their own, and that. */
struct statistics_part {
    const struct tally *tallies; /* [chains], a span of each chain's run */
    const int64_t *seeds; /* [chains], paths that they began at, equal ones adjacent;
                             NULL: all differ */
    int chains;
    double b, b_variance, b_freedom; /* weight of the part >= 0, and its error */
};

/* eta_s, eta_l and eta_0 are means over the parts weighted by b, those of a part ratios
 * of sums over its chains. See startup.c for the errors. */
void statistics_measure(const struct statistics_part *parts, int count,
                        struct statistics *out);

/* What the error of p_l, which the start decided, brings into acceptance [0] and failure
 * rate [1] of the run. */
struct statistics_mixing {
    double slope[2]; /* derivatives by the start's q, whose units are those of the run */
    double variance[2], freedom; /* what is not told by q, as a variance */
};

/* The same of a run whose p_l was set by its start, of the same parts and chains: errors
 * of acceptance and failure rate hold that of p_l. */
void statistics_measure_after(const struct statistics_part *parts,
                              const struct statistics_part *start, int count,
                              const struct statistics_mixing *mixing,
                              struct statistics *out);

/* To or from a checkpoint (base/pack.h). */
void statistics_pack(struct pack *pack, struct statistics *statistics);

#endif
