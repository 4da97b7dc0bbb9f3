/* The mean of the curves that runs predicted, from a made-up table. The test has no
 * randomness. */

#include "base/mem.h"
#include "report/report_predicted.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* last: it wants the four above */
#include <cmocka.h>

/* Work 2 - p in the first run, constant in the second one; the third fell back. */
#define TABLE                                                                     \
    "job,label,scene_label,integrator,seed,budget_seconds,p_l,p_l_source,relmse," \
    "p_l_zsolnai2013,predicted_p,predicted_relmse,predicted_cost\n"               \
    "a,pssmlt,box,pssmlt,1,5,0.5,auto,1,0.6,0.1 0.4 1,0.8 0.2 0.5,1.9 1.6 1\n"    \
    "b,pssmlt,box,pssmlt,2,5,0.4,auto,1,0.8,0.1 0.4 1,0.2 0.2 0.3,7 7 7\n"        \
    "c,pssmlt,box,pssmlt,3,5,0.9,auto,1,0.9,,,\n"

static struct results *load(const char *runs)
{
    char folder[] = "/tmp/etalon_predicted_XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *path = text_join(folder, "runs.csv");
    assert_true(text_write_file(path, runs, strlen(runs), NULL));
    struct results *results = results_load(folder, NULL);
    assert_non_null(results);
    unlink(path);
    rmdir(folder);
    mem_free(path);
    return results;
}

static void near(double value, double expected)
{
    if (fabs(value - expected) > 1e-12 * expected)
        fail_msg("%.17g instead of %.17g", value, expected);
}

static void test_means(void **state)
{
    (void)state;
    struct results *results = load(TABLE);
    struct report_predicted predicted;
    assert_int_equal(results->cell_count, 1);
    assert_int_equal(results->cells[0].run_count, 3);
    report_predicted_read(results, &results->cells[0], &predicted);
    assert_int_equal(predicted.runs, 2);
    assert_int_equal(predicted.count, 3);
    near(predicted.published, 0.7);
    near(predicted.p[1], 0.4);
    /* At the work of the chosen p_l: 1.5 in the first run. */
    near(predicted.error[0], sqrt(0.8 * 1.9 / 1.5 * 0.2));
    near(predicted.error[1], sqrt(0.2 * 1.6 / 1.5 * 0.2));
    near(report_predicted_at(&predicted, 0.2),
         sqrt(predicted.error[0] * predicted.error[1]));
    near(report_predicted_at(&predicted, 1.0), predicted.error[2]);
    results_destroy(results);
}

static char *legend(const struct report_predicted *predicted, size_t all)
{
    struct results_cell cell = {.scene = "box"};
    struct report_panels panels = {0};
    struct report_panel *panel = panels_add(&panels, FIGURE_PLARGE, &cell);
    report_predicted_draw(predicted, all, panel);
    char *words = text_copy(panel->legend.length ? panel->legend.data : "");
    panels_deinit(&panels);
    return words;
}

static void check_legend(const struct report_predicted *predicted, size_t all,
                         const char *expected)
{
    char *words = legend(predicted, all);
    assert_non_null(strstr(words, expected));
    mem_free(words);
}

/* How many of the runs made the curve, and the published value, are told. */
static void test_legend(void **state)
{
    (void)state;
    struct report_predicted predicted = {
        .p = {0.1, 1.0}, .error = {1.0, 2.0}, .count = 2, .published = 0.7, .runs = 2};
    check_legend(&predicted, 3, "predicted by the start (2 of 3 runs)");
    check_legend(&predicted, 2, "predicted by the start<");
    check_legend(&predicted, 2, "published value (zsolnai2013), as predicted<");
    predicted.runs = 0;
    char *words = legend(&predicted, 2);
    assert_string_equal(words, "");
    mem_free(words);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_legend),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
