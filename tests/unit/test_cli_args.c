/* cli/args: every way to spell an option, and every way to get it wrong. */
#include "cli/args.h"

#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define MAX_ARGS 16

static const struct arg_option first[] = {
    {"output", 'o', "FILE", NULL, ""}, {"quick", 'q', NULL, NULL, ""}, {0}};
static const struct arg_option second[] = {{"seed", 0, "N", "seed", ""}, {0}};
static const struct command command = {
    .name = "test", .operands = "A", .operand_count = 1, .groups = {first, second}};

/* The line is split at spaces. */
static bool parse(const char *line, struct args *args, struct err *err)
{
    static char copy[256], *argv[MAX_ARGS];
    int argc = 0;
    *err = (struct err){0};
    strncpy(copy, line, sizeof copy - 1);
    for (char *word = strtok(copy, " "); word && argc < MAX_ARGS;
         word = strtok(NULL, " "))
        argv[argc++] = word;
    return args_parse(&command, argc, argv, args, err);
}

static void check_output(const char *line, const char *expected)
{
    struct args args;
    struct err err;
    assert_true(parse(line, &args, &err));
    assert_int_equal(args.operand_count, 1);
    assert_string_equal(args.operands[0], "a");
    if (expected)
        assert_string_equal(args_value(&args, "output"), expected);
    else
        assert_null(args_value(&args, "output"));
    args_deinit(&args);
}

static void all_spellings(void **state)
{
    (void)state;
    check_output("a", NULL);
    check_output("a --output x", "x");
    check_output("--output x a", "x");
    check_output("--output=x a", "x");
    check_output("--output= a", "");
    check_output("-o x a", "x");
    check_output("-ox a", "x");
    check_output("a -o -", "-");
    check_output("--output=b=c a", "b=c");
    check_output("-o -1 a", "-1");
    check_output("-q -o x -- a", "x");
}

static void order_is_kept(void **state)
{
    (void)state;
    struct args args;
    struct err err;
    assert_true(parse("--seed 1 -q a --seed=2", &args, &err));
    assert_int_equal(args.given_count, 3);
    assert_string_equal(args.given[0].value, "1");
    assert_string_equal(args.given[0].option->setting, "seed");
    assert_string_equal(args.given[1].option->name, "quick");
    assert_string_equal(args.given[2].value, "2");
    assert_string_equal(args_value(&args, "seed"), "2");
    args_deinit(&args);
}

static void dashes_end_options(void **state)
{
    (void)state;
    struct args args;
    struct err err;
    assert_true(parse("-- --seed", &args, &err));
    assert_string_equal(args.operands[0], "--seed");
    assert_false(args.help);
    args_deinit(&args);
}

static void help_wins(void **state)
{
    (void)state;
    struct args args;
    struct err err;
    assert_true(parse("--nonsense --help", &args, &err));
    assert_true(args.help);
    args_deinit(&args);
    assert_true(parse("-h", &args, &err));
    assert_true(args.help);
    args_deinit(&args);
    assert_true(parse("-- --help", &args, &err));
    assert_false(args.help);
    args_deinit(&args);
}

static void check_refused(const char *line, const char *message)
{
    struct args args;
    struct err err;
    assert_false(parse(line, &args, &err));
    assert_int_equal(err.code, ERR_USAGE);
    assert_string_equal(err.message, message);
    args_deinit(&args);
}

static void mistakes_are_named(void **state)
{
    (void)state;
    check_refused("a --sede 1", "unknown option '--sede' (did you mean '--seed'?)");
    check_refused("a --outptu=x", "unknown option '--outptu' (did you mean '--output'?)");
    check_refused("a -z", "unknown option '-z'; see 'etalon test --help'");
    check_refused("a --zzzzzzzz",
                  "unknown option '--zzzzzzzz'; see 'etalon test --help'");
    check_refused("a --seed", "--seed needs a value: --seed N");
    check_refused("a --seed --quick", "--seed needs a value: --seed N");
    check_refused("a --quick=1", "--quick takes no value");
    check_refused("a -q1", "--quick takes no value");
    check_refused("", "usage: etalon test A");
    check_refused("a -o -q", "--output needs a value: --output FILE");
    check_refused("a -o x --output y", "--output is given twice: 'x' and 'y'");
    check_refused("a -ox -ox", "--output is given twice: 'x' and 'x'");
    check_refused("a b", "'b' is one too many; usage: etalon test A");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_spellings),      cmocka_unit_test(order_is_kept),
        cmocka_unit_test(dashes_end_options), cmocka_unit_test(help_wins),
        cmocka_unit_test(mistakes_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
