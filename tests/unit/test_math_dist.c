/* Tables against a linear search, and at their ends. */
#include "math/dist.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

#define LAST_U (1.0 - 0x1p-53)

static int search(const struct dist *d, double u)
{
    int i = 0;
    while (d->cdf[i + 1] <= u)
        i++;
    return i;
}

static void known_weights(void **state)
{
    (void)state;
    const double weights[] = {1.0, 0.0, 2.0, 5.0};
    struct dist d;
    assert_true(dist_build(&d, weights, 4));
    assert_true(d.sum == 8.0);
    for (int i = 0; i < 4; i++)
        assert_true(dist_pdf(&d, i) == weights[i] / 8.0);
    double p, rest;
    assert_int_equal(dist_sample(&d, 0.25, &p, &rest), 2);
    assert_true(p == 0.25 && rest == 0.5);
    assert_int_equal(dist_sample(&d, 0.6875, &p, &rest), 3);
    assert_true(p == 0.625 && rest == 0.5);
    dist_deinit(&d);
}

static void zero_weights_are_never_picked_at_the_ends(void **state)
{
    (void)state;
    const double weights[] = {0.0, 0.0, 0.1, 0.0, 0.7, 0.0, 0.3, 0.0, 0.0};
    struct dist d;
    assert_true(dist_build(&d, weights, 9));
    double p, rest;
    assert_int_equal(dist_sample(&d, 0.0, &p, &rest), 2);
    assert_true(rest == 0.0 && p > 0.0);
    assert_int_equal(dist_sample(&d, LAST_U, &p, &rest), 6);
    assert_true(rest < 1.0 && p > 0.0);
    for (int i = 0; i <= 9; i++) { /* on, just below and just above every step */
        double steps[3] = {d.cdf[i], nextafter(d.cdf[i], 0.0), nextafter(d.cdf[i], 1.0)};
        for (int j = 0; j < 3; j++)
            if (steps[j] < 1.0)
                assert_true(weights[dist_sample(&d, steps[j], &p, &rest)] > 0.0);
    }
    dist_deinit(&d);
}

/* 49 * (1/49) is below 1: the sum must be divided by, not multiplied with its inverse. */
static void the_last_step_is_exactly_one(void **state)
{
    (void)state;
    const double weights[] = {24.0, 25.0, 0.0};
    struct dist d;
    assert_true(dist_build(&d, weights, 3));
    assert_true(d.cdf[2] == 1.0 && d.cdf[3] == 1.0);
    dist_deinit(&d);
}

/* Weights over 40 decades with holes; every answer equals the linear search's, grows
 * with u and carries its own probability. */
static void inversion_equals_linear_search_and_is_monotone(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    static double weights[1000];
    for (int run = 0; run < 300; run++) {
        int count = 1 + (int)(rng_u64(&rng) % 1000);
        double spread = 40.0 * rng_double(&rng);
        for (int i = 0; i < count; i++)
            weights[i] = rng_u64(&rng) % 4 ? pow(10.0, -spread * rng_double(&rng)) : 0.0;
        weights[rng_u64(&rng) % (uint64_t)count] = 1.0;
        struct dist d;
        assert_true(dist_build(&d, weights, count));
        int last = 0;
        for (int k = 0; k < 2000; k++) {
            double u = (k + rng_double(&rng)) / 2000.0, p, rest;
            if (u >= 1.0)
                continue;
            int i = dist_sample(&d, u, &p, &rest);
            assert_int_equal(i, search(&d, u));
            assert_true(i >= last && weights[i] > 0.0);
            assert_true(p == dist_pdf(&d, i) && rest >= 0.0 && rest < 1.0);
            assert_true(fabs(d.cdf[i] + rest * p - u) <= 0x1p-52);
            last = i;
        }
        dist_deinit(&d);
    }
}

static void probabilities_follow_the_weights(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    static double weights[100000];
    long double sum = 0.0L;
    for (int i = 0; i < 100000; i++) {
        weights[i] = rng_double(&rng);
        sum += (long double)weights[i];
    }
    struct dist d;
    assert_true(dist_build(&d, weights, 100000));
    assert_true(fabsl((long double)d.sum - sum) <= 1e-15L * sum);
    for (int i = 0; i < 100000; i++) /* two roundings of the running sum */
        assert_true(fabsl((long double)dist_pdf(&d, i) - (long double)weights[i] / sum) <=
                    0x1p-51L);
    dist_deinit(&d);
}

static void extreme_weights_build(void **state)
{
    (void)state;
    const double huge[] = {1e307, 2e307, 1e-300, 4e307};
    const double tiny[] = {0x1p-1074, 0.0, 0x1p-1074};
    struct dist d;
    assert_true(dist_build(&d, huge, 4));
    assert_true(fabs(dist_pdf(&d, 1) - 2.0 / 7.0) < 1e-15);
    dist_deinit(&d);
    assert_true(dist_build(&d, tiny, 3));
    assert_true(dist_pdf(&d, 0) == 0.5 && dist_pdf(&d, 1) == 0.0);
    dist_deinit(&d);
}

static void bad_weights_are_refused(void **state)
{
    (void)state;
    const double bad[][2] = {{1.0, -1e-300},
                             {1.0, (double)NAN},
                             {1.0, (double)INFINITY},
                             {0.0, 0.0},
                             {1.5e308, 1.5e308}};
    struct dist d;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(dist_build(&d, bad[i], 2));
        assert_null(d.cdf);
    }
    assert_false(dist_build(&d, bad[0], 0));
    dist_deinit(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_weights),
        cmocka_unit_test(zero_weights_are_never_picked_at_the_ends),
        cmocka_unit_test(the_last_step_is_exactly_one),
        cmocka_unit_test(inversion_equals_linear_search_and_is_monotone),
        cmocka_unit_test(probabilities_follow_the_weights),
        cmocka_unit_test(extreme_weights_build),
        cmocka_unit_test(bad_weights_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
