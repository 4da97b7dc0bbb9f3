/* lab/store and lab/csv: what is written is read back; what a batch left that died is
 * removed; tables of other columns are refused, missing columns added; parts are taken
 * over; the reference's noise is subtracted. */
#include "lab/store.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static char *path_in(const char *folder, const char *name)
{
    return text_format("%s/%s", folder, name);
}

static void write_in(const char *folder, const char *name, const char *text)
{
    struct err err = {0};
    char *path = path_in(folder, name);
    assert_true(text_write_file(path, text, strlen(text), &err));
    mem_free(path);
}

static char *read_in(const char *folder, const char *name)
{
    struct err err = {0};
    size_t size;
    char *path = path_in(folder, name), *text = text_read_file(path, &size, NULL, &err);
    assert_non_null(text);
    mem_free(path);
    return text;
}

static int set_up(void **state)
{
    char folder[] = "/tmp/etalon_store_XXXXXX";
    assert_non_null(mkdtemp(folder));
    *state = text_copy(folder);
    return 0;
}

static int tear_down(void **state)
{
    static const char *const names[] = {"r/images/a.exr",
                                        "r/images/b.exr.part7",
                                        "r/images/b.exr",
                                        "r/images",
                                        "r/lock",
                                        "r/runs.csv",
                                        "r/curves.csv",
                                        "r",
                                        "t.csv",
                                        "",
                                        NULL};
    for (int i = 0; names[i]; i++) {
        char *path = path_in(*state, names[i]);
        if (unlink(path) != 0)
            rmdir(path);
        mem_free(path);
    }
    mem_free(*state);
    return 0;
}

/* --- csv ------------------------------------------------------------------------- */

static void any_text_comes_back(void **state)
{
    static const char *const cells[] = {
        "", "plain", "a,b", "say \"x\"", "\"", "two\nlines", " blank ", "1e-3", "r\r\nn"};
    enum { COUNT = sizeof cells / sizeof cells[0] };
    struct text text = {0};
    for (int row = 0; row < 2; row++) {
        struct text line = {0};
        for (int i = 0; i < COUNT; i++)
            csv_append(&line, cells[(i + row) % COUNT]);
        text_append(&text, "%s\n", line.data);
        mem_free(line.data);
    }
    write_in(*state, "t.csv", text.data);
    struct err err = {0};
    char *path = path_in(*state, "t.csv");
    struct csv *csv = csv_read(path, &err);
    assert_non_null(csv);
    assert_int_equal(csv->rows, 2);
    assert_int_equal(csv->columns, COUNT);
    assert_int_equal(csv->whole, text.length);
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < COUNT; i++)
            assert_string_equal(csv_cell(csv, (size_t)row, i), cells[(i + row) % COUNT]);
    assert_int_equal(csv_column(csv, "a,b"), 2);
    assert_int_equal(csv_column(csv, "none"), -1);
    assert_string_equal(csv_cell(csv, 1, -1), "");
    assert_true(csv_number(csv, 1, 6) == 1e-3 && isnan(csv_number(csv, 1, 0)));
    csv_destroy(csv);
    mem_free(path);
    mem_free(text.data);
}

static void half_a_line_is_no_row(void **state)
{
    struct err err = {0};
    char *path = path_in(*state, "t.csv");
    write_in(*state, "t.csv", "a,b\n1,2\n3,");
    struct csv *csv = csv_read(path, &err);
    assert_non_null(csv);
    assert_int_equal(csv->rows, 2);
    assert_int_equal(csv->whole, 8);
    assert_string_equal(csv_cell(csv, 1, 1), "2");
    csv_destroy(csv);
    write_in(*state, "t.csv", "a,b\n\"x\ny\",2\n3\n");
    assert_null(csv_read(path, &err));
    assert_int_equal(err.line, 4);
    mem_free(path);
}

static void refused(const char *folder, const char *text, size_t size, int line)
{
    struct err err = {0};
    char *path = path_in(folder, "t.csv");
    assert_true(text_write_file(path, text, size, &err));
    assert_null(csv_read(path, &err));
    assert_int_equal(err.line, line);
    mem_free(path);
}

static void what_would_lose_rows_is_refused(void **state)
{
    static const char open[] = "a,b\n1,2\n\"3,4\n5,6\n", twice[] = "a,b,a\n1,2,3\n";
    static const char zero[] = "a,b\n1,2\n3\0,4\n5,6\n";
    refused(*state, open, sizeof open - 1, 3);
    refused(*state, twice, sizeof twice - 1, 1);
    refused(*state, zero, sizeof zero - 1, 3);
    struct err err = {0};
    char *path = path_in(*state, "t.csv");
    write_in(*state, "t.csv",
             "\xef\xbb\xbf"
             "a,b\r\n1,2\r\n");
    struct csv *csv = csv_read(path, &err);
    assert_non_null(csv);
    assert_int_equal(csv_column(csv, "a"), 0);
    assert_int_equal(csv->whole, 13);
    csv_destroy(csv);
    mem_free(path);
}

/* --- the store ------------------------------------------------------------------- */

static struct statistics_record example(void)
{
    return (struct statistics_record){
        .scene = "a, \"b\".pbrt",
        .left_out = "lens, quadrics",
        .p_l_source = "auto",
        .p_l_reason = "r = 0.5: flat",
        .commit = "0123abc",
        .compiler = "cc",
        .flags = "-O3",
        .rays = "rays",
        .chains = true,
        .width = 31,
        .settings = {.integrator = "pssmlt",
                     .kernel = "gaussian",
                     .estimator = "plain",
                     .builder = "pt",
                     .rule = "zsolnai2013"},
        .run = {.statistics = {.b = 0.1, .b_se = (double)INFINITY}},
    };
}

static bool append(struct store *store, const char *job, const struct metric *metric,
                   struct err *err)
{
    struct statistics_record record = example();
    struct error_row curve[] = {{.wall_s = 0.5, .paths = 3.0}, {.wall_s = 1.5}};
    struct store_result result = {.job = job,
                                  .label = "pssmlt, plain",
                                  .scene_label = "a",
                                  .experiment = "e",
                                  .cell = "0123456789abcdef",
                                  .record = &record,
                                  .metric = metric,
                                  .flip = 0.0625,
                                  .curve = curve,
                                  .curve_count = metric ? 2 : 0};
    return store_append(store, &result, err);
}

static struct store *open_in(const char *folder, struct err *err)
{
    char *path = path_in(folder, "r");
    struct store *store = store_open(path, false, err);
    mem_free(path);
    return store;
}

static struct csv *runs_in(const char *folder)
{
    struct err err = {0};
    char *path = path_in(folder, "r");
    struct csv *runs = store_read_runs(path, &err);
    assert_int_equal(err.code, ERR_NONE);
    mem_free(path);
    return runs;
}

static void check_cell(const struct csv *runs, size_t row, const char *column,
                       const char *value)
{
    assert_string_equal(csv_cell(runs, row, csv_column(runs, column)), value);
}

static void rows_come_back(void **state)
{
    struct err err = {0};
    struct metric metric = {.rmse = 0.25,
                            .relmse = 0.5,
                            .relmse_trimmed = 0.125,
                            .mean_ratio = 1.5,
                            .smape = 0.375};
    assert_null(runs_in(*state));
    struct store *store = open_in(*state, &err);
    assert_non_null(store);
    assert_true(append(store, "a", &metric, &err) && append(store, "b", NULL, &err));
    store_close(store);
    struct csv *runs = runs_in(*state);
    assert_int_equal(runs->rows, 3);
    assert_int_equal(runs->columns, 3 + statistics_count() + 16);
    for (int i = 0; i < statistics_count(); i++)
        assert_int_equal(csv_column(runs, statistics_name(i)), 3 + i);
    check_cell(runs, 1, "job", "a");
    check_cell(runs, 1, "label", "pssmlt, plain");
    check_cell(runs, 1, "scene_label", "a");
    check_cell(runs, 1, "experiment", "e");
    check_cell(runs, 1, "cell", "0123456789abcdef");
    check_cell(runs, 1, "scene", "a, \"b\".pbrt");
    check_cell(runs, 1, "mode", "");
    check_cell(runs, 1, "width", "31");
    check_cell(runs, 1, "b_se", ".inf");
    check_cell(runs, 1, "relmse", "0.5");
    check_cell(runs, 1, "mean_ratio", "1.5");
    check_cell(runs, 1, "smape", "0.375");
    check_cell(runs, 1, "flip", "0.0625");
    check_cell(runs, 2, "relmse", ".nan");
    check_cell(runs, 2, "smape", ".nan");
    check_cell(runs, 2, "flip", ".nan");
    assert_true(store_has_job(runs, "b") && !store_has_job(runs, "c"));
    assert_false(store_has_job(runs, "job"));
    csv_destroy(runs);
    char *curves = read_in(*state, "r/curves.csv");
    assert_non_null(strstr(curves, "\na,0.5,0,3,"));
    mem_free(curves);
}

/* Killed between curves and row, in a row, in a picture. */
static void what_a_dead_batch_left_is_removed(void **state)
{
    struct err err = {0};
    struct metric metric = {.relmse = 0.5};
    struct store *store = open_in(*state, &err);
    assert_true(append(store, "a", &metric, &err));
    store_close(store);
    char *runs = read_in(*state, "r/runs.csv"), *curves = read_in(*state, "r/curves.csv");
    char *more_runs = text_format("%sb,\"pssm", runs);
    char *more_curves = text_format(
        "%sb,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17\nb,1,2", curves);
    write_in(*state, "r/runs.csv", more_runs);
    write_in(*state, "r/curves.csv", more_curves);
    write_in(*state, "r/images/b.exr.part7", "half a picture");
    write_in(*state, "r/images/a.exr", "a picture");
    store = open_in(*state, &err);
    assert_non_null(store);
    char *path = path_in(*state, "r/images/b.exr.part7");
    assert_int_equal(access(path, F_OK), -1);
    mem_free(path);
    char *runs_now = read_in(*state, "r/runs.csv");
    char *curves_now = read_in(*state, "r/curves.csv");
    char *picture = read_in(*state, "r/images/a.exr");
    assert_string_equal(runs_now, runs);
    assert_string_equal(curves_now, curves);
    store_close(store);
    mem_free(runs);
    mem_free(curves);
    mem_free(more_runs);
    mem_free(more_curves);
    mem_free(runs_now);
    mem_free(curves_now);
    mem_free(picture);
}

/* Of the same length, shorter, none. */
static void other_columns_are_refused(void **state)
{
    struct err err = {0};
    store_close(open_in(*state, &err));
    char *other = read_in(*state, "r/runs.csv");
    memcpy(strstr(other, ",kernel,"), ",kernal,", 8);
    const char *const texts[] = {other, "job,label,scene_label,other\n", ""};
    for (int i = 0; i < 3; i++) {
        err = (struct err){0};
        write_in(*state, "r/runs.csv", texts[i]);
        assert_null(open_in(*state, &err));
        assert_non_null(strstr(err.message, "columns are not those of this program"));
        assert_non_null(strstr(err.file, "runs.csv"));
    }
    mem_free(other);
}

/* Columns missing and in another order; half a row is none. */
static void missing_columns_are_added(void **state)
{
    struct err err = {0};
    store_close(open_in(*state, &err));
    write_in(*state, "r/runs.csv",
             "scene_label,job,relmse\n\"s,1\",a,0.25\nt,b,0.5\nu,c");
    struct store *store = open_in(*state, &err);
    assert_non_null(store);
    assert_true(store_upgraded(store));
    store_close(store);
    store = open_in(*state, &err);
    assert_false(store_upgraded(store));
    store_close(store);
    struct csv *runs = runs_in(*state);
    assert_int_equal(runs->rows, 3);
    assert_int_equal(runs->columns, 3 + statistics_count() + 16);
    check_cell(runs, 1, "job", "a");
    check_cell(runs, 1, "scene_label", "s,1");
    check_cell(runs, 2, "relmse", "0.5");
    check_cell(runs, 2, "label", ".nan");
    check_cell(runs, 2, "relmse_corrected", ".nan");
    csv_destroy(runs);
}

/* Also where a batch died between the picture and the row. */
static void a_part_is_taken_over(void **state)
{
    struct err err = {0};
    struct metric metric = {.relmse = 0.5};
    char *folder = path_in(*state, "p");
    struct store *store = open_in(*state, &err), *part = store_open(folder, true, &err);
    assert_true(append(store, "a", &metric, &err) && append(part, "b", &metric, &err));
    assert_false(store_take(store, part, "b", &err)); /* there is no picture */
    assert_int_equal(err.code, ERR_IO);
    write_in(folder, "images/b.exr", "a picture");
    write_in(*state, "r/images/b.exr", "an older one");
    assert_true(store_take(store, part, "b", NULL));
    char *picture = read_in(*state, "r/images/b.exr");
    assert_string_equal(picture, "a picture");
    assert_false(store_take(store, part, "c", NULL)); /* there is no row */
    store_remove(part);
    assert_int_equal(access(folder, F_OK), -1);
    store_close(store);
    struct csv *runs = runs_in(*state);
    char *curves = read_in(*state, "r/curves.csv");
    assert_int_equal(runs->rows, 3);
    check_cell(runs, 2, "job", "b");
    check_cell(runs, 2, "label", "pssmlt, plain");
    check_cell(runs, 2, "scene", "a, \"b\".pbrt");
    const char *of_a = strstr(curves, "\na,"), *of_b = strstr(curves, "\nb,");
    assert_true(of_a && of_b && strlen(of_a) > strlen(of_b));
    assert_memory_equal(of_b + 2, of_a + 2, strcspn(of_a + 2, "\n"));
    csv_destroy(runs);
    mem_free(curves);
    mem_free(picture);
    mem_free(folder);
}

/* The noise adds to the square of an error; what is left keeps its sign. */
static void noise_of_the_reference_is_subtracted(void **state)
{
    struct err err = {0};
    struct statistics_record record = example();
    struct metric metrics[] = {{.rmse = 0.5, .relmse = 0.75, .relmse_trimmed = 0.5},
                               {.rmse = 0.3, .relmse = 0.25, .relmse_trimmed = 0.125}};
    struct reference reference = {
        .noise = {.rmse = 0.4, .relmse = 0.5, .relmse_trimmed = 0.25}};
    struct store *store = open_in(*state, &err);
    for (int i = 0; i < 2; i++) {
        struct store_result result = {.job = i ? "b" : "a",
                                      .label = "",
                                      .scene_label = "",
                                      .experiment = "",
                                      .cell = "",
                                      .record = &record,
                                      .metric = &metrics[i],
                                      .reference = &reference,
                                      .reference_path = "../mean, 1.exr"};
        assert_true(store_append(store, &result, &err));
    }
    store_close(store);
    struct csv *runs = runs_in(*state);
    check_cell(runs, 1, "reference", "../mean, 1.exr");
    check_cell(runs, 1, "reference_rmse", "0.4");
    check_cell(runs, 1, "reference_relmse", "0.5");
    check_cell(runs, 1, "relmse_corrected", "0.25");
    check_cell(runs, 2, "relmse_corrected", "-0.25");
    check_cell(runs, 1, "reference_relmse_trimmed", "0.25");
    check_cell(runs, 1, "relmse_trimmed_corrected", "0.25");
    check_cell(runs, 2, "relmse_trimmed_corrected", "-0.125");
    check_cell(runs, 2, "relmse_trim", "0.01");
    double above = csv_number(runs, 1, csv_column(runs, "rmse_corrected"));
    double below = csv_number(runs, 2, csv_column(runs, "rmse_corrected"));
    assert_true(fabs(above - 0.3) < 1e-15 && fabs(below + sqrt(0.07)) < 1e-15);
    csv_destroy(runs);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(any_text_comes_back),
        TEST(half_a_line_is_no_row),
        TEST(what_would_lose_rows_is_refused),
        TEST(rows_come_back),
        TEST(what_a_dead_batch_left_is_removed),
        TEST(other_columns_are_refused),
        TEST(missing_columns_are_added),
        TEST(a_part_is_taken_over),
        TEST(noise_of_the_reference_is_subtracted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
