/* base/doc: YAML and JSON trees whose every error knows file:line:col. */
#include "base/doc.h"

#include "base/mem.h"
#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static struct doc *parse(const char *text)
{
    struct err err = {0};
    struct doc *doc = doc_parse(text, strlen(text), "f.yaml", &err);
    if (!doc)
        print_message("%s\n", err.message);
    assert_non_null(doc);
    return doc;
}

static void check_bad(const char *text, const char *expected)
{
    struct err err = {0};
    char line[1200];
    assert_null(doc_parse(text, strlen(text), "f.yaml", &err));
    err_format(&err, line, (int)sizeof line);
    if (!strstr(line, expected))
        print_message("'%s' lacks '%s'\n", line, expected);
    assert_non_null(strstr(line, expected));
}

static void check_place(struct place at, int line, int col)
{
    assert_string_equal(at.file, "f.yaml");
    assert_int_equal(at.line, line);
    assert_int_equal(at.col, col);
}

static void tree_has_places(void **state)
{
    (void)state;
    struct doc *doc = parse("a: 1\nlist:\n  - x\n  - {k: [2, 3.5]}\n");
    const struct doc_node *root = doc_root(doc);
    assert_int_equal(doc_kind(root), DOC_MAP);
    assert_int_equal(doc_count(root), 2);
    assert_string_equal(doc_key(root, 1), "list");
    check_place(doc_key_place(root, 1), 2, 1);
    const struct doc_node *list = doc_get(root, "list");
    assert_ptr_equal(list, doc_item(root, 1));
    assert_int_equal(doc_kind(list), DOC_LIST);
    check_place(doc_place(doc_item(list, 0)), 3, 5);
    assert_string_equal(doc_text(doc_item(list, 0)), "x");
    const struct doc_node *pair = doc_get(doc_item(list, 1), "k");
    double values[2] = {0};
    assert_true(doc_to_doubles(pair, values, 2, NULL));
    assert_true(values[0] == 2.0 && values[1] == 3.5);
    check_place(doc_place(doc_item(pair, 1)), 4, 13);
    assert_null(doc_get(root, "b"));
    assert_null(doc_get(list, "a"));
    assert_string_equal(doc_text(list), "");
    assert_int_equal(doc_count(doc_item(list, 0)), 0);
    doc_destroy(doc);
    doc_destroy(NULL);
}

static void json_is_read_too(void **state)
{
    (void)state;
    struct doc *doc = parse("{\"a\": [1, true, \"t\\u00e9\"],\n \"b\": {}}");
    const struct doc_node *a = doc_get(doc_root(doc), "a");
    assert_string_equal(doc_text(doc_item(a, 2)), "t\xc3\xa9");
    assert_int_equal(doc_count(doc_get(doc_root(doc), "b")), 0);
    doc_destroy(doc);
}

static void bad_documents_name_the_place(void **state)
{
    (void)state;
    check_bad("a: 1\nb: 2\n a: 3\n", "f.yaml:3:");
    check_bad("a: 1\nb: 2\na: 3\n", "f.yaml:3:1: key 'a' is already given at line 1");
    check_bad("x: {b: 1, c: 2, b: 3}", "f.yaml:1:17: key 'b' is already");
    check_bad("a: 1\n---\nb: 2\n", "f.yaml:2:1: a second document");
    check_bad("a: 1\n...\nb: [", "f.yaml:3:");
    check_bad("", "f.yaml: the file is empty");
    check_bad("# only a comment\n", "the file is empty");
    check_bad("a: [1, 2\nb: 3\n", "f.yaml:");
    check_bad("a:\n\tb: 1\n", "f.yaml:2:1");
    check_bad("a: 1\nb: x\xff\n", "f.yaml:2:5: invalid");
    check_bad("a: *nobody\n", "f.yaml:1:4");
    check_bad("? [1]\n: 2\n", "f.yaml:1:3: a key must be plain text");
    check_bad("a: \"x\\0y\"\n", "f.yaml:1:4: text with a zero byte");
}

static void aliases_share_but_never_loop(void **state)
{
    (void)state;
    struct doc *doc = parse("a: &x {k: 5}\nb: *x\n");
    long value = 0;
    assert_true(doc_to_long(doc_get(doc_get(doc_root(doc), "b"), "k"), &value, NULL));
    assert_int_equal(value, 5);
    doc_destroy(doc);
    check_bad("&a [*a]", "f.yaml:1:1: this node contains itself");
    check_bad("a: &a\n  b: [1, *a]\n", "f.yaml:1:4: this node contains itself");
    check_bad("a: &a [1,1,1,1,1,1,1,1,1,1]\n"
              "b: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\n"
              "c: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\n"
              "d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\n"
              "e: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]\n"
              "f: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e,*e]\n"
              "g: [*f,*f,*f,*f,*f,*f,*f,*f,*f,*f]\n",
              "f.yaml:7:4: aliases make this node stand for more than");
}

static char *nested(int levels)
{
    char *text = mem_alloc((size_t)levels * 2 + 1, 1);
    memset(text, '[', (size_t)levels);
    memset(text + levels, ']', (size_t)levels);
    return text;
}

static void depth_is_bounded(void **state)
{
    (void)state;
    char *text = nested(64);
    doc_destroy(parse(text));
    mem_free(text);
    text = nested(65);
    check_bad(text, "f.yaml:1:65: nested deeper than 64 levels");
    mem_free(text);
    text = nested(100000);
    check_bad(text, "f.yaml:1:");
    mem_free(text);
    /* An alias brings its height along: 40 levels below 30. */
    char *low = nested(40), *high = nested(30);
    high[30] = '\0';
    text = text_format("a: &a %s\nb: %s*a%.*s\n", low, high, 30,
                       "]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]");
    check_bad(text, "nested deeper than 64 levels");
    mem_free(text);
    mem_free(low);
    mem_free(high);
}

static void check_message(struct err *err, const char *expected)
{
    char line[1200];
    err_format(err, line, (int)sizeof line);
    assert_string_equal(line, expected);
    *err = (struct err){0};
}

static void conversions_are_strict(void **state)
{
    (void)state;
    struct doc *doc = parse("n: 1.5\nw: many\nl: [1, x]\nb: yes\ne:\nq: ''\n");
    const struct doc_node *root = doc_root(doc);
    struct err err = {0};
    double x, xs[3];
    long n;
    bool b;
    const char *s;
    assert_true(doc_to_double(doc_get(root, "n"), &x, &err));
    assert_true(doc_to_text(doc_get(root, "q"), &s, &err));
    assert_false(doc_to_long(doc_get(root, "n"), &n, &err));
    check_message(&err, "f.yaml:1:4: expected a whole number, got '1.5'");
    assert_false(doc_to_double(doc_get(root, "w"), &x, &err));
    check_message(&err, "f.yaml:2:4: expected a finite number, got 'many'");
    assert_false(doc_to_doubles(doc_get(root, "l"), xs, 3, &err));
    check_message(&err, "f.yaml:3:4: expected a list of 3 numbers, got 2");
    assert_false(doc_to_doubles(doc_get(root, "l"), xs, 2, &err));
    check_message(&err, "f.yaml:3:8: expected a finite number, got 'x'");
    assert_false(doc_to_doubles(doc_get(root, "n"), xs, 1, &err));
    check_message(&err, "f.yaml:1:4: expected a list of numbers, got '1.5'");
    assert_false(doc_to_bool(doc_get(root, "b"), &b, &err));
    check_message(&err, "f.yaml:4:4: expected true or false, got 'yes'");
    assert_false(doc_to_text(doc_get(root, "e"), &s, &err));
    check_message(&err, "f.yaml:5:3: expected text, got nothing");
    assert_false(doc_to_text(root, &s, &err));
    check_message(&err, "f.yaml:1:1: expected text, got a map");
    doc_destroy(doc);
}

static void unknown_keys_suggest(void **state)
{
    (void)state;
    const char *const allowed[] = {"seed", "chains", "max_depth", NULL};
    struct doc *doc = parse("seed: 1\nmaxdepth: 3\n");
    struct err err = {0};
    assert_false(doc_check_keys(doc_root(doc), allowed, &err));
    check_message(&err, "f.yaml:2:1: unknown key 'maxdepth' (did you mean 'max_depth'?); "
                        "allowed: seed, chains, max_depth");
    assert_false(doc_check_keys(doc_get(doc_root(doc), "seed"), allowed, &err));
    check_message(&err, "f.yaml:1:7: expected a map, got '1'");
    doc_destroy(doc);
    doc = parse("chains: 1\nzzz: 3\n");
    assert_false(doc_check_keys(doc_root(doc), allowed, &err));
    check_message(&err,
                  "f.yaml:2:1: unknown key 'zzz'; allowed: seed, chains, max_depth");
    doc_destroy(doc);
    doc = parse("chains: 1\nseed: 3\n");
    assert_true(doc_check_keys(doc_root(doc), allowed, &err));
    doc_destroy(doc);
}

/* No prefix of a document and no flipped byte may crash or leak (run under san). */
static void damaged_documents_do_no_harm(void **state)
{
    (void)state;
    const char *whole = "a: &x {k: [1, 2], 'q': \"s\\n\"}\nb:\n  - *x\n  - |\n    text\n";
    size_t size = strlen(whole);
    char *copy = text_copy(whole);
    for (size_t i = 0; i < size; i++) {
        struct err err = {0};
        doc_destroy(doc_parse(whole, i, "f.yaml", &err));
        for (int bit = 0; bit < 8; bit++) {
            struct err flip = {0};
            copy[i] = (char)(whole[i] ^ (1 << bit));
            struct doc *doc = doc_parse(copy, size, "f.yaml", &flip);
            assert_true((doc != NULL) == (flip.code == ERR_NONE));
            doc_destroy(doc);
        }
        copy[i] = whole[i];
    }
    mem_free(copy);
}

static void missing_files_are_named(void **state)
{
    (void)state;
    struct err err = {0};
    assert_null(doc_load("no/such.yaml", &err));
    check_message(&err, "cannot open 'no/such.yaml': No such file or directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tree_has_places),
        cmocka_unit_test(json_is_read_too),
        cmocka_unit_test(bad_documents_name_the_place),
        cmocka_unit_test(aliases_share_but_never_loop),
        cmocka_unit_test(depth_is_bounded),
        cmocka_unit_test(conversions_are_strict),
        cmocka_unit_test(unknown_keys_suggest),
        cmocka_unit_test(damaged_documents_do_no_harm),
        cmocka_unit_test(missing_files_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
