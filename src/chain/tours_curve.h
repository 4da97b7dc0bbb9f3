#ifndef ETALON_CHAIN_TOURS_CURVE_H
#define ETALON_CHAIN_TOURS_CURVE_H

/* The rule `tours`: predicted error of the whole render for every p_l, and its minimum.
 * See tours_curve.c. */

#include "chain/plarge.h"
#include "chain/tours.h"

/* Chains of one normalisation b, at the end of the start. */
struct tours_part {
    const struct tours_sums *chains; /* [count] */
    int count;
    double share;             /* of all chains */
    double work[2];           /* mean work of a small and of a large step */
    double p0;                /* p_l of the start */
    double recorded, planned; /* mutations of a chain on its tape, and in the whole run */
};

/* What a run knows besides. */
struct tours_run {
    double mutations;  /* of all chains in the whole run */
    double fixed_work; /* work besides, for each mutation */
    double p_zsolnai;  /* p_l by the published rule */
};

struct tours_curve {
    double relmse[TOURS_POINTS]; /* predicted at the end, that of the chains */
    double cost[TOURS_POINTS];   /* work of a mutation */
};

struct tours_choice {
    bool found; /* false: too few tours, or no curve */
    struct tours_curve curve;
    double relmse;     /* at p_l */
    double halves;     /* greatest regret of one half's p_l on the other half's curve */
    double clipped;    /* share of the predicted error that clipping took away */
    double allocation; /* error times cost over that with shares by predicted variances */
    struct plarge plarge;
};

/* Error times cost at p relative to that at q, by interpolation. */
double tours_regret(const struct tours_curve *curve, double p, double q);

/* p_l for all parts together. */
void tours_choose(const struct tours_part *parts, int count, const struct tours_run *run,
                  struct tours_choice *out);

struct pack;
/* To or from a checkpoint (base/pack.h). */
void tours_choice_pack(struct pack *pack, struct tours_choice *choice);

#endif
