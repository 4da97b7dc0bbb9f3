/* base/hash: the published values of FNV-1a, and that ends of texts count. */
#include "base/hash.h"

#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void known_values(void **state)
{
    (void)state;
    static const struct {
        const char *text, *digits;
    } known[] = {
        {"", "cbf29ce484222325"},
        {"a", "af63dc4c8601ec8c"},
        {"foobar", "85944171f73967e8"},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        struct hash hash;
        char digits[HASH_DIGITS + 1];
        hash_init(&hash);
        hash_bytes(&hash, known[i].text, strlen(known[i].text));
        hash_digits(&hash, digits);
        assert_string_equal(digits, known[i].digits);
    }
}

static void ends_count(void **state)
{
    (void)state;
    struct hash a, b;
    hash_init(&a);
    hash_init(&b);
    hash_text(&a, "ab");
    hash_text(&a, "c");
    hash_text(&b, "a");
    hash_text(&b, "bc");
    assert_true(a.value != b.value);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_values),
        cmocka_unit_test(ends_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
