/* base/json: what is written is read back by base/doc, whatever a text holds. */
#include "base/json.h"

#include "base/doc.h"
#include "base/mem.h"

#include <math.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static struct doc *parsed(struct json *json)
{
    struct err err = {0};
    struct doc *doc = doc_parse(json->text.data, strlen(json->text.data), "json", &err);
    if (!doc)
        fail_msg("%s in\n%s", err.message, json->text.data);
    mem_free(json->text.data);
    return doc;
}

static void values_come_back(void **state)
{
    (void)state;
    struct json json = {0};
    json_open(&json, NULL, '{');
    json_number(&json, "pi", 3.25);
    json_number(&json, "nothing", (double)NAN);
    json_open(&json, "empty", '[');
    json_close(&json, '[');
    json_open(&json, "list", '[');
    json_count(&json, NULL, -7);
    json_flag(&json, NULL, true);
    json_text(&json, NULL, NULL);
    json_close(&json, '[');
    json_close(&json, '{');
    struct doc *doc = parsed(&json);
    const struct doc_node *root = doc_root(doc), *list = doc_get(root, "list");
    double pi;
    assert_true(doc_to_double(doc_get(root, "pi"), &pi, NULL));
    assert_true(pi == 3.25);
    assert_string_equal(doc_text(doc_get(root, "nothing")), "null");
    assert_int_equal(doc_kind(doc_get(root, "empty")), DOC_LIST);
    assert_int_equal(doc_count(doc_get(root, "empty")), 0);
    assert_int_equal(doc_count(list), 3);
    assert_string_equal(doc_text(doc_item(list, 0)), "-7");
    assert_string_equal(doc_text(doc_item(list, 1)), "true");
    assert_string_equal(doc_text(doc_item(list, 2)), "null");
    doc_destroy(doc);
}

static void check_text(const char *written, const char *read)
{
    struct json json = {0};
    json_open(&json, NULL, '{');
    json_text(&json, written, written);
    json_close(&json, '{');
    struct doc *doc = parsed(&json);
    assert_string_equal(doc_key(doc_root(doc), 0), read);
    assert_string_equal(doc_text(doc_item(doc_root(doc), 0)), read);
    doc_destroy(doc);
}

static void texts_come_back(void **state)
{
    (void)state;
    static const char *const texts[] = {"plain",
                                        "a \"quoted\" \\ word",
                                        "a\nb\tc\x01\x1f",
                                        "gr\xc3\xbc\xc3\x9f",
                                        "\xe2\x82\xac \xf0\x9f\x98\x80",
                                        ": {not} [a] #list, 'nor' & *a"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        check_text(texts[i], texts[i]);
}

#define NONE "\xef\xbf\xbd" /* U+FFFD */

static void what_is_no_utf8_is_marked(void **state)
{
    (void)state;
    check_text("a\xff"
               "b",
               "a" NONE "b");
    check_text("cut \xe2\x82", "cut " NONE NONE);
    check_text("\xc0\x80", NONE NONE);          /* too long a form of U+0000 */
    check_text("\xed\xa0\x80", NONE NONE NONE); /* half of a pair */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_come_back),
        cmocka_unit_test(texts_come_back),
        cmocka_unit_test(what_is_no_utf8_is_marked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
