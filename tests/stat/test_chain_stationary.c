/* Chains that start from exact samples of their target must have its law after any number
 * of steps. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/stat_test.h"
#include "support/toy_target.h"

#define SUBCELLS   (2 * TOY_CELLS)
#define SUM_CELLS  4
#define REPLICATES 20000
#define STEPS      25
#define LEVEL      stat_sidak(1e-3, 20)

/* Probability of S in quarter j. */
static double sum_share(const struct toy *toy, int j)
{
    if (toy->dims == 1)
        return 1.0 / SUM_CELLS;
    double a = 2.0 * TOY_PI * j / SUM_CELLS, b = 2.0 * TOY_PI * (j + 1) / SUM_CELLS;
    return 1.0 / SUM_CELLS + TOY_SWING * (sin(b) - sin(a)) / (2.0 * TOY_PI);
}

static double law_p_value(const struct toy *toy, const struct kernel_type *type,
                          double p_large)
{
    struct chain chain;
    toy_chain_init(&chain, type);
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {p_large, 1.0, ESTIMATOR_KELEMEN};
    struct target target = {toy_eval, (void *)(uintptr_t)toy};
    double observed[SUBCELLS * SUM_CELLS] = {0}, expected[SUBCELLS * SUM_CELLS];

    for (int i = 0; i < SUBCELLS * SUM_CELLS; i++)
        expected[i] = REPLICATES * toy_cell(i / SUM_CELLS / 2) /
                      (2 * TOY_CELLS * toy_integral()) * sum_share(toy, i % SUM_CELLS);
    for (uint64_t r = 0; r < REPLICATES; r++) {
        double x[TOY_MAX];
        toy_start(&chain, toy, 21, r);
        step_mh.advance(&chain, &params, &target, &films.sinks, STEPS);
        toy_state(&chain, toy, x);
        int s = toy->dims == 1 ? (int)(r % SUM_CELLS)
                               : (int)(SUM_CELLS * toy_sum(toy, x));
        observed[(int)(SUBCELLS * x[0]) * SUM_CELLS + s]++;
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
    return stat_chi2_p(observed, expected, SUBCELLS * SUM_CELLS);
}

static void check(int dims)
{
    const double p_large[] = {0.05, 0.5, 1.0};
    for (int t = 0; kernel_types[t]; t++) {
        for (int p = 0; p < 3; p++) {
            char what[80];
            snprintf(what, sizeof what, "%s, %d numbers, p_l %g", kernel_types[t]->name,
                     dims, p_large[p]);
            double value = law_p_value(&(struct toy){dims}, kernel_types[t], p_large[p]);
            assert_true(stat_ok(what, value, LEVEL));
        }
    }
}

static void one_number(void **state)
{
    (void)state;
    check(1);
}

static void two_numbers(void **state)
{
    (void)state;
    check(2);
}

static void eight_numbers(void **state)
{
    (void)state;
    check(8);
}

/* --- one-sided steps ---------------------------------------------------------------- */

/* A number of the connect stream says which stream they move: what the sample's t does in
 * multiplexed chains. Four times as many replicates: the boundary between the sides is
 * crossed seldom. */
#define SIDED_REPLICATES (4 * REPLICATES)

static void eval_sided(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    const struct toy toy = {TOY_MAX};
    const struct chain *chain = ctx;
    toy_eval((void *)(uintptr_t)&toy, numbers, out);
    if (out->count > 0)
        out->splats[0].t = pss_of(chain)->streams[PSS_CONNECT].proposed[0] < 0.5;
}

static enum pss_stream_id side_of(const struct contrib *sample)
{
    return sample->count > 0 && sample->splats[0].t == 1 ? PSS_LIGHT : PSS_CAMERA;
}

static double one_sided_p_value(const struct kernel_type *type)
{
    const struct toy toy = {TOY_MAX};
    struct chain chain;
    toy_chain_init(&chain, type);
    struct pss *pss = pss_of(&chain);
    kernel_init(&pss->kernel, type, 0.1, 1e-3, 0.25);
    pss->one_sided = 0.7;
    pss->find_side = side_of;
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {0.05, 1.0, ESTIMATOR_KELEMEN};
    struct target target = {eval_sided, &chain};
    double observed[2 * TOY_CELLS] = {0}, expected[2 * TOY_CELLS];

    for (int i = 0; i < 2 * TOY_CELLS; i++)
        expected[i] = SIDED_REPLICATES * toy_cell(i / 2) /
                      (2 * TOY_CELLS * toy_integral());
    for (uint64_t r = 0; r < SIDED_REPLICATES; r++) {
        double x[TOY_MAX];
        toy_start(&chain, &toy, 22, r);
        toy_state(&chain, &toy, x);
        pss->side = x[5] < 0.5 ? PSS_LIGHT : PSS_CAMERA;
        step_mh.advance(&chain, &params, &target, &films.sinks, STEPS);
        toy_state(&chain, &toy, x);
        observed[2 * (int)(TOY_CELLS * x[0]) + (x[5] < 0.5)]++;
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
    return stat_chi2_p(observed, expected, 2 * TOY_CELLS);
}

static void one_sided_steps(void **state)
{
    (void)state;
    for (int t = 0; kernel_types[t]; t++) {
        char what[80];
        snprintf(what, sizeof what, "%s, one-sided", kernel_types[t]->name);
        assert_true(stat_ok(what, one_sided_p_value(kernel_types[t]), LEVEL));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_number),
        cmocka_unit_test(two_numbers),
        cmocka_unit_test(eight_numbers),
        cmocka_unit_test(one_sided_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
