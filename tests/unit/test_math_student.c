/* math/student against GSL, and at the ends. */
#include "math/student.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/near.h"

static const double freedoms[] = {0.5, 1, 2, 3, 5, 7, 19, 63, 999, 10000};
enum { FREEDOMS = sizeof freedoms / sizeof freedoms[0] };

static void tails_are_those_of_gsl(void **state)
{
    (void)state;
    for (int f = 0; f < FREEDOMS; f++)
        for (double t = -40.0; t <= 40.0; t += 0.37) {
            double q = gsl_cdf_tdist_Q(t, freedoms[f]);
            if (q > 1e-12) /* below, GSL has fewer digits than we */
                assert_relative(student_tail(t, freedoms[f]), q, 1e-10);
        }
    for (double t = -8.0; t <= 30.0; t += 0.11)
        assert_relative(student_tail(t, (double)INFINITY), gsl_cdf_ugaussian_Q(t), 1e-12);
}

/* Far out, against the incomplete beta function in 40 digits. */
static void far_tails(void **state)
{
    (void)state;
    assert_relative(student_tail(24.75, 63.0), 1.8401467294893146e-34, 1e-12);
    assert_relative(student_tail(39.92, 999.0), 2.1279436375250994e-209, 1e-10);
    assert_relative(student_tail(9.5, 10000.0), 1.2906508085897127e-21, 1e-10);
}

/* One and two degrees of freedom have closed forms. */
static void closed_forms(void **state)
{
    const double pi = 3.14159265358979323846;
    (void)state;
    for (double t = 1e-6; t < 1e7; t *= 1.7) {
        assert_relative(student_tail(t, 1.0), atan2(1.0, t) / pi, 1e-12);
        double root = sqrt(2.0 + t * t);
        assert_relative(student_tail(t, 2.0), 1.0 / (root * (root + t)), 1e-12);
    }
}

static void quantiles_undo_tails(void **state)
{
    static const double shares[] = {0.5, 0.6, 0.75, 0.9, 0.975, 0.995, 0.9999, 1 - 1e-9};
    (void)state;
    for (int f = 0; f <= FREEDOMS; f++) {
        double freedom = f < FREEDOMS ? freedoms[f] : (double)INFINITY;
        for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
            double t = student_quantile(shares[i], freedom);
            assert_relative(student_tail(t, freedom), 1.0 - shares[i], 1e-11);
            assert_true(student_quantile(1.0 - shares[i], freedom) <= 0.0);
        }
    }
    assert_relative(student_quantile(0.025, 7.0), gsl_cdf_tdist_Pinv(0.025, 7.0), 1e-9);
    assert_relative(student_quantile(0.025, (double)INFINITY), -1.959963984540054, 1e-12);
}

static void ends(void **state)
{
    (void)state;
    assert_true(student_quantile(1.0, 3.0) == (double)INFINITY);
    assert_true(student_quantile(0.0, 3.0) == -(double)INFINITY);
    assert_true(student_quantile(0.5, 3.0) == 0.0);
    assert_true(student_tail((double)INFINITY, 3.0) == 0.0);
    assert_true(student_tail(-(double)INFINITY, 3.0) == 1.0);
    assert_true(student_tail(1e200, 3.0) >= 0.0);
    assert_true(isnan(student_tail((double)NAN, 3.0)) && isnan(student_tail(1.0, 0.0)));
    assert_true(isnan(student_quantile(1.1, 3.0)) && isnan(student_quantile(0.5, -1.0)));
    assert_true(isnan(student_quantile((double)NAN, 3.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tails_are_those_of_gsl),
        cmocka_unit_test(far_tails),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(quantiles_undo_tails),
        cmocka_unit_test(ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
