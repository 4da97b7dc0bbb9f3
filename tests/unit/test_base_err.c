/* base/err: the first failure wins, places print only as far as they are known. */
#include "base/err.h"

#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void check_format(struct place at, const char *expected)
{
    struct err err = {0};
    char text[256];
    assert_false(err_set(&err, ERR_IO, &at, "no %s", "disk"));
    err_format(&err, text, (int)sizeof text);
    assert_string_equal(text, expected);
}

static void formats_what_is_known(void **state)
{
    (void)state;
    check_format((struct place){"a.yaml", 3, 14}, "a.yaml:3:14: no disk");
    check_format((struct place){"a.yaml", 3, 0}, "a.yaml:3: no disk");
    check_format((struct place){"a.yaml", 0, 0}, "a.yaml: no disk");
    check_format((struct place){NULL, 0, 0}, "no disk");
}

static void first_failure_wins(void **state)
{
    (void)state;
    struct err err = {0};
    assert_false(err_set(&err, ERR_VALUE, NULL, "first"));
    assert_false(err_set(&err, ERR_IO, NULL, "second"));
    assert_int_equal(err.code, ERR_VALUE);
    assert_string_equal(err.message, "first");
    assert_false(err_set(NULL, ERR_IO, NULL, "nobody listens"));
}

static void long_text_is_cut(void **state)
{
    (void)state;
    char big[4096], small[16];
    memset(big, 'x', sizeof big - 1);
    big[sizeof big - 1] = '\0';
    struct err err = {0};
    err_set(&err, ERR_IO, &(struct place){big, 1, 1}, "%s", big);
    assert_int_equal(strlen(err.message), sizeof err.message - 1);
    assert_int_equal(strlen(err.file), sizeof err.file - 1);
    err_format(&err, small, (int)sizeof small);
    assert_int_equal(strlen(small), sizeof small - 1);
}

static void stays_one_line(void **state)
{
    (void)state;
    struct err err = {0};
    char line[64];
    err_set(&err, ERR_IO, &(struct place){"a\nb", 1, 2}, "no '%s'",
            "x\n\033[2J\x7f\xc3\xa9");
    err_format(&err, line, (int)sizeof line);
    assert_string_equal(line, "a?b:1:2: no 'x??[2J?\xc3\xa9'");
    /* A lone byte, a control character of two, one cut short, four bytes, none at all. */
    err = (struct err){0};
    err_set(&err, ERR_IO, NULL, "%s", "\xff \xc2\x9b \xe2\x82 \xf0\x9f\x8e\xa8 \x80");
    assert_string_equal(err.message, "? ?? ?? \xf0\x9f\x8e\xa8 ?");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_what_is_known),
        cmocka_unit_test(first_failure_wins),
        cmocka_unit_test(long_text_is_cut),
        cmocka_unit_test(stays_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
