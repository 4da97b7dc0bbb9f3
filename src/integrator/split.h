#ifndef ETALON_INTEGRATOR_SPLIT_H
#define ETALON_INTEGRATOR_SPLIT_H

/* The integrand in two parts: a share for chains, the rest for independent samples
 * [Bitterli19]. See split.c for the estimator and why it is unbiased. */

#include "image/contrib.h"
#include "path/dims.h"

/* Which part renders the paths of a length. */
enum split_only { SPLIT_BOTH, SPLIT_CHAINS, SPLIT_PASSES };

struct split {
    /* [pixels], 1 / sqrt(I_j^2 + e^2), I_j a guess of the picture; with them the splats
     * of a sample are relative to their pixels. Emission units. */
    float *inverse;
    double unit;           /* brightness of the guess: targets are unit * rho * s(rho) */
    double floor, ceiling; /* c and W; c: INFINITY leaves all to independent samples */
    /* Chains sample one technique at a time: samples of all techniques are split
     * technique by technique, each times the number of techniques of its length. */
    bool by_technique;
    int techniques[DIMS_MAX_DEPTH + 1]; /* with by_technique */
    /* By the chain's length, 0: all. A length that the bootstrap did not find, or that no
     * chain has, is rendered by one part alone. */
    enum split_only only[DIMS_MAX_DEPTH + 1];
    /* Share of the rest that the chains' large steps estimate; passes estimate the
     * others. */
    double large[DIMS_MAX_DEPTH + 1];
};

/* s(rho), the share of chains. */
static inline double split_share(const struct split *split, double rho)
{
    double s = rho / (rho + split->floor);
    return rho > split->ceiling ? s * (split->ceiling / rho) : s;
}

/* rho of a sample, one factor for all of its splats. */
double split_relative(const struct split *split, const struct contrib *sample);

/* A sample of a chain of that length: leaves its share s F, sets the target and `rest`.
 */
void split_for_chain(const struct split *split, int length, struct contrib *sample);
/* A sample of the passes: leaves (1 - s) (1 - large) F. */
void split_for_passes(const struct split *split, struct contrib *sample);

#endif
