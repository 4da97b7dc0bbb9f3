/* Settings as a user gives them: every key, its range, its defaults, and what a refusal
 * says. */

#include "settings/setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static bool set(struct settings *s, const char *key, const char *value)
{
    struct err err = {0};
    bool ok = settings_set(s, key, value, NULL, &err);
    assert_true(ok == (err.code == 0));
    return ok;
}

/* The refusal's text; the settings must be as before. */
static const char *refusal(const char *key, const char *value)
{
    static char text[2000];
    struct settings before, s;
    struct err err = {0};
    struct place at = {"scene.yaml", 3, 7};
    settings_init(&s);
    memcpy(&before, &s, sizeof s);
    assert_false(settings_set(&s, key, value, &at, &err));
    assert_memory_equal(&before, &s, sizeof s);
    assert_int_equal(err.code, ERR_USAGE);
    err_format(&err, text, sizeof text);
    assert_non_null(strstr(text, "scene.yaml:3:7"));
    return text;
}

static void test_defaults(void **state)
{
    (void)state;
    struct settings s;
    struct err err = {0};
    settings_init(&s);
    assert_string_equal(s.integrator, "pssmlt");
    assert_true(settings_auto(&s) && isnan(s.p_large));
    assert_string_equal(settings_rule(&s), "tours");
    assert_string_equal(settings_kernel(&s)->name, "exponential");
    assert_int_equal(settings_estimator(&s), ESTIMATOR_KELEMEN);
    assert_string_equal(settings_mode(&s), "exact");
    s.integrator = "pfmlt";
    s.mode = "paper";
    assert_string_equal(settings_rule(&s), "zsolnai2013");
    s.mode = NULL;
    assert_string_equal(settings_rule(&s), "tours");
    s.integrator = "rjmlt";
    assert_string_equal(settings_mode(&s), "counted");
    assert_string_equal(settings_kernel(&s)->name, "exponential");
    s.mode = "exact";
    assert_string_equal(settings_kernel(&s)->name, "gaussian");
    settings_init(&s);
    assert_true(s.per == PER_ALL && s.allocation == ALLOCATION_ERROR);
    assert_int_equal(s.direct, DIRECT_DEFAULT);
    assert_int_equal(settings_plain_lengths(&s, 12), 2);
    assert_string_equal(s.builder, "bdpt");
    assert_int_equal(s.chains, 256);
    assert_int_equal(s.bootstrap, 100000);
    assert_int_equal(s.start_mutations, 64);
    assert_true(s.start == 0.02 && s.start_cap == 0.2);
    assert_true(s.s1 == 1.0 / 1024.0);
    assert_true(settings_s2(&s, 2500.0) == 0.08);
    assert_true(settings_sigma(&s, 2500.0) == 0.64 * 0.08);
    assert_true(settings_s2(&s, 1e9) == 1.0 / 256.0 && settings_s2(&s, 9.0) == 0.125);
    s.rule = "zsolnai2013";
    assert_true(settings_s2(&s, 2500.0) == 1.0 / 64.0);
    assert_true(settings_sigma(&s, 2500.0) == 0.01);
    s.s2 = 0.5;
    s.sigma = 0.3;
    assert_true(settings_s2(&s, 2500.0) == 0.5 && settings_sigma(&s, 2500.0) == 0.3);
    settings_init(&s);
    assert_true(s.mutations_per_pixel == 64.0 && s.seconds == 0.0);
    assert_true(s.seed == 1 && s.threads == 0 && !s.keep_all && !s.allow_zero);
    assert_true(s.max_depth == 0 && s.width == 0 && s.height == 0);
    assert_true(settings_check(&s, &err));
}

/* Numbers and counts: accepted at both ends, refused just beyond and if they are no
 * number; the refusal repeats the key, the value and what would be right. */
static const struct {
    const char *key, *low, *high, *below, *above;
    size_t offset;
    bool whole;
} ranges[] = {
    {"large_step_probability", "0", "1", "-1e-9", "1.0000001",
     offsetof(struct settings, p_large), false},
    {"sigma", "1e-9", "1", "0", "1.1", offsetof(struct settings, sigma), false},
    {"s1", "1e-12", "1", "0", "1.1", offsetof(struct settings, s1), false},
    {"s2", "1e-12", "1", "0", "1.1", offsetof(struct settings, s2), false},
    {"chains", "1", "1000000", "0", "1000001", offsetof(struct settings, chains), true},
    {"bootstrap", "1", "1000000000", "0", "1000000001",
     offsetof(struct settings, bootstrap), true},
    {"start", "0", "1", "-0.1", "1.1", offsetof(struct settings, start), false},
    {"start_cap", "0", "1", "-0.1", "1.1", offsetof(struct settings, start_cap), false},
    {"start_mutations", "1", "1000000000", "0", "1000000001",
     offsetof(struct settings, start_mutations), true},
    {"seconds", "1e-3", "1e9", "0", "1e10", offsetof(struct settings, seconds), false},
    {"mutations_per_pixel", "1e-6", "1e12", "0", "1e13",
     offsetof(struct settings, mutations_per_pixel), false},
    {"seed", "0", "9000000000000000", "-1", "9000000000000001",
     offsetof(struct settings, seed), true},
    {"threads", "0", "1024", "-1", "1025", offsetof(struct settings, threads), true},
};

static void check_taken(size_t offset, bool whole, const char *key, const char *value)
{
    struct settings s;
    settings_init(&s);
    assert_true(set(&s, key, value));
    const char *at = (const char *)&s + offset;
    double number = atof(value);
    long count;
    double x;
    memcpy(&count, at, sizeof count);
    memcpy(&x, at, sizeof x);
    assert_true(whole ? (double)count == number : x == number);
}

static void check_refused(const char *key, const char *value)
{
    const char *text = refusal(key, value);
    char quoted[80];
    snprintf(quoted, sizeof quoted, "%s: '%s' is not possible; give ", key, value);
    assert_non_null(strstr(text, quoted));
}

static void test_ranges(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        const char *key = ranges[i].key;
        check_taken(ranges[i].offset, ranges[i].whole, key, ranges[i].low);
        check_taken(ranges[i].offset, ranges[i].whole, key, ranges[i].high);
        check_refused(key, ranges[i].below);
        check_refused(key, ranges[i].above);
        check_refused(key, "nan");
        check_refused(key, "");
        check_refused(key, "3x");
        if (ranges[i].whole)
            check_refused(key, "1.5");
    }
}

static void test_words(void **state)
{
    (void)state;
    struct settings s;
    settings_init(&s);
    assert_true(set(&s, "integrator", "bdpt"));
    assert_string_equal(s.integrator, "bdpt");
    assert_true(set(&s, "kernel", "gaussian"));
    assert_ptr_equal(settings_kernel(&s), &kernel_gaussian);
    assert_true(set(&s, "estimator", "plain"));
    assert_int_equal(settings_estimator(&s), ESTIMATOR_PLAIN);
    assert_true(set(&s, "estimator", "kelemen"));
    assert_int_equal(settings_estimator(&s), ESTIMATOR_KELEMEN);
    assert_true(set(&s, "builder", "pt"));
    assert_string_equal(s.builder, "pt");
    assert_true(set(&s, "builder", "bdpt"));
    assert_string_equal(s.builder, "bdpt");
    assert_true(set(&s, "rule", "zsolnai2013"));
    assert_string_equal(settings_rule(&s), "zsolnai2013");
    assert_true(set(&s, "mode", "paper"));
    assert_string_equal(s.mode, "paper");
    assert_true(set(&s, "per", "length") && s.per == PER_LENGTH);
    assert_true(set(&s, "per", "all") && s.per == PER_ALL);
    assert_true(set(&s, "allocation", "brightness"));
    assert_int_equal(s.allocation, ALLOCATION_BRIGHTNESS);
    assert_true(set(&s, "allocation", "error"));
    assert_int_equal(s.allocation, ALLOCATION_ERROR);
    assert_true(set(&s, "direct", "separate") && s.direct == DIRECT_SEPARATE);
    assert_true(set(&s, "direct", "joint") && s.direct == DIRECT_JOINT);
    assert_true(set(&s, "keep_all", "true") && s.keep_all);
    assert_true(set(&s, "keep_all", "false") && !s.keep_all);
    assert_true(set(&s, "allow_zero", "true") && s.allow_zero);
    assert_true(set(&s, "large_step_probability", "0.25") && !settings_auto(&s));
    assert_true(set(&s, "large_step_probability", "auto") && settings_auto(&s));
    static const char *const words[] = {
        "integrator", "kernel",     "estimator", "builder",   "rule",
        "keep_all",   "allow_zero", "size",      "max_depth", "budget",
        "mode",       "per",        "direct",    "allocation"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        check_refused(words[i], "wrong");
}

static void test_size_and_depth(void **state)
{
    (void)state;
    struct settings s;
    settings_init(&s);
    assert_true(set(&s, "size", "640x1") && s.width == 640 && s.height == 1);
    assert_true(set(&s, "size", "1x65536") && s.width == 1 && s.height == 65536);
    static const char *const sizes[] = {"640",  "640x",    "x480",  "0x1",
                                        "1x0",  "-4x4",    "4x4x4", "65537x1",
                                        "4 x4", "1x65537", "4x4 "};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        check_refused("size", sizes[i]);
    assert_true(set(&s, "max_depth", "1") && s.max_depth == 1);
    assert_true(set(&s, "max_depth", "64") && s.max_depth == 64);
    assert_true(set(&s, "max_depth", "-1") && s.max_depth == SETTINGS_MAX_DEPTH);
    check_refused("max_depth", "0");
    check_refused("max_depth", "65");
    check_refused("max_depth", "-2");
}

/* The scene file's own depth serves where none is set, cut to what is possible. */
static void test_depth_of_scene(void **state)
{
    (void)state;
    struct settings s;
    struct scene scene = {.max_depth = 0};
    settings_init(&s);
    assert_int_equal(settings_depth(&s, &scene), SETTINGS_DEFAULT_DEPTH);
    scene.max_depth = 7;
    assert_int_equal(settings_depth(&s, &scene), 7);
    scene.max_depth = 1000;
    assert_int_equal(settings_depth(&s, &scene), SETTINGS_MAX_DEPTH);
    s.max_depth = 3;
    assert_int_equal(settings_depth(&s, &scene), 3);
}

/* Of two budgets the later counts. */
static void test_budget(void **state)
{
    (void)state;
    struct settings s;
    settings_init(&s);
    assert_true(set(&s, "seconds", "2.5"));
    assert_true(s.seconds == 2.5 && s.mutations_per_pixel == 0.0);
    assert_true(set(&s, "mutations_per_pixel", "9"));
    assert_true(s.seconds == 0.0 && s.mutations_per_pixel == 9.0);
    assert_true(set(&s, "budget", "seconds=3"));
    assert_true(s.seconds == 3.0 && s.mutations_per_pixel == 0.0);
    assert_true(set(&s, "budget", "mutations_per_pixel=128"));
    assert_true(s.seconds == 0.0 && s.mutations_per_pixel == 128.0);
    assert_non_null(strstr(refusal("budget", "seconds=-1"), "seconds: '-1'"));
    assert_non_null(strstr(refusal("budget", "60"), "seconds=S or mutations_per_pixel"));
}

static void test_unknown_key(void **state)
{
    (void)state;
    const char *text = refusal("chain", "3");
    assert_non_null(strstr(text, "unknown setting 'chain'"));
    assert_non_null(strstr(text, "did you mean 'chains'?"));
    for (int i = 0; settings_row(i); i++)
        assert_non_null(strstr(text, settings_row(i)->name));
    assert_null(strstr(refusal("zzzzzzzzzzzz", "3"), "did you mean"));
}

static const char *check_fails(const struct settings *s)
{
    static char text[2000];
    struct err err = {0};
    assert_false(settings_check(s, &err));
    assert_int_equal(err.code, ERR_USAGE);
    err_format(&err, text, sizeof text);
    return text;
}

static void test_combinations(void **state)
{
    (void)state;
    struct settings s;
    struct err err = {0};
    settings_init(&s);
    s.p_large = 0.0;
    assert_non_null(strstr(check_fails(&s), "allow_zero=true"));
    s.allow_zero = true;
    assert_true(settings_check(&s, &err));
    s.replicas = 1;
    s.until_relmse = 0.1;
    assert_non_null(strstr(check_fails(&s), "need error bars, which replicas=1"));
    s.until_relmse = 0.0;
    assert_true(settings_check(&s, &err));
    s.until_converged = true;
    check_fails(&s);
    s.replicas = 8;
    assert_true(settings_check(&s, &err));
    s.integrator = "pfmlt";
    assert_true(settings_check(&s, &err));
    s.mode = "paper";
    assert_non_null(strstr(check_fails(&s), "which mode paper does without"));
    s.integrator = "pssmlt";
    s.mode = "exact";
    s.until_converged = false;
    s.s1 = 0.1;
    assert_non_null(strstr(
        check_fails(&s), "s1 (0.1) must be less than s2 (0.00390625 in large pictures)"));
    s.s2 = 0.1;
    check_fails(&s);
    s.s2 = 0.2;
    assert_true(settings_check(&s, &err));
    s.s1 = 1.0 / 1024.0;
    s.s2 = 1e-4;
    check_fails(&s);
    s.s2 = 1.0 / 64.0;
    s.start = 0.3;
    assert_non_null(strstr(check_fails(&s), "start (0.3) must not exceed start_cap"));
    s.start_cap = 0.3;
    assert_true(settings_check(&s, &err));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),       cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_words),          cmocka_unit_test(test_size_and_depth),
        cmocka_unit_test(test_depth_of_scene), cmocka_unit_test(test_budget),
        cmocka_unit_test(test_unknown_key),    cmocka_unit_test(test_combinations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
