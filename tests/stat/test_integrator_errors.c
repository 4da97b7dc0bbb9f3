/* Standard errors of statistics against their spread over seeds: a scene whose bootstrap
 * has few seeds, so that many chains begin at one path; one whose bootstrap has many; one
 * whose lengths are weighted by what is hardly known; one whose p_l is measured. Mean
 * squared deviations over mean squared errors are 1, by the spread of both over SEEDS
 * runs.
 *
 * False-alarm rate: 1e-3 over all figures. Power: variances of SEEDS normal figures
 * follow chi-squared, by which each figure is tested two-sided at LEVEL; `power` prints
 * how often an error that is too small by some factor is seen in one figure, and holds
 * the test to 95 % at 1.5 (98.7 %; 89 % at 1.4, 32 % at 1.25). That takes the mean
 * squared errors for exact, which they are not quite. Seen to fail, one fault at a time:
 * chains taken as independent units (statistics_part.seeds = NULL: ten figures of
 * few_seeds by 4 to 27 sigmas), the errors of the weights left out (add_weight: four of
 * `weights` by 16 to 33), the slope of p_l left out (markov_mixing: acceptance by 8,
 * failure rate by 11 in `automatic`), the jackknife of the
 * numbers of chains (markov_add_allocation: three figures of `weights` by 4.4 to 6.1).
 * Where p_l is unsure:
 * tests/unit/test_chain_startup.c, and the door in bench/standard_errors.sh. */

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-3
#define SEEDS       120

struct figure {
    const char *name;
    size_t value, se;
};

#define FIGURE(name, field)                             \
    {                                                   \
        name, offsetof(struct run_statistics, field),   \
            offsetof(struct run_statistics, field##_se) \
    }

static const struct figure figures[] = {
    FIGURE("eta_s", start.eta_s),
    FIGURE("eta_l", start.eta_l),
    FIGURE("eta_0", start.eta_0),
    FIGURE("r", start.r),
    FIGURE("acceptance_start", start.acceptance),
    FIGURE("failure_rate_start", start.failure_rate),
    FIGURE("eta_s_run", whole.eta_s),
    FIGURE("eta_l_run", whole.eta_l),
    FIGURE("eta_0_run", whole.eta_0),
    FIGURE("r_run", whole.r),
    FIGURE("b", b),
    FIGURE("acceptance", whole.acceptance),
    FIGURE("failure_rate", whole.failure_rate),
};

#define FIGURES ((int)(sizeof figures / sizeof figures[0]))
#define DESIGNS 4
#define LEVEL   stat_sidak(FALSE_ALARM, DESIGNS *FIGURES)

static double at(const struct run_statistics *s, size_t offset)
{
    return *(const double *)((const char *)s + offset);
}

/* Sums of squares of normal figures over their variance follow chi-squared. */
static double ratio_p(double ratio)
{
    double x = ratio * (SEEDS - 1.0), freedom = SEEDS - 1.0;
    return 2.0 * fmin(gsl_cdf_chisq_P(x, freedom), gsl_cdf_chisq_Q(x, freedom));
}

static void run_seeds(const struct scene *scene, const char *const *words,
                      struct welford values[FIGURES], double variances[FIGURES])
{
    struct settings s = test_settings(words);
    for (s.seed = 1; s.seed <= SEEDS; s.seed++) {
        struct run_result r = test_run(scene, &s);
        for (int f = 0; f < FIGURES; f++) {
            double se = at(&r.statistics, figures[f].se);
            assert_true(isfinite(se));
            welford_add(&values[f], at(&r.statistics, figures[f].value));
            variances[f] += se * se / SEEDS;
        }
        run_result_deinit(&r);
    }
}

static void check(const char *name, const char *const *words)
{
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct welford values[FIGURES] = {{0}};
    double variances[FIGURES] = {0.0};
    bool ok = true;
    run_seeds(scene, words, values, variances);
    for (int f = 0; f < FIGURES; f++) {
        double ratio = welford_variance(&values[f]) / variances[f];
        printf("%-10s %-18s %.4g, sd over se %.2f\n", name, figures[f].name,
               values[f].mean, sqrt(ratio));
        ok = stat_ok(figures[f].name, ratio_p(ratio), LEVEL) && ok;
    }
    scene_destroy(scene);
    assert_true(ok);
}

#define COMMON "chains=64", "max_depth=4"

/* Small steps so small that chains stay near their seeds; next to no start, which a
 * longer bootstrap would be a share of. */
static void few_seeds(void **state)
{
    (void)state;
    const char *const words[] = {COMMON,
                                 "integrator=pssmlt",
                                 "large_step_probability=0.05",
                                 "bootstrap=64",
                                 "sigma=0.0005",
                                 "kernel=gaussian",
                                 "start=0.02",
                                 "start_cap=.02",
                                 "builder=pt",
                                 NULL};
    check("few seeds", words);
}

static void many_seeds(void **state)
{
    (void)state;
    const char *const words[] = {COMMON,
                                 "integrator=pssmlt",
                                 "large_step_probability=0.05",
                                 "bootstrap=4000",
                                 "sigma=0.0005",
                                 "kernel=gaussian",
                                 "builder=pt",
                                 NULL};
    check("many seeds", words);
}

/* Few independent paths of each length: what the whole is weighted by is hardly known. */
static void weights(void **state)
{
    (void)state;
    const char *const words[] = {COMMON,
                                 "integrator=mmlt",
                                 "mutations_per_pixel=128",
                                 "bootstrap=4000",
                                 "direct=joint",
                                 "rule=zsolnai2013",
                                 NULL};
    check("weights", words);
}

/* How often one figure is out, if its error is `factor` times too small. */
static double power_at(double factor)
{
    double freedom = SEEDS - 1.0, least = gsl_cdf_chisq_Pinv(0.5 * LEVEL, freedom),
           most = gsl_cdf_chisq_Qinv(0.5 * LEVEL, freedom);
    return gsl_cdf_chisq_Q(most / (factor * factor), freedom) +
           gsl_cdf_chisq_P(least / (factor * factor), freedom);
}

static void power(void **state)
{
    (void)state;
    static const double factors[] = {0.6, 0.7, 1.25, 1.4, 1.5, 1.6, 1.8, 2.0};
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++)
        printf("error %.4g times too small: seen in %.1f %%\n", factors[i],
               100.0 * power_at(factors[i]));
    assert_true(power_at(1.5) > 0.95);
}

/* The published rule tells p_l from the start, and the main pass mixes large and small
 * steps by it. */
static void automatic(void **state)
{
    (void)state;
    const char *const words[] = {
        COMMON,       "integrator=pssmlt", "bootstrap=4000",   "builder=pt",
        "start=0.02", "start_cap=.02",     "rule=zsolnai2013", NULL};
    check("automatic", words);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(power),      cmocka_unit_test(few_seeds),
        cmocka_unit_test(many_seeds), cmocka_unit_test(weights),
        cmocka_unit_test(automatic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
