#ifndef ETALON_TESTS_SUPPORT_STIFF_TARGET_H
#define ETALON_TESTS_SUPPORT_STIFF_TARGET_H

/* Targets that chains hardly mix on, of which everything is known: steps in x0, one pixel
 * each, where all other numbers lie below `side`; 0 elsewhere. */

#include "support/film_sinks.h"
#include "math/accum.h"

#define STIFF_MAX_DIMS  40
#define STIFF_MAX_CELLS 16
#define STIFF_CHAINS    64

struct stiff {
    int dims;
    double side;
    int cells;
    double heights[STIFF_MAX_CELLS];
    double s1, s2; /* of the exponential kernel; 0: its own */
};

/* One island of volume 1e-6 in 40 dimensions, and steps that are too small to leave it.
 */
static const struct stiff stiff_island = {40,         0.70170382867038, 2,
                                          {1.0, 3.0}, 0x1p-16,          0x1p-10};
/* Two islands, of which one has 1e-4 of the other's probability. */
static const struct stiff stiff_two_islands = {4, 0.5, 8, {1.0, 0, 0, 0, 1e-4}, 0.0, 0.0};
/* Plateaus in turn, 1e12 to 1. */
static const struct stiff stiff_plateaus = {
    2, 1.0, 8, {1.0, 1e-12, 1.0, 1e-12, 1.0, 1e-12, 1.0, 1e-12}, 0.0, 0.0};

static inline double stiff_volume(const struct stiff *stiff)
{
    return pow(stiff->side, stiff->dims - 1);
}

/* Mean of the target over the cube where x0 lies in cell i, over all of x0. */
static inline double stiff_cell(const struct stiff *stiff, int i)
{
    return stiff_volume(stiff) * stiff->heights[i] / stiff->cells;
}

static inline double stiff_integral(const struct stiff *stiff)
{
    double sum = 0.0;
    for (int i = 0; i < stiff->cells; i++)
        sum += stiff_cell(stiff, i);
    return sum;
}

static inline void stiff_fill(const struct stiff *stiff, const double *x,
                              struct contrib *out)
{
    int cell = (int)(stiff->cells * x[0]);
    contrib_clear(out);
    contrib_add(out, cell, rgb_grey(stiff->heights[cell]), 0, 0);
}

static inline void stiff_eval(void *ctx, const struct numbers *numbers,
                              struct contrib *out)
{
    const struct stiff *stiff = ctx;
    double x[STIFF_MAX_DIMS];
    for (int i = 0; i < stiff->dims; i++) {
        x[i] = *ustream_take(numbers->connect, i, 1);
        if (i > 0 && !(x[i] < stiff->side)) {
            contrib_clear(out);
            return;
        }
    }
    stiff_fill(stiff, x, out);
}

/* How chains move and what counts as the picture. */
struct stiff_setup {
    const char *name;
    const struct step_type *step;
    const struct kernel_type *kernel; /* a gaussian one is s2/4 wide */
    enum estimator estimator;
};

static const struct stiff_setup stiff_mh = {"mh", &step_mh, &kernel_exponential,
                                            ESTIMATOR_KELEMEN};
static const struct stiff_setup stiff_plain = {"mh plain", &step_mh, &kernel_exponential,
                                               ESTIMATOR_PLAIN};
static const struct stiff_setup stiff_counted = {"counted", &step_mh, &kernel_gaussian,
                                                 ESTIMATOR_KELEMEN};
static const struct stiff_setup stiff_exact = {"pf exact", &step_pf_exact,
                                               &kernel_gaussian, ESTIMATOR_KELEMEN};

static inline void stiff_chain_init(struct chain *chain, const struct stiff *stiff,
                                    const struct stiff_setup *setup)
{
    const int capacity[PSS_STREAMS] = {1, 1, STIFF_MAX_DIMS};
    struct kernel kernel;
    kernel_init(&kernel, setup->kernel, 0.25 * stiff->s2, stiff->s1, stiff->s2);
    pss_chain_init(chain, capacity, 1, &kernel);
}

/* Puts the chain at an exact sample, with streams of its own. */
static inline void stiff_start(struct chain *chain, const struct stiff *stiff,
                               uint64_t seed, uint64_t index)
{
    double x[STIFF_MAX_DIMS];
    rng_init(&chain->rng, seed, RNG_TEST, index);
    double u = rng_double(&chain->rng) * stiff_integral(stiff);
    int cell = 0;
    while (cell < stiff->cells - 1 && u >= stiff_cell(stiff, cell))
        u -= stiff_cell(stiff, cell++);
    pss_reset(pss_of(chain));
    for (int i = 0; i < stiff->dims; i++) {
        double v = rng_double(&chain->rng);
        x[i] = i == 0 ? (cell + v) / stiff->cells : v * stiff->side;
        pss_of(chain)->streams[PSS_CONNECT].current[i] = x[i];
        pss_of(chain)->streams[PSS_CONNECT].stamp[i] = 0;
    }
    pss_drop_batches(pss_of(chain));
    stiff_fill(stiff, x, chain->current);
    chain->tally = (struct tally){0};
    chain->pending_weight = 0.0;
}

struct stiff_outcome {
    struct welford cell[STIFF_MAX_CELLS]; /* estimates of stiff_cell, over chains */
    double values[STIFF_MAX_CELLS][STIFF_CHAINS];
    struct tally tallies[STIFF_CHAINS], all;
};

/* Independent chains, each from an exact sample, b known. */
static inline void stiff_run(const struct stiff *stiff, const struct stiff_setup *setup,
                             double p_large, long mutations, struct stiff_outcome *out)
{
    double b = stiff_integral(stiff);
    struct chain chain;
    struct chain_params params = {p_large, b, setup->estimator};
    struct target target = {stiff_eval, (void *)(uintptr_t)stiff};
    struct film_sinks films;
    film_sinks_create(&films, stiff->cells, setup->estimator, false);
    *out = (struct stiff_outcome){0};
    stiff_chain_init(&chain, stiff, setup);
    for (int i = 0; i < STIFF_CHAINS; i++) {
        film_clear(films.chain);
        film_clear(films.large);
        stiff_start(&chain, stiff, 31, (uint64_t)i);
        setup->step->advance(&chain, &params, &target, &films.sinks, mutations);
        chain_flush(&chain, &params, &films.sinks);
        for (int j = 0; j < stiff->cells; j++) {
            double sum = film_value(films.chain, j).g + film_value(films.large, j).g;
            out->values[j][i] = sum * b / (double)mutations;
            welford_add(&out->cell[j], out->values[j][i]);
        }
        out->tallies[i] = chain.tally;
        tally_add(&out->all, &chain.tally);
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

#endif
