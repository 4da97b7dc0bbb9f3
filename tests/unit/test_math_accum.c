/* Compensated sums against exact integer sums, Welford against two passes. */
#include "math/accum.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/near.h"

#include <math.h>

static void cancelled_giants_leave_the_small_terms(void **state)
{
    (void)state;
    static const double x[] = {1.0, 1e100, 1.0, -1e100};
    struct accum sum = {0};
    for (int i = 0; i < 4; i++)
        accum_add(&sum, x[i]);
    assert_true(accum_value(&sum) == 2.0);
}

/* Integers up to 2^52 of random sign and size whose sum nearly cancels: the exact sum is
 * known as a 64-bit integer. Neumaier's error is one rounding of the sum plus n eps^2 of
 * the sum of magnitudes, here below 1e-9. */
static void ill_conditioned_sums_are_exact(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    int plain_fails = 0;
    for (int run = 0; run < 100; run++) {
        struct accum sum = {0};
        double plain = 0.0;
        int64_t exact = 0;
        for (int i = 0; i < 4000; i++) {
            int64_t n = (int64_t)(rng_u64(&rng) >> (12 + rng_u64(&rng) % 52));
            n = exact > 0 ? -n : n;
            exact += n;
            plain += 0.1 * (double)n;
            accum_add(&sum, 0x1p-30 * (double)n);
            accum_add(&sum, 0x1p+40 * (double)n);
        }
        for (int i = 0; i < 64; i++) /* takes the large parts out again, in pieces */
            accum_add(&sum, -0x1p+34 * (double)exact);
        double expected = 0x1p-30 * (double)exact;
        /* Terms reach 2^92, so eps^2 of their sum is about 2^-10 of the unit 2^0. */
        assert_true(fabs(accum_value(&sum) - expected) < 0x1p-1);
        plain_fails += plain != 0.1 * (double)exact;
    }
    assert_true(plain_fails > 90);
}

static void many_equal_terms_do_not_drift(void **state)
{
    (void)state;
    struct accum sum = {0};
    double plain = 0.0;
    for (int i = 0; i < 10000000; i++) {
        accum_add(&sum, 0.1);
        plain += 0.1;
    }
    double exact = (double)(0.1L * 1e7L + (1e7L * ((long double)0.1 - 0.1L)));
    assert_true(fabs(accum_value(&sum) - exact) <= 0x1p-33 * 0x1p-10);
    assert_true(fabs(plain - exact) > 1e-5);
}

static void infinity_stays_infinity(void **state)
{
    (void)state;
    struct accum sum = {0};
    accum_add(&sum, 1.0);
    accum_add(&sum, (double)INFINITY);
    accum_add(&sum, 1.0);
    assert_true(accum_value(&sum) == (double)INFINITY);
}

static void welford_equals_two_passes(void **state)
{
    (void)state;
    enum { COUNT = 10000 };
    static double x[COUNT];
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    struct welford w = {0};
    long double mean = 0.0L, m2 = 0.0L;
    for (int i = 0; i < COUNT; i++) {
        x[i] = 1e6 + rng_double(&rng); /* sum of squares minus square: 1e-3 off */
        welford_add(&w, x[i]);
        mean += (long double)x[i] / COUNT;
    }
    for (int i = 0; i < COUNT; i++)
        m2 += ((long double)x[i] - mean) * ((long double)x[i] - mean);
    assert_relative(w.mean, (double)mean, 1e-14);
    assert_relative(welford_variance(&w), (double)(m2 / (COUNT - 1)), 1e-8);
    assert_relative(welford_se(&w), (double)sqrtl(m2 / (COUNT - 1) / COUNT), 1e-8);
}

static void welford_merge_equals_one_pass(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int parts = 1; parts <= 64; parts *= 2) {
        struct welford whole = {0}, merged = {0};
        for (int part = 0; part < parts; part++) {
            struct welford one = {0};
            int count = (int)(rng_u64(&rng) % 50); /* empty parts too */
            for (int i = 0; i < count; i++) {
                double x = part + 10.0 * rng_double(&rng);
                welford_add(&one, x);
                welford_add(&whole, x);
            }
            welford_merge(&merged, &one);
        }
        assert_true(merged.count == whole.count);
        assert_relative(merged.mean, whole.mean, 1e-13);
        assert_relative(merged.m2, whole.m2, 1e-12);
    }
}

static void welford_needs_two_values_for_a_spread(void **state)
{
    (void)state;
    struct welford w = {0};
    assert_true(welford_variance(&w) == 0.0 && welford_se(&w) == 0.0);
    welford_add(&w, 5.0);
    assert_true(w.mean == 5.0 && welford_variance(&w) == 0.0 && welford_se(&w) == 0.0);
    welford_add(&w, 7.0);
    assert_true(w.mean == 6.0 && welford_variance(&w) == 2.0 && welford_se(&w) == 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cancelled_giants_leave_the_small_terms),
        cmocka_unit_test(ill_conditioned_sums_are_exact),
        cmocka_unit_test(many_equal_terms_do_not_drift),
        cmocka_unit_test(infinity_stays_infinity),
        cmocka_unit_test(welford_equals_two_passes),
        cmocka_unit_test(welford_merge_equals_one_pass),
        cmocka_unit_test(welford_needs_two_values_for_a_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
