/* The analyses of lab where the answer is known exactly, and where there is none: one
 * seed, no curves, no reference, a single manual value. */
#include "analysis/analysis_curve.h"
#include "analysis/analysis_drift.h"
#include "analysis/analysis_optimum.h"
#include "analysis/analysis_panel.h"
#include "analysis/analysis_regret.h"
#include "analysis/analysis_slope.h"
#include "analysis/analysis_speedup.h"
#include "analysis/analysis_split.h"
#include "analysis/analysis_text.h"
#include "analysis/pixel_blocks.h"
#include "analysis/resample.h"
#include "support/results_make.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-9 * fabs(b)))
        fail_msg("%.17g is not %.17g", a, b);
}

/* factor[seed] * t^slope at t = start * 2^i. */
static struct results_cell power_cell(double p_l, const double *factors, size_t seeds,
                                      double start, double slope)
{
    struct results_cell cell = results_make_cell(p_l, seeds, 7);
    for (size_t s = 0; s < seeds; s++)
        for (size_t i = 0; i < 7; i++) {
            double t = start * exp2((double)i);
            results_set(&cell.runs[s], i, t, factors[s] * pow(t, slope));
        }
    return cell;
}

static bool is_nothing(const struct interval *interval)
{
    return isnan(interval->value) && isnan(interval->lo) && isnan(interval->hi);
}

/* --- intervals ------------------------------------------------------------------- */

static void intervals(void **state)
{
    (void)state;
    const double x[] = {1.0, 2.0, 3.0, 6.0}, bad[] = {1.0, -1.0};
    /* mean 3, standard deviation sqrt(14/3), t(.975, 3) = 3.182446305284263 */
    struct interval mean = interval_mean(x, 4);
    near(mean.value, 3.0);
    near(mean.hi - 3.0, 3.182446305284263 * sqrt(14.0 / 3.0) / 2.0);
    near(3.0 - mean.lo, mean.hi - 3.0);
    near(interval_log_mean(x, 4).value, pow(36.0, 0.25));
    /* Logs 0 and 2 against 1 and 1: the mean's variance is 1, Welch has one degree of
     * freedom, t(.975, 1) = 12.70620473617471. */
    const double a[] = {1.0, exp(2.0)}, b[] = {exp(1.0), exp(1.0)};
    struct interval ratio = interval_log_ratio(a, 2, b, 2);
    near(ratio.value, 1.0);
    near(log(ratio.hi), 12.70620473617471);
    near(log(ratio.lo), -12.70620473617471);
    ratio = interval_log_ratio(a, 1, b, 2);
    assert_true(fabs(ratio.value - exp(-1.0)) < 1e-12 && isnan(ratio.lo));
    ratio = interval_log_ratio(a, 2, bad, 2);
    assert_true(isnan(ratio.value));
    ratio = interval_log_ratio(b, 2, b, 2);
    assert_true(ratio.lo == 1.0 && ratio.hi == 1.0);
    struct interval one = interval_mean(x, 1), none = interval_mean(x, 0);
    assert_true(one.value == 1.0 && isnan(one.lo) && !interval_is_known(&one));
    struct interval log = interval_log_mean(bad, 2);
    assert_true(is_nothing(&none) && is_nothing(&log));
    double replicates[1001];
    for (int i = 0; i <= 1000; i++)
        replicates[i] = 1000.0 - i;
    /* Of very many values: 2.5 % of the replicates are cut off each end. */
    struct interval many = interval_percentile(500.0, replicates, 1001, 1000000);
    assert_true(fabs(many.lo - 25.0) < 0.01 && fabs(many.hi - 975.0) < 0.01);
    struct interval few = interval_percentile(500.0, replicates, 1001, 4);
    assert_true(few.lo < 0.2 && few.hi > 999.8);
    replicates[7] = (double)NAN;
    few = interval_percentile(500.0, replicates, 1001, 4);
    assert_true(few.value == 500.0 && isnan(few.lo) && isnan(few.hi));
}

static void draws(void **state)
{
    (void)state;
    double a[20], b[20], again[20], sum = 0.0;
    int side[7], ones = 0;
    resample_counts(3, 0, 20, a);
    resample_counts(3, 0, 20, again);
    resample_counts(3, 1, 20, b);
    assert_memory_equal(a, again, sizeof a);
    assert_memory_not_equal(a, b, sizeof a);
    resample_counts(4, 0, 20, again);
    assert_memory_not_equal(a, again, sizeof a);
    for (int i = 0; i < 20; i++)
        sum += a[i];
    assert_true(sum == 20.0);
    resample_halves(0, 7, side);
    for (int i = 0; i < 7; i++)
        ones += side[i];
    assert_int_equal(ones, 3);
}

/* --- curves ---------------------------------------------------------------------- */

static void lines_are_met_exactly(void **state)
{
    (void)state;
    const double factors[] = {1.0, 4.0};
    struct results_cell cell = power_cell(0.5, factors, 2, 1.0, -0.7);
    struct results_run *run = &cell.runs[1];
    near(analysis_error_at(run, RESULTS_CPU, RESULTS_RELMSE, 3.0), 4.0 * pow(3.0, -0.7));
    near(analysis_error_at(run, RESULTS_CPU, RESULTS_RELMSE, 64.0),
         4.0 * pow(64.0, -0.7));
    assert_true(isnan(analysis_error_at(run, RESULTS_CPU, RESULTS_RELMSE, 0.99)));
    assert_true(isnan(analysis_error_at(run, RESULTS_CPU, RESULTS_RELMSE, 64.01)));
    /* The other seed's curve lies elsewhere: only what both cover is left. */
    for (size_t i = 0; i < 7; i++)
        cell.runs[0].snapshots[i].at[RESULTS_WALL] *= 2.0;
    struct analysis_curve curve;
    analysis_curve_make(&cell, RESULTS_WALL, RESULTS_RELMSE, 5, &curve);
    assert_int_equal(curve.count, 5);
    assert_true(curve.points[0].x == 2.0 && curve.points[4].x == 64.0);
    near(curve.points[2].x, sqrt(128.0));
    for (size_t i = 0; i < 5; i++) {
        double x = curve.points[i].x;
        near(curve.points[i].raw.value, 2.0 * pow(x, -0.7) * pow(2.0, 0.35));
        assert_true(curve.points[i].resolved);
    }
    analysis_curve_deinit(&curve);
    /* What came before the later half does not count. */
    for (size_t i = 0; i < 3; i++)
        cell.runs[0].snapshots[i].error[RESULTS_RELMSE] *= 10.0;
    struct analysis_slope slope = analysis_slope(&cell, RESULTS_CPU, RESULTS_RELMSE);
    near(slope.raw.value, -0.7);
    near(slope.corrected.lo, -0.7);
    assert_int_equal(slope.seeds, 2);
    results_free_cell(&cell);
}

/* Errors below the reference's noise are said to be so; no log of a negative number. */
static void noise_is_subtracted(void **state)
{
    (void)state;
    const double factors[] = {1.0, 1.02, 0.98};
    struct results_cell cell = power_cell(0.5, factors, 3, 1.0, -1.0);
    for (size_t s = 0; s < 3; s++)
        for (size_t i = 0; i < 7; i++)
            cell.runs[s].snapshots[i].error[RESULTS_RELMSE] += 0.25;
    cell.noise[RESULTS_RELMSE] = 0.25;
    struct analysis_slope slope = analysis_slope(&cell, RESULTS_CPU, RESULTS_RELMSE);
    near(slope.corrected.value, -1.0);
    assert_true(slope.raw.value > -0.3);
    struct analysis_curve curve;
    analysis_curve_make(&cell, RESULTS_CPU, RESULTS_RELMSE, 7, &curve);
    assert_true(curve.points[6].resolved);
    near(curve.points[6].corrected.value, cbrt(1.02 * 0.98) / 64.0);
    analysis_curve_deinit(&curve);
    cell.noise[RESULTS_RELMSE] = 0.2665;
    analysis_curve_make(&cell, RESULTS_CPU, RESULTS_RELMSE, 7, &curve);
    assert_true(curve.points[0].resolved && !curve.points[6].resolved);
    assert_true(is_nothing(&curve.points[6].corrected));
    assert_true(interval_is_known(&curve.points[6].raw));
    analysis_curve_deinit(&curve);
    slope = analysis_slope(&cell, RESULTS_CPU, RESULTS_RELMSE);
    assert_true(is_nothing(&slope.corrected) && slope.seeds == 3);
    results_free_cell(&cell);
}

static void speedups(void **state)
{
    (void)state;
    /* Paired by seed the ratio is the same in all of them, and surely 3. */
    const double fast[] = {1.0, 1.3, 0.8}, slow[] = {3.0, 3.9, 2.4}, far[] = {999, 999};
    struct results_cell a = power_cell(0.5, fast, 3, 1.0, -1.0);
    struct results_cell b = power_cell(0.5, slow, 3, 1.0, -1.0);
    struct results_cell c = power_cell(0.5, far, 2, 1.0, -1.0);
    struct analysis_speedup s = analysis_speedup(&a, &b, RESULTS_WALL, RESULTS_RELMSE);
    near(s.ratio.value, 3.0);
    near(s.ratio.lo, 3.0);
    near(s.ratio.hi, 3.0);
    near(s.error, 3.0 * cbrt(1.04) / 64.0);
    near(s.x_a, 64.0 / 3.0);
    assert_true(s.paired && s.resolved && !s.at_least && s.clipped == 0);
    s = analysis_speedup(&b, &a, RESULTS_WALL, RESULTS_RELMSE);
    near(s.ratio.hi, 1.0 / 3.0);
    s = analysis_speedup(&a, &c, RESULTS_WALL, RESULTS_RELMSE);
    near(s.ratio.value, 64.0); /* A was there before its first snapshot */
    assert_true(s.at_least && !s.paired && s.seeds == 2 && s.clipped == s.replicates);
    results_free_cell(&a);
    results_free_cell(&b);
    results_free_cell(&c);
}

/* --- families -------------------------------------------------------------------- */

/* Of the two seeds of a_plain_sweep at x = 32 the value that is lowest by the other seed
 * is judged: by seed 2 that is p_l = 1, by seed 1 p_l = .1. */
static void check_two_seeds(const struct family *family, const struct analysis_regret *r)
{
    const double ratios[] = {1.5 / 1.01, 1.7 / 1.1};
    struct interval expected = interval_log_mean(ratios, 2);
    near(r->regret.value, expected.value);
    near(r->regret.lo, expected.lo);
    near(r->regret.hi, expected.hi);
    near(r->log_mean.value, expected.value);
    near(analysis_regret_value(family, RESULTS_CPU, RESULTS_RELMSE), expected.value);
}

static void a_plain_sweep(void **state)
{
    (void)state;
    const double factors[4][4] = {
        {1.5, 1.7, 1.6, 1.4}, {1.0, 1.1, 0.9, 1.0}, {2, 2.1, 2.2, 2}, {1.01, 1, 1, 0.9}};
    struct results_cell cells[4];
    const struct results_cell *manual[] = {&cells[1], &cells[2], &cells[3]};
    const double p_l[] = {(double)NAN, 0.1, 0.5, 1.0};
    for (int i = 0; i < 4; i++)
        cells[i] = power_cell(p_l[i], factors[i], 4, i == 2 ? 2.0 : 1.0, -1.0);
    cells[0].p_l_mean = 0.6;
    struct family family = {
        .name = "", .automatic = &cells[0], .manual = manual, .manual_count = 3};
    struct analysis_regret r = analysis_regret(&family, RESULTS_CPU, RESULTS_RELMSE);
    assert_true(r.x == 64.0 && r.compared == 3 && r.seeds == 4 && r.why[0] == '\0');
    near(r.naive, 6.2 / 3.91);
    assert_true(r.best == &cells[3] && r.best_p_l == 1.0);
    assert_true(r.regret.lo < r.naive && r.naive < r.regret.hi);
    struct analysis_optimum o;
    analysis_optimum_make(&family, RESULTS_CPU, RESULTS_RELMSE, &o);
    assert_int_equal(o.best, 2);
    assert_true(o.values[0].in_set && !o.values[1].in_set && o.values[2].in_set);
    assert_true(o.lo == 0.1 && o.hi == 1.0 && o.auto_inside && o.values[2].p == 1.0);
    near(o.level, 1.0 - sqrt(0.95));
    analysis_optimum_deinit(&o);
    /* Half of the seeds will do, fewer not; the time is the earliest end. */
    cells[3].run_count = 1;
    cells[1].runs[3].snapshot_count = 6;
    r = analysis_regret(&family, RESULTS_CPU, RESULTS_RELMSE);
    assert_true(r.left_out == 1 && r.compared == 2 && r.x == 32.0 && r.seeds == 4);
    cells[3].run_count = 2;
    r = analysis_regret(&family, RESULTS_CPU, RESULTS_RELMSE);
    assert_true(r.left_out == 0 && r.seeds == 2 && r.why[0] == '\0');
    check_two_seeds(&family, &r);
    cells[3].run_count = 4;
    cells[0].noise[RESULTS_RELMSE] = 0.04;
    r = analysis_regret(&family, RESULTS_CPU, RESULTS_RELMSE);
    assert_true(!r.resolved && is_nothing(&r.regret) && strstr(r.why, "noise"));
    for (int i = 0; i < 4; i++)
        results_free_cell(&cells[i]);
}

/* --- nothing to tell ------------------------------------------------------------- */

static void analyse_all(const struct results_cell *automatic,
                        const struct results_cell *manual, bool has_any)
{
    struct family family = {
        .name = "", .automatic = automatic, .manual = &manual, .manual_count = 1};
    struct analysis_curve curve;
    struct analysis_optimum o;
    analysis_curve_make(automatic, RESULTS_WALL, RESULTS_RELMSE, 9, &curve);
    for (size_t i = 0; i < curve.count; i++)
        assert_false(interval_is_known(&curve.points[i].raw));
    analysis_curve_deinit(&curve);
    struct analysis_slope slope = analysis_slope(automatic, RESULTS_WALL, RESULTS_RELMSE);
    assert_false(interval_is_known(&slope.raw));
    struct analysis_speedup s = analysis_speedup(automatic, manual, RESULTS_WALL,
                                                 RESULTS_RELMSE);
    assert_false(interval_is_known(&s.ratio));
    struct analysis_regret r = analysis_regret(&family, RESULTS_WALL, RESULTS_RELMSE);
    assert_true(is_nothing(&r.regret) && r.why[0] && isfinite(r.naive) == has_any);
    analysis_optimum_make(&family, RESULTS_WALL, RESULTS_RELMSE, &o);
    assert_true(isnan(o.lo) && isnan(o.hi) && !o.auto_inside && o.why[0]);
    analysis_optimum_deinit(&o);
    family.manual_count = 0;
    r = analysis_regret(&family, RESULTS_WALL, RESULTS_RELMSE);
    assert_true(is_nothing(&r.regret) && r.why[0] && r.best == NULL);
    family.automatic = NULL;
    r = analysis_regret(&family, RESULTS_WALL, RESULTS_RELMSE);
    assert_true(r.why[0] && r.best == NULL);
}

static void what_cannot_be_told_is_not(void **state)
{
    (void)state;
    const double nan = (double)NAN, one[] = {1.0}, unknown[] = {nan, nan};
    struct results_cell a = power_cell(nan, one, 1, 1.0, -1.0);
    struct results_cell b = power_cell(0.5, one, 1, 1.0, -1.0);
    analyse_all(&a, &b, true); /* one seed */
    results_free_cell(&a);
    results_free_cell(&b);
    a = power_cell(nan, unknown, 2, 1.0, -1.0);
    b = power_cell(0.5, unknown, 2, 1.0, -1.0);
    analyse_all(&a, &b, false); /* no reference */
    results_free_cell(&a);
    results_free_cell(&b);
    a = results_make_cell(nan, 3, 0);
    b = results_make_cell(0.5, 3, 0);
    analyse_all(&a, &b, false); /* no curves */
    results_free_cell(&a);
    results_free_cell(&b);
    a = results_make_cell(nan, 0, 0);
    b = results_make_cell(0.5, 0, 0);
    analyse_all(&a, &b, false); /* no runs */
    results_free_cell(&a);
    results_free_cell(&b);
}

/* The best of a single manual value is that value. */
static void one_manual_value(void **state)
{
    (void)state;
    const double slow[] = {2.0, 2.2, 1.9, 2.1}, fast[] = {1.0, 1.1, 0.9, 1.0};
    struct results_cell a = power_cell((double)NAN, slow, 4, 1.0, -1.0);
    struct results_cell b = power_cell(0.5, fast, 4, 1.0, -1.0);
    const struct results_cell *manual = &b;
    struct family family = {
        .name = "", .automatic = &a, .manual = &manual, .manual_count = 1};
    struct analysis_regret r = analysis_regret(&family, RESULTS_CPU, RESULTS_RELMSE);
    near(r.naive, 8.2 / 4.0);
    near(r.regret.value, r.naive);
    struct analysis_optimum o;
    analysis_optimum_make(&family, RESULTS_CPU, RESULTS_RELMSE, &o);
    assert_true(o.lo == 0.5 && o.hi == 0.5 && o.count == 1);
    near(o.level, ANALYSIS_OPTIMUM_ALPHA);
    analysis_optimum_deinit(&o);
    results_free_cell(&a);
    results_free_cell(&b);
}

/* --- pictures -------------------------------------------------------------------- */

static struct image *flat(float value)
{
    struct image *image = image_create(4, 4);
    for (int i = 0; i < 48; i++)
        image->pixels[i] = value;
    return image;
}

static void pictures_split(void **state)
{
    (void)state;
    struct err err = {0};
    struct analysis_split s;
    struct image *images[] = {flat(1.5f), flat(1.0f), flat(2.0f)}, *r = flat(1.0f);
    const struct image *const *pictures = (const struct image *const *)images;
    /* Differences .5, 0, 1: mean .5, variance .25; bias^2 = .25 - .25/3. */
    assert_true(analysis_split_pictures(pictures, 3, r, NULL, &s, &err));
    near(s.variance * 1.01, 0.25);
    near(s.bias2 * 1.01, 0.25 - 0.25 / 3.0);
    near(s.total, s.variance + s.bias2);
    /* Without one at a time: bias^2 is the product of the other two, 0, .5, 0. */
    near(s.bias2_se * 1.01, 1.0 / 3.0);
    near(s.variance_se * 1.01, 0.25);
    images[1]->pixels[5] = (float)NAN;
    assert_true(analysis_split_pictures(pictures, 3, r, NULL, &s, &err));
    assert_int_equal(s.nonfinite, 1);
    near(s.variance * 1.01, 0.25);
    assert_true(analysis_split_pictures(pictures, 2, r, NULL, &s, &err));
    assert_true(isfinite(s.bias2) && s.errors_from_blocks && !s.bias_is_significant);
    /* A picture of one block has no two to compare. */
    assert_true(isnan(s.bias2_se) && isnan(s.variance_se) && isnan(s.bias2_hi));
    assert_false(analysis_split_pictures(pictures, 1, r, NULL, &s, &err));
    assert_true(isnan(s.bias2) && strstr(err.message, "not enough seeds"));
    struct image *small = image_create(2, 2);
    err = (struct err){0};
    assert_false(analysis_split_pictures(pictures, 3, small, NULL, &s, &err));
    assert_non_null(strstr(err.message, "4x4 against 2x2"));
    image_destroy(small);
    image_destroy(r);
    for (int i = 0; i < 3; i++)
        image_destroy(images[i]);
}

/* Two blocks: the difference of their sums is the error of the whole. */
static void blocks_have_an_error(void **state)
{
    (void)state;
    struct pixel_blocks blocks;
    pixel_blocks_init(&blocks, 9, 5);
    assert_true(blocks.across == 3 && blocks.down == 2);
    pixel_blocks_add(&blocks, 0, 0, 1.0);
    pixel_blocks_add(&blocks, 3, 3, 2.0);
    pixel_blocks_add(&blocks, 7, 0, 5.0);
    pixel_blocks_add(&blocks, 4, 4, 1.0);
    pixel_blocks_add(&blocks, 8, 2, 100.0); /* without a partner */
    /* (3 - 5)^2 + (0 - 1)^2 over four of six blocks. */
    near(pixel_blocks_se(&blocks), sqrt(5.0 * 6.0 / 4.0));
    pixel_blocks_deinit(&blocks);
}

/* --- from a folder --------------------------------------------------------------- */

static struct results *load_text(const char *runs, const char *curves)
{
    char folder[] = "/tmp/etalon_analysis_XXXXXX";
    struct err err = {0};
    assert_non_null(mkdtemp(folder));
    char *run_path = text_join(folder, "runs.csv");
    char *curve_path = text_join(folder, "curves.csv");
    assert_true(text_write_file(run_path, runs, strlen(runs), &err));
    assert_true(text_write_file(curve_path, curves, strlen(curves), &err));
    struct results *results = results_load(folder, &err);
    assert_non_null(results);
    unlink(run_path);
    unlink(curve_path);
    rmdir(folder);
    mem_free(run_path);
    mem_free(curve_path);
    return results;
}

static char *print_of(const char *runs, const char *curves)
{
    char *text = NULL;
    size_t size;
    struct results *results = load_text(runs, curves);
    FILE *out = open_memstream(&text, &size);
    struct analysis_text_options options = {.pictures = true};
    analysis_text_print(out, results, &options);
    fclose(out);
    results_destroy(results);
    return text;
}

static void starts_against_wholes(void **state)
{
    (void)state;
    struct analysis_drift drifts[ANALYSIS_DRIFTS];
    struct results *results = load_text(
        "job,label,scene_label,seed,p_l_source,eta_s,eta_s_se,eta_s_run,"
        "eta_s_run_se,eta_l,eta_l_run,eta_0,eta_0_run,r,r_run\n"
        "a,x,box,1,auto,0.8,0.1,0.7,0.1,0.2,0.2,1,1,0.2,0.2\n"
        "b,x,box,2,auto,0.8,0.1,0.6,0.1,0.2,0.2,1,1,0.2,0.2\n"
        "c,x,box,3,auto,0,.inf,0,.inf,0.2,0.2,1,1,0.2,0.2\n"
        "d,bdpt,box,1,,.nan,.nan,.nan,.nan,.nan,.nan,.nan,.nan,.nan,.nan\n",
        "job\n");
    assert_true(analysis_drift(results, &results->cells[0], drifts));
    assert_true(drifts[0].seeds == 2 && drifts[1].seeds == 3 && drifts[4].seeds == 2);
    near(drifts[0].start.value, 0.8);
    near(drifts[0].whole.value, 0.65);
    near(drifts[0].difference.value, -0.15);
    /* t = 3 with one degree of freedom */
    near(drifts[0].p, 2.0 * atan(1.0 / 3.0) / 3.14159265358979323846);
    assert_true(drifts[1].p == 1.0);
    assert_string_equal(drifts[4].name, "p_l");
    near(drifts[4].start.value, 0.8 / 1.2);
    near(drifts[4].whole.value, 0.5 * (0.7 / 1.0 + 0.6 / 0.8));
    assert_false(analysis_drift(results, &results->cells[1], drifts));
    results_destroy(results);
}

static void text_of_little(void **state)
{
    (void)state;
    char *text = print_of("job,label,scene_label,seed\na,x,box,1\n", "job\n");
    assert_non_null(strstr(text, "=== box, an unknown budget"));
    assert_non_null(strstr(text, "no reference"));
    assert_non_null(strstr(text, "does not name the reference"));
    free(text);
    text = print_of("job,label,scene_label,seed\n", "job\n");
    assert_null(strstr(text, "==="));
    free(text);
}

static void text_of_a_sweep(void **state)
{
    (void)state;
    struct text runs = {0}, curves = {0};
    text_append(&runs, "job,label,scene_label,seed,p_l,p_l_source,relmse,eta_s,eta_s_run,"
                       "reference_relmse\n");
    text_append(&curves, "job,wall_s,relmse\n");
    for (int s = 1; s <= 4; s++)
        for (int v = 0; v < 2; v++) {
            double error = v ? 0.1 + 0.001 * s : 0.3;
            text_append(&runs, "j%d%d,p_l=%s,box,%d,0.%d,%s,%g,0.%d,0.9,0.01\n", s, v,
                        v ? "0.5" : "auto", s, 4 + v, v ? "manual" : "auto", error, s);
            text_append(&curves, "j%d%d,1,1\nj%d%d,2,%g\n", s, v, s, v, error);
        }
    char *text = print_of(runs.data, curves.data);
    assert_non_null(strstr(text, "relmse 0.01"));
    assert_non_null(strstr(text, "best manual p_l 0.5; naive 3.135"));
    assert_non_null(strstr(text, "automatic 0.4 lies outside"));
    assert_non_null(strstr(text, "eta_s 0.25 -> 0.9"));
    free(text);
    mem_free(runs.data);
    mem_free(curves.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(intervals),
        cmocka_unit_test(draws),
        cmocka_unit_test(lines_are_met_exactly),
        cmocka_unit_test(noise_is_subtracted),
        cmocka_unit_test(speedups),
        cmocka_unit_test(a_plain_sweep),
        cmocka_unit_test(what_cannot_be_told_is_not),
        cmocka_unit_test(one_manual_value),
        cmocka_unit_test(pictures_split),
        cmocka_unit_test(blocks_have_an_error),
        cmocka_unit_test(starts_against_wholes),
        cmocka_unit_test(text_of_little),
        cmocka_unit_test(text_of_a_sweep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
