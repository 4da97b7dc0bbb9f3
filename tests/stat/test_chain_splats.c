/* Pictures of chains against a known one: both estimators, a wrong b0, and a p_l that
 * changes on the way. Chains start from exact samples, so every estimate is unbiased and
 * replicates are tested by t. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/stat_test.h"
#include "support/toy_target.h"

#define REPLICATES 2000
#define MUTATIONS  500 /* of each of the two phases */
#define LEVEL      stat_sidak(1e-3, 6 * TOY_CELLS)

static const double p_phases[] = {0.5, 0.2};

struct setup {
    const struct kernel_type *kernel;
    enum estimator estimator;
    double b0_over_b;
};

/* One replicate: pixel = N/M (b chain + b0 large), green channel. */
static void picture(const struct setup *setup, struct chain *chain,
                    const struct film_sinks *films, uint64_t index,
                    double pixels[TOY_CELLS])
{
    struct toy toy = {3};
    struct target target = {toy_eval, &toy};
    double b = toy_integral(), b0 = setup->b0_over_b * b;
    film_clear(films->chain);
    film_clear(films->large);
    toy_start(chain, &toy, 41, index);
    for (int phase = 0; phase < 2; phase++) {
        struct chain_params params = {p_phases[phase], b0, setup->estimator};
        step_mh.advance(chain, &params, &target, &films->sinks, MUTATIONS);
        chain_flush(chain, &params, &films->sinks);
    }
    for (int i = 0; i < TOY_CELLS; i++)
        pixels[i] = TOY_CELLS / (2.0 * MUTATIONS) *
                    (b * film_value(films->chain, i).g +
                     b0 * film_value(films->large, i).g);
}

static void check(const char *what, const struct setup *setup)
{
    static double pixels[TOY_CELLS][REPLICATES];
    struct chain chain;
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, setup->estimator, false);
    toy_chain_init(&chain, setup->kernel);
    for (uint64_t r = 0; r < REPLICATES; r++) {
        double one[TOY_CELLS];
        picture(setup, &chain, &films, r, one);
        for (int i = 0; i < TOY_CELLS; i++)
            pixels[i][r] = one[i];
    }
    for (int i = 0; i < TOY_CELLS; i++) {
        /* Pixel i = N * the integral of the green channel over cell i. */
        double exact = toy_color(i, toy_steps[i]).g;
        char text[80];
        snprintf(text, sizeof text, "%s, %s, pixel %d", what, setup->kernel->name, i);
        assert_true(stat_ok(text, stat_mean_p(pixels[i], REPLICATES, exact), LEVEL));
    }
    assert_int_equal(films.chain->saturated + films.large->saturated, 0);
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

static void plain(void **state)
{
    (void)state;
    check("plain", &(struct setup){&kernel_exponential, ESTIMATOR_PLAIN, 0.8});
    check("plain", &(struct setup){&kernel_gaussian, ESTIMATOR_PLAIN, 1.0});
}

static void kelemen(void **state)
{
    (void)state;
    check("kelemen", &(struct setup){&kernel_exponential, ESTIMATOR_KELEMEN, 1.0});
    check("kelemen", &(struct setup){&kernel_gaussian, ESTIMATOR_KELEMEN, 1.0});
}

static void kelemen_is_exact_for_a_wrong_b0(void **state)
{
    (void)state;
    check("b0 = .8 b", &(struct setup){&kernel_exponential, ESTIMATOR_KELEMEN, 0.8});
    check("b0 = 3 b", &(struct setup){&kernel_exponential, ESTIMATOR_KELEMEN, 3.0});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain),
        cmocka_unit_test(kelemen),
        cmocka_unit_test(kelemen_is_exact_for_a_wrong_b0),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
