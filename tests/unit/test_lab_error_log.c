/* lab/error_log: header and rows are in the file as soon as they are made. */
#include "lab/error_log.h"

#include "base/mem.h"
#include "base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define HEADER                                                                        \
    "wall_s,cpu_s,paths,mutations_per_pixel,rmse,relmse,relmse_trimmed,mean_ratio,b," \
    "b_se,eta_s_run,eta_l_run,eta_0_run,acceptance,failure_rate,n_nonfinite,"         \
    "n_saturated\n"
#define FIGURES ",2,0.5,0.75,0.375,0.5,0.625,0.25,3,4\n"

static void check_content(const char *path, const char *expected)
{
    struct err err = {0};
    size_t size;
    char *content = text_read_file(path, &size, NULL, &err);
    assert_non_null(content);
    assert_string_equal(content, expected);
    mem_free(content);
}

static void rows_are_there_at_once(void **state)
{
    (void)state;
    char path[] = "/tmp/etalon_error_log_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0 && write(fd, "older", 5) == 5);
    close(fd);
    struct err err = {0};
    struct error_log *log = error_log_create(path, &err);
    assert_non_null(log);
    check_content(path, HEADER);
    struct error_row row = {.wall_s = 0.5,
                            .cpu_s = 1.0,
                            .paths = 1e6,
                            .mutations_per_pixel = 16.0,
                            .metric = {.rmse = 0.25,
                                       .relmse = 0.125,
                                       .relmse_trimmed = 0.0625,
                                       .mean_ratio = 1.5},
                            .b = 2.0,
                            .b_se = 0.5,
                            .eta_s = 0.75,
                            .eta_l = 0.375,
                            .eta_0 = 0.5,
                            .acceptance = 0.625,
                            .failure_rate = 0.25,
                            .nonfinite = 3.0,
                            .saturated = 4.0};
    assert_true(error_log_append(log, &row, &err));
    check_content(path, HEADER "0.5,1,1000000,16,0.25,0.125,0.0625,1.5" FIGURES);
    row.metric.mean_ratio = (double)NAN;
    assert_true(error_log_append(log, &row, &err));
    check_content(path, HEADER "0.5,1,1000000,16,0.25,0.125,0.0625,1.5" FIGURES
                               "0.5,1,1000000,16,0.25,0.125,0.0625,.nan" FIGURES);
    error_log_destroy(log);
    unlink(path);
}

static void failures_are_told(void **state)
{
    (void)state;
    struct err err = {0};
    assert_null(error_log_create("/nowhere/at/all.csv", &err));
    assert_int_equal(err.code, ERR_IO);
    if (access("/dev/full", W_OK) == 0) {
        err = (struct err){0};
        assert_null(error_log_create("/dev/full", &err));
        assert_int_equal(err.code, ERR_IO);
    }
    error_log_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_there_at_once),
        cmocka_unit_test(failures_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
