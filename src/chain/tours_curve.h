#ifndef ETALON_CHAIN_TOURS_CURVE_H
#define ETALON_CHAIN_TOURS_CURVE_H

/* The predicted error of the whole render for every p_l. See tours_curve.c. */

#include "chain/tours.h"
#include "chain/tours_end.h"

/* Points of p among which a least error is looked for: from .1 to .9, as what more needs
 * to be certain. Less would gain little: with S and L the kernels of small and of large
 * steps, I - ((1 - p) S + p L) >= (1 - p) (I - S), so that the variance at p is at most
 * 1 / (1 - p) of that without large steps. But it can lose much: tours become longer
 * than the tapes, and their end is not seen. */
enum { TOURS_LEAST = 4, TOURS_CAP = TOURS_POINTS - 2 };

/* Chains of one normalisation b, at the end of the start. */
struct tours_part {
    const struct tours_sums *chains; /* [count] */
    int count;
    double share;   /* of all chains */
    double work[2]; /* mean work of a small and of a large step */
    double stay; /* mean of mutations at the brightest state of all independent paths, if
                    all steps were large */
    double recorded, planned; /* mutations of a chain on its tape, and in the whole run */
};

/* What a run knows besides. */
struct tours_run {
    double mutations;  /* of all chains in the whole run */
    double fixed_work; /* work besides, for each mutation */
    double p_zsolnai;  /* p_l by the published rule */
};

/* Parts of a run, and what is needed for their curves. */
struct tours_problem {
    const struct tours_part *parts;
    int count;
    const struct tours_run *run;
    struct tours_end **ends; /* [count]; NULL: the part's tapes are too short */
};

/* Which chains count: of `blocks` equal blocks of each part's chains only block `only`,
 * or all but `without`; -1: no such condition. */
struct tours_subset {
    int blocks, only, without;
};

struct tours_curve {
    double relmse[TOURS_POINTS]; /* predicted at the end, that of the chains */
    double cost[TOURS_POINTS];   /* work of a mutation */
    double spread[TOURS_POINTS]; /* of ln relmse, over what lies beyond the tapes' ends */
    double clipped;              /* share of the error that clipping took away */
    bool whole;                  /* errors and costs are finite and > 0 */
};

void tours_problem_init(struct tours_problem *problem, const struct tours_part *parts,
                        int count, const struct tours_run *run);
void tours_problem_deinit(struct tours_problem *problem);

void tours_curve_find(const struct tours_problem *problem,
                      const struct tours_subset *subset, struct tours_curve *out);
/* ln of error times cost, at a point, and at any p: linear in ln p between the points. */
double tours_curve_height(const struct tours_curve *curve, int point);
double tours_curve_height_at(const struct tours_curve *curve, double p);
/* Error times cost at p relative to that at q. */
double tours_regret(const struct tours_curve *curve, double p, double q);
/* Work of a mutation, which is linear in p. */
double tours_curve_cost(const struct tours_curve *curve, double p);

#endif
