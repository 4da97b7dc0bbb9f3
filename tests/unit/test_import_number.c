/* import/number: correctly rounded, as strtod, and nothing but decimal numbers. */
#include "import/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static void same_as_strtod(const char *text)
{
    double value = -1.0;
    const char *after = number_parse(text, &value);
    assert_non_null(after);
    if (*after != '\0' || value != strtod(text, NULL))
        print_message("%s: %.17g\n", text, value);
    assert_int_equal(*after, '\0');
    assert_true(value == strtod(text, NULL));
    assert_int_equal(signbit(value) != 0, text[0] == '-');
}

static void test_forms(void **state)
{
    static const char *const good[] = {"0",
                                       "-0",
                                       "+1",
                                       "1.",
                                       ".5",
                                       "-.5e-3",
                                       "1E5",
                                       "1e+05",
                                       "00012.500",
                                       "123456789012",
                                       "9007199254740993",
                                       "1e22",
                                       "1e23",
                                       "123456789e-22",
                                       "4.9e-324",
                                       "1e-400",
                                       "3.14159265358979323846264338327950288",
                                       "18446744073709551615",
                                       "18446744073709551616",
                                       "0.000000000000000000000000000000000000001"};
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        same_as_strtod(good[i]);
}

static void test_not_numbers(void **state)
{
    static const char *const bad[] = {"",    "-",   "+",    ".", "-.", "e5",
                                      "nan", "inf", "-inf", "x", " 1"};
    double value;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_null(number_parse(bad[i], &value));
}

static void test_ends_where_number_ends(void **state)
{
    static const struct {
        const char *text, *rest;
        double value;
    } rows[] = {{"1e", "e", 1.0},         {"1e+", "e+", 1.0}, {"0x10", "x10", 0.0},
                {"1.2.3", ".3", 1.2},     {"5]", "]", 5.0},   {"7-8", "-8", 7.0},
                {"1e400 ", " ", HUGE_VAL}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        double value;
        assert_string_equal(number_parse(rows[i].text, &value), rows[i].rest);
        assert_true(value == rows[i].value);
    }
}

/* Random numbers as programs print them, short and long. */
static void test_random(void **state)
{
    static const char *const formats[] = {"%.3g", "%.6f", "%.9g", "%.17g", "%.25e"};
    (void)state;
    srand(7);
    for (int i = 0; i < 200000; i++) {
        char text[400];
        double m = ((double)rand() / RAND_MAX - 0.5) * pow(10.0, rand() % 60 - 30);
        snprintf(text, sizeof text, formats[i % 5], m);
        same_as_strtod(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forms),
        cmocka_unit_test(test_not_numbers),
        cmocka_unit_test(test_ends_where_number_ends),
        cmocka_unit_test(test_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
