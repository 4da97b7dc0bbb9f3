/* lab/scalar: what is written reads back as the same value and the same type. */
#include "lab/scalar.h"

#include "base/doc.h"
#include "base/mem.h"
#include "math/rng.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void check_number(double value, const char *expected)
{
    struct text text = {0};
    scalar_append_number(&text, value);
    assert_string_equal(text.data, expected);
    mem_free(text.data);
}

static void numbers_are_short(void **state)
{
    (void)state;
    check_number(0.1, "0.1");
    check_number(-3.0, "-3");
    check_number(1.0 / 3.0, "0.3333333333333333");
    check_number(1e20, "1.0e+20");
    check_number(1.5e-300, "1.5e-300");
    check_number((double)NAN, ".nan");
    check_number((double)INFINITY, ".inf");
    check_number(-(double)INFINITY, "-.inf");
}

/* Random bit patterns: all exponents, denormals included. */
static void numbers_read_back(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_PIXEL, 0);
    int finite = 0;
    for (int i = 0; i < 100000; i++) {
        uint64_t bits = (uint64_t)(rng_double(&rng) * 0x1p32) << 32 |
                        (uint64_t)(rng_double(&rng) * 0x1p32);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        struct text text = {0};
        scalar_append_number(&text, value);
        double back = strtod(text.data, NULL);
        assert_memory_equal(&back, &value, sizeof value);
        const char *exponent = strchr(text.data, 'e');
        assert_true(exponent == NULL || memchr(text.data, '.', 24) != NULL);
        mem_free(text.data);
        finite++;
    }
    assert_true(finite > 90000);
}

static void check_string(const char *value, bool quoted)
{
    struct text text = {0};
    struct err err = {0};
    text_append(&text, "key: ");
    scalar_append_string(&text, value);
    assert_int_equal(text.data[5] == '"', quoted);
    text_append(&text, "\n");
    struct doc *doc = doc_parse(text.data, text.length, "test", &err);
    assert_non_null(doc);
    assert_string_equal(doc_text(doc_get(doc_root(doc), "key")), value);
    doc_destroy(doc);
    mem_free(text.data);
}

static void strings_read_back(void **state)
{
    (void)state;
    check_string("pssmlt", false);
    check_string("/a/b-c_d.pbrt", false);
    const char *mistaken[] = {"",      "1.5",    "true", "No",  "null", "~",
                              "a: b",  "#x",     " a",   "a b", "a,b",  "-",
                              "say\"", "back\\", "a\tb", "é",   "a\nb", ".nan"};
    for (size_t i = 0; i < sizeof mistaken / sizeof *mistaken; i++)
        check_string(mistaken[i], true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_short),
        cmocka_unit_test(numbers_read_back),
        cmocka_unit_test(strings_read_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
