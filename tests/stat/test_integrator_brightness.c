/* b_se of pt and bdpt is the spread that b really has: over many short runs the variance
 * of b is the mean of b_se^2, and normal 95 % intervals cover the truth at their rate. */

#include <string.h>

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define RUNS        200

static const char *const integrators[] = {"integrator=pt", "integrator=bdpt"};

static void test_coverage(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const reference[] = {"integrator=bdpt", "mutations_per_pixel=1000",
                                     "max_depth=3", NULL};
    struct settings s = test_settings(reference);
    struct run_result truth = test_run(scene, &s);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {integrators[i], "mutations_per_pixel=8",
                                     "max_depth=3", NULL};
        s = test_settings(words);
        int covered = 0;
        struct welford b = {0}, claimed = {0};
        for (int run = 0; run < RUNS; run++) {
            s.seed = 100 + run;
            struct run_result r = test_run(scene, &s);
            double se = hypot(r.statistics.b_se, truth.statistics.b_se);
            covered += fabs(r.statistics.b - truth.statistics.b) <= 1.96 * se;
            welford_add(&b, r.statistics.b);
            welford_add(&claimed, r.statistics.b_se * r.statistics.b_se);
            run_result_deinit(&r);
        }
        double chi2 = b.m2 / claimed.mean, level = stat_sidak(FALSE_ALARM, 4);
        double p = 2.0 *
                   fmin(gsl_cdf_chisq_P(chi2, RUNS - 1), gsl_cdf_chisq_Q(chi2, RUNS - 1));
        printf("%s: b +- 1.96 b_se covers the truth in %d of %d runs; b_se^2 is %.3f of "
               "the variance\n",
               integrators[i], covered, RUNS, (RUNS - 1) / chi2);
        assert_true(stat_ok("variance", p, level));
        assert_true(stat_ok("coverage", stat_binomial_p(covered, RUNS, 0.95), level));
    }
    run_result_deinit(&truth);
    scene_destroy(scene);
}

/* One pass has no spread: nothing is claimed. */
static void test_single_pass(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=1", NULL};
    struct settings s = test_settings(words);
    struct run_result r = test_run(scene, &s);
    assert_true(r.statistics.b > 0.0);
    assert_true(isinf(r.statistics.b_se));
    run_result_deinit(&r);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_single_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
