/* Normal and F law against GSL's. */
#include "math/law.h"

#include <gsl/gsl_cdf.h>

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

static void normal_quantiles(void **state)
{
    (void)state;
    for (double p = 1e-300; p < 1.0 - 1e-12; p = p < 0.3 ? p * 7.3 : p + 0.0137)
        assert_true(fabs(law_normal_quantile(p) - gsl_cdf_ugaussian_Pinv(p)) <
                    1e-13 * (1.0 + fabs(gsl_cdf_ugaussian_Pinv(p))));
    assert_true(law_normal_quantile(0.5) == 0.0);
}

static void f_tails(void **state)
{
    (void)state;
    for (double x = 0.01; x < 60.0; x *= 1.3)
        for (int above = 1; above < 130; above += 9)
            for (int below = 1; below < 900; below = below * 2 + 1) {
                double exact = gsl_cdf_fdist_Q(x, above, below);
                if (exact > 1e-200)
                    assert_true(fabs(law_f_upper(x, above, below) / exact - 1.0) < 1e-10);
            }
    assert_true(law_f_upper(0.0, 3.0, 4.0) == 1.0);
    assert_true(law_f_upper(-1.0, 3.0, 4.0) == 1.0);
    assert_true(law_f_upper((double)INFINITY, 3.0, 4.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_quantiles),
        cmocka_unit_test(f_tails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
