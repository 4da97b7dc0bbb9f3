/* base/log: a repeated note is counted and keeps its first place. */
#include "base/log.h"

#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void check_print(const struct log *log, const char *expected)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    log_print(log, out);
    fclose(out);
    assert_string_equal(text, expected);
    free(text);
}

static void repetitions_are_counted(void **state)
{
    (void)state;
    struct log log;
    log_init(&log);
    for (int i = 0; i < 3; i++)
        log_note(&log, &(struct place){"a.pbrt", 10 + i, 2}, "filter '%s' left out",
                 "box");
    log_note(&log, NULL, "something else");
    assert_int_equal(log.count, 2);
    check_print(&log, "warning: a.pbrt:10:2: filter 'box' left out (3 times)\n"
                      "warning: something else\n");
    log_deinit(&log);
    assert_int_equal(log.count, 0);
}

static void merging_adds_counts(void **state)
{
    (void)state;
    struct log a, b;
    log_init(&a);
    log_init(&b);
    log_note(&a, &(struct place){"a", 1, 0}, "x");
    log_note(&b, &(struct place){"b", 2, 0}, "y");
    log_note(&b, &(struct place){"b", 3, 0}, "x");
    log_note(&b, NULL, "x");
    log_merge(&a, &b);
    log_deinit(&b); /* a keeps copies */
    check_print(&a, "warning: a:1: x (3 times)\nwarning: b:2: y\n");
    log_deinit(&a);
}

/* Remarks are printed, but are no losses; nor is what came after the first notes. */
static void remarks_are_no_losses(void **state)
{
    (void)state;
    struct log log, copy;
    log_init(&log);
    log_init(&copy);
    log_remark(&log, NULL, "the filter");
    log_note(&log, NULL, "a shape");
    log_remark(&log, NULL, "the filter");
    log_note(&log, NULL, "thin triangles");
    log_merge(&copy, &log);
    assert_int_equal(log_losses(&copy, 1), 0);
    assert_int_equal(log_losses(&copy, 2), 1);
    assert_int_equal(log_losses(&copy, 9), 2);
    check_print(&copy, "warning: the filter (2 times)\nwarning: a shape\n"
                       "warning: thin triangles\n");
    log_deinit(&log);
    log_deinit(&copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(remarks_are_no_losses),
        cmocka_unit_test(repetitions_are_counted),
        cmocka_unit_test(merging_adds_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
