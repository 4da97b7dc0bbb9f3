/* The predicted curve in a terminal: a made-up parabola in ln p with its least error at
 * p = .3, so that each printed figure is known. The test has no randomness. */

#include "cli/curve_text.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* last: it wants the four above */
#include <cmocka.h>

#define LEAST   0.3
#define AXIS    9  /* column of p_l = 0 in a line */
#define COLUMNS 60 /* from there to p_l = 1 */

static char *printed(const struct run_statistics *s)
{
    static char *text; /* the stream keeps its address */
    static size_t size;
    FILE *out = open_memstream(&text, &size);
    curve_print(s, out);
    fclose(out);
    return text;
}

/* relMSE .01 at p = .3 with two units of work; times 1 + ln^2(p / .3). */
static struct run_statistics made(void)
{
    struct run_statistics s = {.p_l_zsolnai2013 = 0.75};
    s.tours.found = s.tours.curve.whole = true;
    for (int i = 0; i < TOURS_POINTS; i++) {
        double l = log(tours_p[i] / LEAST);
        s.tours.curve.relmse[i] = 0.01 * (1.0 + l * l);
        s.tours.curve.cost[i] = 2.0;
    }
    s.plarge = (struct plarge){.p_l = LEAST, .p_l_lo = 0.2, .p_l_hi = 0.5};
    strcpy(s.plarge.reason, "as it was made up");
    return s;
}

/* The line that contains `part`, up to its end; the caller frees it. */
static char *line_with(const char *text, const char *part)
{
    const char *at = strstr(text, part);
    assert_non_null(at);
    while (at > text && at[-1] != '\n')
        at--;
    return strndup(at, strcspn(at, "\n"));
}

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at += strlen(part))
        count++;
    return count;
}

static void check_line(const char *text, const char *part, const char *expected)
{
    char *line = line_with(text, part);
    assert_string_equal(line, expected);
    free(line);
}

static void test_table(void **state)
{
    (void)state;
    struct run_statistics s = made();
    char *text = printed(&s);
    check_line(text, "<- chosen", "#  0.300       0.01     2.00    1.00  <- chosen");
    /* Linear in ln p between the logarithms at .7 and .8. */
    check_line(text, "<- zsolnai2013",
               "#  0.750     0.0184     2.00    1.84  <- zsolnai2013");
    check_line(text, "#  0.100 ", "#  0.100     0.0221     2.00    2.21");
    /* Every p of the curve and the two that are marked. */
    assert_int_equal(count_of(text, "     2.00  "), TOURS_POINTS + 2);
    const char *chosen = strstr(text, "<- chosen");
    assert_true(strstr(text, "#  0.250 ") < chosen && chosen < strstr(text, "#  0.400 "));
    free(text);
}

static void test_plot(void **state)
{
    (void)state;
    struct run_statistics s = made();
    char *text = printed(&s), *row = line_with(text, "#  1.00 |");
    assert_true(strlen(row) > AXIS + 18 && row[AXIS + 18] == 'C'); /* .3 of 60 */
    free(row);
    row = line_with(text, "Z");
    free(row);
    for (const char *at = text; (at = strstr(at, " |")) != NULL; at++) {
        const char *z = strchr(at, 'Z'), *end = at + strcspn(at, "\n");
        if (z && z < end)
            assert_int_equal(z - at - 2, 45); /* .75 of 60 */
        /* Nothing is drawn beyond p_l = 1, and no line ends with a blank. */
        assert_true(end - at - 2 <= COLUMNS + 1 && end[-1] != ' ');
    }
    row = line_with(text, "99 % interval");
    assert_true(row[AXIS + 12] == '[' && row[AXIS + 18] == 'C' && row[AXIS + 30] == ']');
    free(row);
    check_line(text, "p_l = 0.300;", "# p_l = 0.300; zsolnai2013: 0.750");
    check_line(text, "as it was", "# as it was made up");
    free(text);
}

/* Where the published rule decided there is one row for both. */
static void test_fallback(void **state)
{
    (void)state;
    struct run_statistics s = made();
    s.plarge.p_l = s.p_l_zsolnai2013;
    char *text = printed(&s);
    check_line(text, "<- chosen",
               "#  0.750     0.0184     2.00    1.00  <- chosen: zsolnai2013");
    assert_int_equal(count_of(text, "<-"), 1);
    free(text);
    s.tours.found = false;
    text = printed(&s);
    assert_string_equal(text, "# p_l = 0.750; zsolnai2013: 0.750\n# as it was made up\n");
    free(text);
    s.p_l_zsolnai2013 = (double)NAN;
    text = printed(&s);
    assert_string_equal(text, "");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_plot),
        cmocka_unit_test(test_fallback),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
