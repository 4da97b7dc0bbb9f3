#ifndef ETALON_INTEGRATOR_MARKOV_SPLIT_PROBE_H
#define ETALON_INTEGRATOR_MARKOV_SPLIT_PROBE_H

/* Short chains of small steps alone, from which the variance of chains is predicted
 * (split_plan.c). */

#include "integrator/markov/markov_state.h"

#define PROBE_STEPS 96

/* A trajectory of small steps. */
struct split_probe {
    int group;
    int64_t seed; /* bootstrap path */
    int states;
    double rho[PROBE_STEPS + 1];
    float same[PROBE_STEPS + 1][PROBE_STEPS + 1]; /* k(x_i, x_j), j >= i */
    double accepted; /* mean acceptance probability of its steps */
    double work;     /* mean of a step */
};

struct split_probes {
    const struct markov *m;
    int count;
    struct split_probe *all; /* [count], owned by the caller: mem_free */
};

/* Numbers of probes in proportion to the brightness of the lengths. */
void split_probes_run(const struct markov *m, struct split_probes *probes);

#endif
