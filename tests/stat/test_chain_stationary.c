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
#define LEVEL      stat_sidak(1e-3, 18)

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_number),
        cmocka_unit_test(two_numbers),
        cmocka_unit_test(eight_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
