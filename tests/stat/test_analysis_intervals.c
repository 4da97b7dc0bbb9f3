/* Intervals of lab's analyses on made-up results whose truth is known: how often they
 * cover it, over many replicates. Errors are log-normal between seeds, about a power of
 * time, and between the snapshots of a run. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "analysis/analysis_curve.h"
#include "analysis/analysis_optimum.h"
#include "analysis/analysis_regret.h"
#include "analysis/analysis_slope.h"
#include "analysis/analysis_speedup.h"
#include "support/results_make.h"
#include "support/stat_test.h"

#include <stdlib.h>

#define LEVEL stat_sidak(1e-3, 22)
#define SEEN  1e-9 /* what the p-value of a wrong way must lie below */
#define SEEDS 8

static int replicates(int usual)
{
    return getenv("ETALON_LONG") ? 20 * usual : usual;
}

/* Errors of a run: factor * t^-1 at times 1..2^(n-1), times exp(sigma z) of the run and
 * exp(jitter z) of each snapshot, plus the noise of the reference. */
struct law {
    double factor, sigma, jitter, noise;
};

static void draw_run(struct rng *rng, const struct law *law, double z,
                     struct results_run *run)
{
    for (size_t i = 0; i < run->snapshot_count; i++) {
        double t = exp2((double)i);
        double wobble = law->sigma * z + law->jitter * results_normal(rng);
        results_set(run, i, t, law->factor / t * exp(wobble) + law->noise);
    }
}

static void draw_cell(struct rng *rng, const struct law *law, struct results_cell *cell)
{
    cell->noise[RESULTS_RELMSE] = law->noise;
    for (size_t i = 0; i < cell->run_count; i++)
        draw_run(rng, law, results_normal(rng), &cell->runs[i]);
}

static bool covers(const struct interval *interval, double truth)
{
    return interval->lo <= truth && truth <= interval->hi;
}

/* The interval is exact: neither too narrow nor too wide. */
static bool is_exact(const char *what, long covered, long n)
{
    print_message("%s: covered %ld of %ld\n", what, covered, n);
    return stat_ok(what, stat_binomial_p(covered, n, INTERVAL_LEVEL), LEVEL);
}

/* The share of successes is at least q. */
static bool is_at_least(const char *what, long k, long n, double q)
{
    print_message("%s: %ld of %ld\n", what, k, n);
    return stat_ok(what, gsl_cdf_binomial_P((unsigned)k, q, (unsigned)n), LEVEL);
}

/* --- curves ---------------------------------------------------------------------- */

static void curves_cover(void **state)
{
    (void)state;
    const struct law law = {2.0, 0.4, 0.2, 0.05};
    struct rng rng;
    struct results_cell cell = results_make_cell(0.5, 6, 5);
    long raw = 0, corrected = 0, narrow = 0, n = replicates(3000), resolved = 0;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (long i = 0; i < n; i++) {
        struct analysis_curve curve;
        struct law clean = law;
        clean.noise = 0.0;
        draw_cell(&rng, &clean, &cell);
        analysis_curve_make(&cell, RESULTS_CPU, RESULTS_RELMSE, 8, &curve);
        double x = curve.points[3].x;
        raw += covers(&curve.points[3].raw, law.factor / x);
        struct interval low = curve.points[3].raw;
        low.lo *= sqrt(low.value / low.lo); /* half as wide: must be seen */
        low.hi *= sqrt(low.value / low.hi);
        narrow += covers(&low, law.factor / x);
        analysis_curve_deinit(&curve);
        draw_cell(&rng, &law, &cell);
        struct analysis_point end = analysis_final(&cell, RESULTS_RELMSE);
        resolved += end.resolved;
        corrected += covers(&end.corrected, law.factor / 16.0);
    }
    assert_int_equal(resolved, n);
    assert_true(is_exact("curve", raw, n));
    assert_true(is_exact("error less the reference's noise", corrected, n));
    assert_true(stat_binomial_p(narrow, n, INTERVAL_LEVEL) < SEEN);
    results_free_cell(&cell);
}

static void slopes_cover(void **state)
{
    (void)state;
    const struct law law = {2.0, 0.4, 0.2, 0.0};
    struct rng rng;
    struct results_cell cell = results_make_cell(0.5, 5, 9);
    long covered = 0, n = replicates(3000);
    rng_init(&rng, 1, RNG_TEST, 1);
    for (long i = 0; i < n; i++) {
        draw_cell(&rng, &law, &cell);
        struct analysis_slope slope = analysis_slope(&cell, RESULTS_WALL, RESULTS_RELMSE);
        covered += covers(&slope.raw, -1.0);
    }
    assert_true(is_exact("slope", covered, n));
    results_free_cell(&cell);
}

/* --- speed-up -------------------------------------------------------------------- */

/* A is twice as fast as B. Seeds have a common luck when they are paired. */
static long speedups_cover(double shared, size_t seeds, long n, int index)
{
    const struct law fast = {1.0, 0.3, 0.05, 0.0}, slow = {2.0, 0.3, 0.05, 0.0};
    struct rng rng;
    struct results_cell a = results_make_cell(0.5, seeds, 7);
    struct results_cell b = results_make_cell(0.5, seeds, 7);
    long covered = 0;
    rng_init(&rng, 1, RNG_TEST, (uint64_t)index);
    for (size_t s = 0; shared == 0.0 && s < seeds; s++)
        b.runs[s].seed += 100;
    for (long i = 0; i < n; i++) {
        for (size_t s = 0; s < seeds; s++) {
            double z = results_normal(&rng), own = sqrt(1.0 - shared * shared);
            draw_run(&rng, &fast, z, &a.runs[s]);
            draw_run(&rng, &slow, shared * z + own * results_normal(&rng), &b.runs[s]);
        }
        struct analysis_speedup s = analysis_speedup(&a, &b, RESULTS_WALL, RESULTS_MSE);
        assert_int_equal(s.paired, shared > 0.0);
        covered += covers(&s.ratio, 2.0);
    }
    results_free_cell(&a);
    results_free_cell(&b);
    return covered;
}

static void speedups_do(void **state)
{
    (void)state;
    long n = replicates(300);
    long apart = speedups_cover(0.0, SEEDS, n, 2);
    long paired = speedups_cover(0.8, SEEDS, n, 3);
    assert_true(is_at_least("speed-up", apart, n, 0.93));
    assert_true(is_at_least("speed-up, paired", paired, n, 0.93));
}

/* By percentiles of a bootstrap two seeds would cover half of the time. */
static void speedups_of_few_seeds_do(void **state)
{
    (void)state;
    long n = replicates(300);
    for (size_t seeds = 2; seeds <= 3; seeds++) {
        long apart = speedups_cover(0.0, seeds, n, 10 + (int)seeds);
        long paired = speedups_cover(0.8, seeds, n, 20 + (int)seeds);
        assert_true(is_at_least("speed-up, few seeds", apart, n, 0.93));
        assert_true(is_at_least("speed-up, few seeds, paired", paired, n, 0.93));
    }
}

/* --- regret ---------------------------------------------------------------------- */

enum { VALUES = 6 };

struct sweep {
    struct results_cell cells[1 + VALUES];
    const struct results_cell *manual[VALUES];
    struct family family;
};

static void sweep_init(struct sweep *sweep, size_t seeds)
{
    sweep->cells[0] = results_make_cell((double)NAN, seeds, 2);
    for (int v = 0; v < VALUES; v++) {
        sweep->cells[1 + v] = results_make_cell((v + 1.0) / VALUES, seeds, 2);
        sweep->manual[v] = &sweep->cells[1 + v];
    }
    sweep->family = (struct family){.name = "",
                                    .automatic = &sweep->cells[0],
                                    .manual = sweep->manual,
                                    .manual_count = VALUES};
}

static void sweep_deinit(struct sweep *sweep)
{
    for (int i = 0; i <= VALUES; i++)
        results_free_cell(&sweep->cells[i]);
}

/* factors: of the automatic value and of the manual ones. A seed's luck is half shared.
 */
static void sweep_draw(struct rng *rng, struct sweep *sweep, const double *factors)
{
    for (size_t s = 0; s < sweep->cells[0].run_count; s++) {
        double common = results_normal(rng);
        for (int i = 0; i <= VALUES; i++) {
            const struct law law = {factors[i], 0.3, 0.0, 0.0};
            double z = sqrt(0.5) * (common + results_normal(rng));
            draw_run(rng, &law, z, &sweep->cells[i].runs[s]);
        }
    }
}

static void regret_covers(void **state)
{
    (void)state;
    static const double factors[1 + VALUES] = {1.2, 3.0, 2.0, 1.0, 1.5, 1.9, 2.4};
    struct sweep sweep;
    struct rng rng;
    long covered = 0, logs = 0, n = replicates(200);
    sweep_init(&sweep, SEEDS);
    rng_init(&rng, 1, RNG_TEST, 4);
    for (long i = 0; i < n; i++) {
        sweep_draw(&rng, &sweep, factors);
        struct analysis_regret r = analysis_regret(&sweep.family, RESULTS_WALL,
                                                   RESULTS_RELMSE);
        assert_int_equal(r.compared, VALUES);
        covered += covers(&r.regret, 1.2);
        logs += covers(&r.log_mean, 1.2);
    }
    assert_true(is_at_least("regret", covered, n, 0.93));
    assert_true(is_at_least("regret of geometric means", logs, n, 0.93));
    sweep_deinit(&sweep);
}

/* Few seeds choose the best value by one or two others and often err; regret is then low.
 * It must cover all the same, and be wide: two seeds told a narrow one would be seen. */
static void regret_of_few_seeds_covers(void **state)
{
    (void)state;
    static const double factors[1 + VALUES] = {1.2, 9.0, 8.0, 1.0, 7.0, 8.0, 9.0};
    for (size_t seeds = 2; seeds <= 3; seeds++) {
        struct sweep sweep;
        struct rng rng;
        long covered = 0, narrow = 0, n = replicates(2000);
        sweep_init(&sweep, seeds);
        rng_init(&rng, 1, RNG_TEST, 30 + seeds);
        for (long i = 0; i < n; i++) {
            sweep_draw(&rng, &sweep, factors);
            struct analysis_regret r = analysis_regret(&sweep.family, RESULTS_WALL,
                                                       RESULTS_RELMSE);
            covered += covers(&r.regret, 1.2);
            struct interval half = r.regret;
            half.lo = half.value * sqrt(half.lo / half.value);
            half.hi = half.value * sqrt(half.hi / half.value);
            narrow += covers(&half, 1.2);
        }
        assert_true(is_exact("regret of few seeds", covered, n));
        assert_true(stat_binomial_p(narrow, n, INTERVAL_LEVEL) < SEEN);
        sweep_deinit(&sweep);
    }
}

/* Methods are compared as independent, Welch's interval errs on the wide side at most. */
static void ratios_cover(void **state)
{
    (void)state;
    for (size_t seeds = 2; seeds <= 8; seeds += 3) {
        long covered = 0, n = replicates(3000);
        struct rng rng;
        rng_init(&rng, 1, RNG_TEST, 40 + seeds);
        for (long i = 0; i < n; i++) {
            double a[8], b[8];
            for (size_t s = 0; s < seeds; s++) {
                a[s] = 3.0 * exp(0.4 * results_normal(&rng));
                b[s] = exp(0.1 * results_normal(&rng));
            }
            struct interval ratio = interval_log_ratio(a, seeds, b, seeds);
            covered += covers(&ratio, 3.0);
        }
        assert_true(is_at_least("ratio", covered, n, INTERVAL_LEVEL - 0.01));
    }
}

/* Where all p_l do equally well regret is 1: chosen on one half and judged on the other
 * it comes out so, chosen and judged on the same seeds it does not. */
static void halves_are_fair(void **state)
{
    (void)state;
    static const double factors[1 + VALUES] = {1, 1, 1, 1, 1, 1, 1};
    struct sweep sweep;
    struct rng rng;
    int n = replicates(200);
    long covered = 0;
    double *fair = mem_alloc((size_t)n, sizeof *fair);
    double *logs = mem_alloc((size_t)n, sizeof *logs);
    double *naive = mem_alloc((size_t)n, sizeof *naive), mean = 0.0, mean_fair = 0.0;
    sweep_init(&sweep, SEEDS);
    rng_init(&rng, 1, RNG_TEST, 5);
    for (int i = 0; i < n; i++) {
        sweep_draw(&rng, &sweep, factors);
        struct analysis_regret r = analysis_regret(&sweep.family, RESULTS_WALL,
                                                   RESULTS_RELMSE);
        fair[i] = log(r.regret.value);
        logs[i] = log(r.log_mean.value);
        naive[i] = log(r.naive);
        covered += covers(&r.regret, 1.0);
        mean += naive[i] / n;
        mean_fair += fair[i] / n;
    }
    print_message("mean log regret %.4f, naive %.4f\n", mean_fair, mean);
    assert_true(stat_ok("regret of equals", stat_mean_p(fair, n, 0.0), LEVEL));
    assert_true(stat_ok("geometric regret of equals", stat_mean_p(logs, n, 0.0), LEVEL));
    assert_true(stat_mean_p(naive, n, 0.0) < SEEN && mean > 0.0);
    assert_true(is_at_least("regret of equals covered", covered, n, 0.93));
    mem_free(fair);
    mem_free(logs);
    mem_free(naive);
    sweep_deinit(&sweep);
}

/* --- range of best values -------------------------------------------------------- */

static bool optimum_has(const struct sweep *sweep, size_t value)
{
    struct analysis_optimum o;
    analysis_optimum_make(&sweep->family, RESULTS_WALL, RESULTS_RELMSE, &o);
    bool has = o.values[value].in_set;
    analysis_optimum_deinit(&o);
    return has;
}

static void optimum_holds_the_best(void **state)
{
    (void)state;
    /* A clear best; one hardly better than the rest; one with a single rival. */
    static const double factors[3][1 + VALUES] = {{1, 3.0, 2.0, 1.0, 1.5, 1.9, 2.4},
                                                  {1, 1.01, 1.01, 1, 1.01, 1.01, 1.01},
                                                  {1, 9, 9, 1, 1.001, 9, 9}};
    struct sweep sweep;
    struct rng rng;
    long n = replicates(3000), worst = 0;
    sweep_init(&sweep, 6);
    for (int law = 0; law < 3; law++) {
        long held = 0;
        rng_init(&rng, 1, RNG_TEST, (uint64_t)(6 + law));
        for (long i = 0; i < n; i++) {
            sweep_draw(&rng, &sweep, factors[law]);
            held += optimum_has(&sweep, 2);
            worst += law == 0 && optimum_has(&sweep, 0);
        }
        assert_true(is_at_least("the best p_l is in the set", held, n,
                                1.0 - ANALYSIS_OPTIMUM_ALPHA));
    }
    /* Three times the error of the best is told from it nearly always. */
    assert_true(is_at_least("the worst p_l is not", n - worst, n, 0.95));
    sweep_deinit(&sweep);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_cover),
        cmocka_unit_test(slopes_cover),
        cmocka_unit_test(speedups_do),
        cmocka_unit_test(regret_covers),
        cmocka_unit_test(halves_are_fair),
        cmocka_unit_test(optimum_holds_the_best),
        cmocka_unit_test(speedups_of_few_seeds_do),
        cmocka_unit_test(regret_of_few_seeds_covers),
        cmocka_unit_test(ratios_cover),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
