/* Who is best and the regret over all cells, worked out by hand, and the sentences. */
#include "analysis/analysis_words.h"

#include "base/mem.h"
#include "support/results_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static void near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-9 * fabs(b)))
        fail_msg("%.17g is not %.17g", a, b);
}

/* --- who is best ----------------------------------------------------------------- */

struct set {
    struct results results;
    struct results_cell cells[8];
    struct families families;
};

/* A cell whose seeds have these errors. */
static struct results_cell cell_of(const char *label, const double *errors, size_t seeds)
{
    struct results_cell cell = results_make_cell(0.5, seeds, 0);
    cell.label = label;
    cell.has_chains = false;
    for (size_t i = 0; i < seeds; i++)
        for (int e = 0; e < RESULTS_ERRORS; e++)
            cell.runs[i].error[e] = errors[i];
    return cell;
}

static void set_init(struct set *set, size_t count)
{
    set->results = (struct results){.cells = set->cells, .cell_count = count};
    set->families = (struct families){0};
}

static void set_deinit(struct set *set)
{
    for (size_t i = 0; i < set->results.cell_count; i++)
        results_free_cell(&set->cells[i]);
}

static char *sentence(struct set *set, struct analysis_ranking *ranking)
{
    struct text text = {0};
    analysis_ranking_make(&set->results, &set->families, &set->cells[0], RESULTS_RELMSE,
                          ranking);
    analysis_append_best(&text, ranking);
    return text.data;
}

static void check_sentence(struct set *set, const char *expected)
{
    struct analysis_ranking ranking;
    char *text = sentence(set, &ranking);
    assert_string_equal(text, expected);
    mem_free(text);
    analysis_ranking_deinit(&ranking);
}

static void the_best_is_named(void **state)
{
    (void)state;
    const double pt[] = {1.0, 1.02, 0.98}, mlt[] = {3.0, 3.1, 2.9}, far[] = {9, 9.1, 8.9};
    struct analysis_ranking ranking;
    struct set set;
    set_init(&set, 3);
    set.cells[0] = cell_of("mlt", mlt, 3);
    set.cells[1] = cell_of("far", far, 3);
    set.cells[2] = cell_of("pt", pt, 3);
    set.cells[0].is_biased = true;
    char *text = sentence(&set, &ranking);
    assert_int_equal(ranking.count, 3);
    assert_true(ranking.items[0].cell == &set.cells[2] && ranking.noise == 0.0);
    struct interval ratio = interval_log_ratio(mlt, 3, pt, 3);
    near(ranking.items[1].ratio.value, ratio.value);
    near(ranking.items[1].ratio.hi, ratio.hi);
    assert_true(ranking.items[1].is_apart && ranking.items[2].is_apart);
    assert_string_equal(text,
                        "pt is best; mlt (biased) has 3 [2.8, 3.21] times its error, "
                        "far 9 [8.64, 9.38]; 3 seeds");
    mem_free(text);
    analysis_ranking_deinit(&ranking);
    /* A cell of another budget, or with a run that has no error, does not take part. */
    set.cells[1].budget = 2.0;
    set.cells[0].runs[1].error[RESULTS_RELMSE] = (double)NAN;
    set.cells[0].budget = 1.0;
    check_sentence(&set, "pt has 1, and nothing to compare with; 3 seeds");
    set_deinit(&set);
}

static void what_is_not_told_apart_is_said(void **state)
{
    (void)state;
    const double a[] = {1.0, 1.2}, b[] = {1.1, 1.3};
    struct set set;
    set_init(&set, 2);
    set.cells[0] = cell_of("a", a, 2);
    set.cells[1] = cell_of("b", b, 2);
    struct interval ratio = interval_log_ratio(b, 2, a, 2);
    char *expected = text_format("a is lowest, but not told apart from b; b has %.3g "
                                 "[%.3g, %.3g] times its error; 2 seeds",
                                 ratio.value, ratio.lo, ratio.hi);
    check_sentence(&set, expected);
    mem_free(expected);
    set.cells[0].run_count = set.cells[1].run_count = 1;
    check_sentence(&set, "a is lowest, but not told apart from b; b has 1.1 times its "
                         "error; 1 seed: nothing tells the differences from chance");
    set_deinit(&set);
}

/* Two single runs whose errors are their own: the ratio's interval is that of the error
 * bars, exp(+- 1.96 hypot(.1, .05)) about 2 and so on. */
static void error_bars_tell_single_runs_apart(void **state)
{
    (void)state;
    const double a[] = {1.0}, b[] = {2.0}, c[] = {1.1};
    struct analysis_ranking ranking;
    struct text text = {0};
    struct set set;
    set_init(&set, 3);
    set.cells[0] = cell_of("a", a, 1);
    set.cells[1] = cell_of("b", b, 1);
    set.cells[2] = cell_of("c", c, 1);
    set.cells[0].runs[0].estimated_se = 0.1;
    set.cells[1].runs[0].estimated_se = 0.1;
    set.cells[2].runs[0].estimated_se = 0.11;
    analysis_ranking_make(&set.results, &set.families, &set.cells[0], RESULTS_ESTIMATED,
                          &ranking);
    assert_true(ranking.by_bars && ranking.items[2].cell == &set.cells[1]);
    double width = exp(1.9599639845400536 * hypot(0.1, 0.05));
    near(ranking.items[2].ratio.lo, 2.0 / width);
    near(ranking.items[2].ratio.hi, 2.0 * width);
    assert_true(ranking.items[2].is_apart && !ranking.items[1].is_apart);
    analysis_append_best(&text, &ranking);
    assert_non_null(strstr(text.data, "1 seed: intervals by each run's own error bars"));
    mem_free(text.data);
    analysis_ranking_deinit(&ranking);
    set_deinit(&set);
}

/* Noise comes off if every error is above twice of it. */
static void noise_is_subtracted(void **state)
{
    (void)state;
    const double a[] = {1.0, 1.0}, b[] = {3.0, 3.0};
    struct analysis_ranking ranking;
    struct set set;
    set_init(&set, 2);
    set.cells[0] = cell_of("a", a, 2);
    set.cells[1] = cell_of("b", b, 2);
    set.cells[0].noise[RESULTS_RELMSE] = set.cells[1].noise[RESULTS_RELMSE] = 0.49;
    mem_free(sentence(&set, &ranking));
    near(ranking.items[1].ratio.value, 2.51 / 0.51);
    analysis_ranking_deinit(&ranking);
    set.cells[0].noise[RESULTS_RELMSE] = set.cells[1].noise[RESULTS_RELMSE] = 0.51;
    mem_free(sentence(&set, &ranking));
    near(ranking.items[1].ratio.value, 3.0);
    analysis_ranking_deinit(&ranking);
    set_deinit(&set);
}

/* Manual values beside an automatic one are regret's matter, unless there is no other
 * method. */
static void manual_values_stand_back(void **state)
{
    (void)state;
    const double one[] = {1.0, 1.01}, two[] = {2.0, 2.02}, half[] = {0.5, 0.505};
    struct set set;
    set_init(&set, 3);
    set.cells[0] = cell_of("auto", one, 2);
    set.cells[1] = cell_of("manual", half, 2);
    set.cells[2] = cell_of("pt", two, 2);
    const struct results_cell *manual[] = {&set.cells[1]};
    struct family family = {
        .name = "", .automatic = &set.cells[0], .manual = manual, .manual_count = 1};
    set.families = (struct families){.items = &family, .count = 1};
    struct analysis_ranking ranking;
    mem_free(sentence(&set, &ranking));
    assert_true(ranking.count == 2 && ranking.items[0].cell == &set.cells[0]);
    analysis_ranking_deinit(&ranking);
    set.cells[2].budget = 2.0;
    mem_free(sentence(&set, &ranking));
    assert_true(ranking.count == 2 && ranking.items[0].cell == &set.cells[1]);
    analysis_ranking_deinit(&ranking);
    set_deinit(&set);
}

/* --- regret over all cells -------------------------------------------------------- */

static struct results *load(const char *runs, const char *curves)
{
    char folder[] = "/tmp/etalon_words_XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *run_path = text_join(folder, "runs.csv");
    char *curve_path = text_join(folder, "curves.csv");
    assert_true(text_write_file(run_path, runs, strlen(runs), NULL));
    assert_true(text_write_file(curve_path, curves, strlen(curves), NULL));
    struct results *results = results_load(folder, NULL);
    assert_non_null(results);
    unlink(run_path);
    unlink(curve_path);
    rmdir(folder);
    mem_free(run_path);
    mem_free(curve_path);
    return results;
}

/* Errors of one seed on scenes a and b: by two rules, and p_l = .1, .5, .9 (.9 on a
 * alone). Regret is over the lowest manual value, 1 on a and 2 on b. */
static const struct {
    const char *scene, *p_l, *rule;
    double error;
} made[] = {
    {"a", "auto", "zsolnai2013", 1.5}, {"a", "auto", "tours", 1.0},
    {"a", "0.1", "tours", 2.0},        {"a", "0.5", "tours", 1.0},
    {"a", "0.9", "tours", 4.0},        {"b", "auto", "zsolnai2013", 4.0},
    {"b", "auto", "tours", 2.2},       {"b", "0.1", "tours", 2.0},
    {"b", "0.5", "tours", 5.0},
};

static struct results *make_results(void)
{
    struct text runs = {0}, curves = {0};
    text_append(&runs, "job,label,scene_label,integrator,seed,budget_seconds,p_l,"
                       "p_l_source,rule,relmse\n");
    text_append(&curves, "job,cpu_s,relmse\n");
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++) {
        bool automatic = strcmp(made[i].p_l, "auto") == 0;
        text_append(&runs, "j%zu,pssmlt p_l=%s%s%s,%s,pssmlt,1,5,%s,%s,%s,%g\n", i,
                    made[i].p_l, automatic ? " rule=" : "", automatic ? made[i].rule : "",
                    made[i].scene, automatic ? "0.4" : made[i].p_l,
                    automatic ? "auto" : "manual", made[i].rule, made[i].error);
        text_append(&curves, "j%zu,1,9\nj%zu,2,%g\n", i, i, made[i].error);
    }
    struct results *results = load(runs.data, curves.data);
    mem_free(runs.data);
    mem_free(curves.data);
    return results;
}

static void check_policy(const struct analysis_policy *policy, const char *name,
                         size_t cells, double mean, double worst, const char *in)
{
    assert_string_equal(policy->name, name);
    assert_int_equal(policy->cells, cells);
    near(policy->mean, mean);
    near(policy->worst, worst);
    assert_non_null(strstr(policy->worst_name, in));
}

static void regret_over_all_cells(void **state)
{
    (void)state;
    struct results *results = make_results();
    struct families families;
    struct analysis_summary summary;
    struct text text = {0};
    families_make(results, &families);
    analysis_summary_make(results, &families, RESULTS_CPU, RESULTS_RELMSE, &summary);
    assert_true(summary.count == 5 && summary.cells == 2);
    const struct analysis_policy *p = summary.items;
    const bool first = strstr(p[0].name, "tours") != NULL;
    check_policy(&p[first], "automatic, zsolnai2013", 2, sqrt(3.0), 2.0,
                 "b, 5 s, pssmlt");
    check_policy(&p[!first], "automatic, tours", 2, sqrt(1.1), 1.1, "b, 5 s, pssmlt");
    check_policy(&p[2], "p_l = 0.1", 2, sqrt(2.0), 2.0, "a, 5 s, pssmlt");
    check_policy(&p[3], "p_l = 0.5", 2, sqrt(2.5), 2.5, "b, 5 s, pssmlt");
    check_policy(&p[4], "p_l = 0.9", 1, 4.0, 4.0, "a, 5 s, pssmlt");
    assert_int_equal(p[4].left_out, 1);
    assert_ptr_equal(analysis_best_constant(&summary), &p[2]);
    analysis_append_regret(&text, &summary);
    assert_non_null(strstr(text.data,
                           "automatic, tours: 1.049 in the geometric mean of 2 "
                           "cells, 1.100 at worst (b, 5 s, pssmlt"));
    assert_non_null(strstr(text.data, "; best constant p_l = 0.1: 1.414 in"));
    mem_free(text.data);
    analysis_summary_deinit(&summary);
    families_deinit(&families);
    results_destroy(results);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_is_named),
        cmocka_unit_test(what_is_not_told_apart_is_said),
        cmocka_unit_test(error_bars_tell_single_runs_apart),
        cmocka_unit_test(noise_is_subtracted),
        cmocka_unit_test(manual_values_stand_back),
        cmocka_unit_test(regret_over_all_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
