/* Kernels: the elementary functions against libm, the table, the range of a step. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/kernel.h"
#include "chain/kernel_math.h"

static void functions_match_libm(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int i = 0; i < 200000; i++) {
        double x = 40.0 * (rng_double(&rng) - 0.5);
        assert_true(fabs(kernel_exp2(x) / exp2(x) - 1.0) < 1e-12);
        double r = rng_double(&rng) - 0.5, c, s;
        kernel_cos_sin(r, &c, &s);
        assert_true(fabs(c - cos(r * KERNEL_PI / 2.0)) < 1e-13);
        assert_true(fabs(s - sin(r * KERNEL_PI / 2.0)) < 1e-13);
        double u = rng_double(&rng) + 0x1p-54;
        double near_one = 1.0 - u * 0x1p-20, near_zero = u * 0x1p-30;
        assert_true(fabs(kernel_minus_log(u) / -log(u) - 1.0) < 1e-13);
        assert_true(fabs(kernel_minus_log(near_one) / -log(near_one) - 1.0) < 1e-13);
        assert_true(fabs(kernel_minus_log(near_zero) / -log(near_zero) - 1.0) < 1e-13);
    }
    assert_true(kernel_exp2(0.0) == 1.0);
    assert_true(kernel_exp2(-10.0) == 0x1p-10);
    assert_true(kernel_minus_log(0x1p-53) > 36.7);
    assert_true(kernel_minus_log(1.0 - 0x1p-53) > 0.0);
}

static void uniform_stays_below_one(void **state)
{
    (void)state;
    assert_true(kernel_uniform(0) == 0.0);
    assert_true(kernel_uniform(UINT64_MAX) == 1.0 - 0x1p-52);
}

static void wrap_never_gives_one(void **state)
{
    (void)state;
    assert_true(kernel_wrap(-1e-20) == 0.0);
    assert_true(kernel_wrap(-0x1p-54) == 0.0);
    assert_true(kernel_wrap(1.0) == 0.0);
    assert_true(kernel_wrap(0.0) == 0.0);
    assert_true(kernel_wrap(1.25) == 0.25);
    assert_true(kernel_wrap(-0.25) == 0.75);
    assert_true(kernel_wrap(-123.25) == 0.75);
    assert_true(kernel_wrap(1.0 - 0x1p-53) == 1.0 - 0x1p-53);
}

static void defaults_are_the_papers(void **state)
{
    (void)state;
    struct kernel k;
    kernel_init(&k, &kernel_exponential, 0.0, 0.0, 0.0);
    assert_true(k.sigma == 0.01 && k.s1 == 1.0 / 1024.0 && k.s2 == 1.0 / 64.0);
    assert_true(fabs(k.log_ratio - log(16.0)) < 1e-15);
    assert_ptr_equal(kernel_find("exponential"), &kernel_exponential);
    assert_ptr_equal(kernel_find("gaussian"), &kernel_gaussian);
    assert_null(kernel_find("gauss"));
}

static void exponential_steps_keep_their_range(void **state)
{
    (void)state;
    const double widths[][2] = {{1.0 / 1024, 1.0 / 64}, {1e-6, 0.5}, {0.01, 0.01}};
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int w = 0; w < 3; w++) {
        struct kernel k;
        kernel_init(&k, &kernel_exponential, 0.0, widths[w][0], widths[w][1]);
        for (int i = 0; i < 2000; i++) {
            double d[KERNEL_BATCH];
            k.type->draw(&k, &rng, d);
            for (int j = 0; j < KERNEL_BATCH; j++) {
                assert_true(fabs(d[j]) >= k.s1 * (1.0 - 1e-12));
                assert_true(fabs(d[j]) <= k.s2 * (1.0 + 1e-12));
            }
        }
    }
}

/* One number's log density, by all images within 12 on either side. */
static double wrapped_log_density(double sigma, double d)
{
    double sum = 0.0;
    for (int n = -12; n <= 12; n++)
        sum += exp(-0.5 * pow((d + n) / sigma, 2.0));
    return log(sum / (sigma * sqrt(2.0 * KERNEL_PI)));
}

static void log_density_is_that_of_a_wrapped_step(void **state)
{
    (void)state;
    const double sigmas[] = {0.02, 0.1, 0.3, 1.0};
    for (int s = 0; s < 4; s++) {
        struct kernel k;
        double integral = 0.0, d[3];
        kernel_init(&k, &kernel_gaussian, sigmas[s], 0.0, 0.0);
        for (int i = 0; i < 1000; i++) {
            d[0] = (i + 0.5) / 1000 - 0.5;
            double value = k.type->log_density(&k, d, 1);
            integral += exp(value) / 1000;
            if (sigmas[s] * 30.0 > fabs(d[0])) /* the plain sum does not underflow */
                assert_true(fabs(value - wrapped_log_density(sigmas[s], d[0])) < 1e-9);
            /* Any way round the circle, and a product over numbers. */
            d[1] = d[0] + 2.0;
            d[2] = 1.0 - d[0];
            assert_true(fabs(k.type->log_density(&k, d, 3) - 3.0 * value) < 1e-9);
        }
        assert_true(fabs(integral - 1.0) < 1e-9);
    }
    assert_null(kernel_exponential.log_density);
}

static void only_a_kernel_with_a_density_has_a_second_stage(void **state)
{
    (void)state;
    struct kernel k;
    kernel_init(&k, &kernel_exponential, 0.0, 0.0, 0.0);
    assert_int_equal(k.second_stage, 1);
    kernel_init(&k, &kernel_gaussian, 0.0, 0.0, 0.0);
    assert_int_equal(k.second_stage, KERNEL_SECOND_STAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_match_libm),
        cmocka_unit_test(uniform_stays_below_one),
        cmocka_unit_test(wrap_never_gives_one),
        cmocka_unit_test(defaults_are_the_papers),
        cmocka_unit_test(exponential_steps_keep_their_range),
        cmocka_unit_test(log_density_is_that_of_a_wrapped_step),
        cmocka_unit_test(only_a_kernel_with_a_density_has_a_second_stage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
