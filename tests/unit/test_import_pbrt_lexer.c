/* import/pbrt/pbrt_lexer and pbrt_params: tokens, included files, typed parameters; each
 * error with its line and column. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "import/pbrt/pbrt_params.h"
#include "support/import_test.h"

#include <unistd.h>

struct fixture {
    struct scene_desc *desc;
    struct pbrt_lexer lexer;
    struct pbrt_params params;
};

static void open_text(struct fixture *f, const char *text)
{
    const char *path = import_test_write("t.pbrt", text);
    *f = (struct fixture){.desc = scene_desc_create(path)};
    struct err err = {0};
    assert_true(pbrt_lexer_init(&f->lexer, f->desc, path, &err));
}

static void close_text(struct fixture *f)
{
    pbrt_params_deinit(&f->params);
    pbrt_lexer_deinit(&f->lexer);
    scene_desc_destroy(f->desc);
}

static void expect(struct fixture *f, enum pbrt_token_kind kind, const char *text,
                   double number, int line, int col)
{
    struct pbrt_token t;
    struct err err = {0};
    assert_true(pbrt_lexer_next(&f->lexer, &t, &err));
    assert_int_equal(t.kind, kind);
    assert_string_equal(t.text, text);
    assert_true(t.number == number);
    assert_int_equal(t.place.line, line);
    assert_int_equal(t.place.col, col);
}

static void test_tokens(void **state)
{
    struct fixture f;
    (void)state;
    open_text(&f, "Shape# a comment \"x\n\t\"a \\\"b\\\" \\n\"[1 -2.5e1]\r\n .5#end");
    expect(&f, PBRT_TOKEN_WORD, "Shape", 0.0, 1, 1);
    expect(&f, PBRT_TOKEN_STRING, "a \"b\" \n", 0.0, 2, 2);
    expect(&f, PBRT_TOKEN_OPEN, "", 0.0, 2, 14);
    expect(&f, PBRT_TOKEN_NUMBER, "", 1.0, 2, 15);
    expect(&f, PBRT_TOKEN_NUMBER, "", -25.0, 2, 17);
    expect(&f, PBRT_TOKEN_CLOSE, "", 0.0, 2, 23);
    expect(&f, PBRT_TOKEN_NUMBER, "", 0.5, 3, 2);
    expect(&f, PBRT_TOKEN_END, "", 0.0, 3, 8);
    expect(&f, PBRT_TOKEN_END, "", 0.0, 3, 8);
    close_text(&f);
}

static void bad_token(const char *text, const char *expected)
{
    struct fixture f;
    struct pbrt_token t;
    struct err err = {0};
    open_text(&f, text);
    while (pbrt_lexer_next(&f.lexer, &t, &err))
        assert_int_not_equal(t.kind, PBRT_TOKEN_END);
    import_test_error_is(&err, expected);
    close_text(&f);
}

static void test_bad_tokens(void **state)
{
    (void)state;
    bad_token("A\n  \"open\nB", "t.pbrt:2:3: string without a closing quote");
    bad_token("\"end", "t.pbrt:1:1: string without a closing quote");
    bad_token("\"a\\q\"", "t.pbrt:1:3: unknown escape");
    bad_token("1 2x 3", "t.pbrt:1:3: \"2x\" is not a number");
    bad_token("[ 0x10", "t.pbrt:1:3: \"0x10\" is not a number");
    bad_token("\n -inf", "t.pbrt:2:2: \"-inf\" is not a number");
    bad_token("1e39", "t.pbrt:1:1: number beyond the range of float");
    bad_token("-3.5e38", "t.pbrt:1:1: number beyond the range of float");
    bad_token("1 1e999", "t.pbrt:1:3: number beyond the range of float");
    bad_token("A 'b'",
              "t.pbrt:1:3: unexpected byte 0x27; strings stand in double quotes");
    bad_token("A \x01", "t.pbrt:1:3: unexpected byte 0x01");
}

static void test_nul_byte(void **state)
{
    static const char bytes[] = "A \0 B";
    struct err err = {0};
    struct pbrt_lexer lexer;
    struct pbrt_token t;
    (void)state;
    const char *path = import_test_write_bytes("nul.pbrt", bytes, sizeof bytes - 1);
    struct scene_desc *desc = scene_desc_create(path);
    assert_true(pbrt_lexer_init(&lexer, desc, path, &err));
    assert_true(pbrt_lexer_next(&lexer, &t, &err));
    assert_false(pbrt_lexer_next(&lexer, &t, &err));
    import_test_error_is(&err, ":1:3: unexpected byte 0x00");
    pbrt_lexer_deinit(&lexer);
    scene_desc_destroy(desc);
}

static void test_include_goes_on_behind(void **state)
{
    struct fixture f;
    struct err err = {0};
    (void)state;
    char inner[512];
    snprintf(inner, sizeof inner, "%s", import_test_write("inner.pbrt", "\n In"));
    open_text(&f, "A B");
    struct pbrt_token t;
    assert_true(pbrt_lexer_next(&f.lexer, &t, &err));
    assert_true(pbrt_lexer_include(&f.lexer, inner, &t.place, &err));
    assert_true(pbrt_lexer_next(&f.lexer, &t, &err));
    assert_string_equal(t.text, "In");
    assert_string_equal(t.place.file, inner);
    assert_int_equal(t.place.line, 2);
    expect(&f, PBRT_TOKEN_WORD, "B", 0.0, 1, 3);
    close_text(&f);
}

static void test_include_cycle_and_missing(void **state)
{
    struct fixture f;
    struct err err = {0}, missing = {0};
    struct place at = {"t.pbrt", 9, 4};
    (void)state;
    open_text(&f, "A");
    assert_false(pbrt_lexer_include(&f.lexer, import_test_path("./t.pbrt"), &at, &err));
    import_test_error_is(&err, "t.pbrt:9:4: ");
    import_test_error_is(&err, "includes itself");
    assert_false(
        pbrt_lexer_include(&f.lexer, import_test_path("no.pbrt"), &at, &missing));
    import_test_error_is(&missing, "t.pbrt:9:4: ");
    close_text(&f);
}

static void test_include_depth(void **state)
{
    struct fixture f;
    struct err err = {0};
    struct place at = {"t.pbrt", 1, 1};
    (void)state;
    open_text(&f, "A");
    for (int i = 1; i < PBRT_INCLUDE_DEPTH; i++) {
        char name[32];
        snprintf(name, sizeof name, "deep%d.pbrt", i);
        assert_true(
            pbrt_lexer_include(&f.lexer, import_test_write(name, "B"), &at, &err));
    }
    assert_false(
        pbrt_lexer_include(&f.lexer, import_test_write("last.pbrt", "C"), &at, &err));
    import_test_error_is(&err, "more than 32 files include one another");
    close_text(&f);
}

static bool parse(struct fixture *f, const char *text, int heads, struct err *err)
{
    struct place at = {"t.pbrt", 1, 1};
    open_text(f, text);
    return pbrt_params_parse(&f->params, &f->lexer, heads, true, &at, err);
}

static void test_param_values(void **state)
{
    struct fixture f;
    struct err err = {0};
    double radius = 0.0, absent = 7.0;
    int n = 0;
    bool flag = false;
    (void)state;
    assert_true(parse(&f,
                      "\"kind\" \"float radius\" 2.5 \"integer n\" [ -3 ] \"bool flag\" "
                      "\"true\" \"string s\" [\"x y\"] \"point3 P\" [1 2 3 4 5 6] "
                      "\" rgb\tKd \" [.1 .2 .3] \"texture t\" \"wood\"\nNext",
                      1, &err));
    assert_string_equal(pbrt_params_head(&f.params, 0), "kind");
    assert_true(pbrt_params_float(&f.params, "radius", &radius, &err));
    assert_true(pbrt_params_float(&f.params, "absent", &absent, &err));
    assert_true(pbrt_params_int(&f.params, "n", &n, &err));
    assert_true(pbrt_params_bool(&f.params, "flag", &flag, &err));
    assert_true(radius == 2.5 && absent == 7.0 && n == -3 && flag);
    const struct pbrt_param *s = pbrt_params_find(&f.params, "s", PBRT_STRING);
    assert_string_equal(pbrt_params_text(&f.params, s), "x y");
    const struct pbrt_param *p = pbrt_params_find(&f.params, "P", PBRT_POINT);
    assert_int_equal(p->count, 6);
    assert_true(pbrt_params_numbers(&f.params, p)[5] == 6.0);
    assert_null(pbrt_params_find(&f.params, "Kd", PBRT_FLOAT));
    assert_non_null(pbrt_params_find(&f.params, "Kd", PBRT_COLOUR));
    expect(&f, PBRT_TOKEN_WORD, "Next", 0.0, 2, 1);
    close_text(&f);
}

/* Only what nobody asked for is reported, with its place. */
static void test_unused(void **state)
{
    struct fixture f;
    struct err err = {0};
    (void)state;
    assert_true(parse(&f, "\"k\" \"float a\" 1\n  \"integer b\" 2", 1, &err));
    double a;
    assert_true(pbrt_params_float(&f.params, "a", &a, &err));
    assert_true(pbrt_params_float(&f.params, "b", &a, &err)); /* b is no float */
    pbrt_params_report(&f.params, "Shape", &f.desc->log);
    assert_int_equal(f.desc->log.count, 1);
    import_test_note(f.desc, "unused parameter \"integer b\" of Shape \"k\"", 1, 2);
    close_text(&f);
}

static void test_later_of_two_counts(void **state)
{
    struct fixture f;
    struct err err = {0};
    double a = 0.0;
    (void)state;
    assert_true(parse(&f, "\"k\" \"float a\" 1 \"float a\" 2", 1, &err));
    assert_true(pbrt_params_float(&f.params, "a", &a, &err));
    assert_true(a == 2.0);
    pbrt_params_report(&f.params, "Shape", &f.desc->log);
    assert_int_equal(f.desc->log.count, 1);
    close_text(&f);
}

static void bad_params(const char *text, const char *expected)
{
    struct fixture f;
    struct err err = {0};
    assert_false(parse(&f, text, 1, &err));
    import_test_error_is(&err, expected);
    close_text(&f);
}

static void test_bad_params(void **state)
{
    (void)state;
    bad_params("3", ":1:1: expected a quoted name, got 3");
    bad_params("\"k\" 5",
               ":1:5: expected a parameter (\"type name\") or a directive, got 5");
    bad_params("\"k\" \"radius\" 5", ":1:5: parameter \"radius\" is not of the form");
    bad_params("\"k\" \"float a b\" 5", ":1:5: parameter \"float a b\" is not of");
    bad_params("\"k\" \"flot a\" 5",
               ":1:5: unknown parameter type \"flot\"; did you mean \"float\"?");
    bad_params("\"k\" \"float a\" \"5\"", ":1:15: expected a number, got \"5\"");
    bad_params("\"k\" \"float a\" nan", ":1:15: expected a number, got nan");
    bad_params("\"k\" \"integer a\" 1.5",
               ":1:17: expected an integer of 32 bits, got 1.5");
    bad_params("\"k\" \"integer a\" 3e9",
               ":1:17: expected an integer of 32 bits, got 3e+09");
    bad_params("\"k\" \"bool a\" \"yes\"",
               ":1:14: expected \"true\" or \"false\", got \"yes\"");
    bad_params("\"k\" \"bool a\" 1", ":1:14: expected \"true\" or \"false\", got 1");
    bad_params("\"k\" \"string a\" 1", ":1:16: expected a string, got 1");
    bad_params("\"k\" \"string a\" [\"x\" \"y\"]", ":1:21: expected one string here");
    bad_params("\"k\" \"spectrum a\" [1 \"y\"]", ":1:21: ");
    bad_params("\"k\" \"spectrum a\" [\"y\" 1]", ":1:23: expected a string, got 1");
    bad_params("\"k\"\n\"rgb a\" [1 2]", ":2:1: \"rgb a\" holds 2 numbers");
    bad_params("\"k\"\n\"float a\" [1 2", ":2:1: the brackets of this parameter");
    bad_params("\"k\" \"float a\"", "expected a number, got the end of the file");
    bad_params("\"k\" \"float a\" [[1]]", ":1:16: expected a number, got [");
}

static void test_bad_single_values(void **state)
{
    struct fixture f;
    double a;
    bool b;
    (void)state;
    struct err err = {0}, err_bool = {0};
    assert_true(parse(&f, "\"k\" \"float a\" [1 2] \"bool b\" []", 1, &err));
    assert_false(pbrt_params_float(&f.params, "a", &a, &err));
    import_test_error_is(&err, ":1:5: \"float a\" holds 2 values, one is wanted");
    assert_false(pbrt_params_bool(&f.params, "b", &b, &err_bool));
    import_test_error_is(&err_bool, ":1:21: \"bool b\" holds 0 values, one is wanted");
    close_text(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tokens),
        cmocka_unit_test(test_bad_tokens),
        cmocka_unit_test(test_nul_byte),
        cmocka_unit_test(test_include_goes_on_behind),
        cmocka_unit_test(test_include_cycle_and_missing),
        cmocka_unit_test(test_include_depth),
        cmocka_unit_test(test_param_values),
        cmocka_unit_test(test_unused),
        cmocka_unit_test(test_later_of_two_counts),
        cmocka_unit_test(test_bad_params),
        cmocka_unit_test(test_bad_single_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
