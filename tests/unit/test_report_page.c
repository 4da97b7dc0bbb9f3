/* Pieces of the report: text as HTML, figures, pictures packed so that little is lost. */

#include "base/mem.h"
#include "report/report_encode.h"
#include "report/report_html.h"
#include "math/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
/* last: it wants the four above */
#include <cmocka.h>

static void test_text(void **state)
{
    (void)state;
    struct text html = {0};
    html_text(&html, "a<b> & \"c\" 'd' \u00e9");
    assert_string_equal(html.data, "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39; \u00e9");
    mem_free(html.data);
}

static void check_figure(double value, int decimals, const char *expected)
{
    struct text html = {0};
    html_figure(&html, value, decimals);
    assert_string_equal(html.data, expected);
    mem_free(html.data);
}

static void test_figures(void **state)
{
    (void)state;
    check_figure(0.01234, HTML_SIGNIFICANT, "0.0123");
    check_figure(1234.6, HTML_SIGNIFICANT, "1235");
    check_figure(1.5, HTML_SIGNIFICANT, "1.50");
    check_figure(-2.5e-7, HTML_SIGNIFICANT, "-2.50e-7");
    check_figure(3e12, HTML_SIGNIFICANT, "3.00e12");
    check_figure(0.0, HTML_SIGNIFICANT, "0.00");
    check_figure(0.99996, 4, "1.0000");
    check_figure((double)NAN, 2, "\u2013");
    check_figure((double)INFINITY, HTML_SIGNIFICANT, "\u221e");
}

static void test_interval(void **state)
{
    (void)state;
    struct interval interval = {0.5, 0.25, 1.0}, alone = {0.5, (double)NAN, (double)NAN};
    struct text html = {0};
    html_cell_interval(&html, &interval, 2);
    assert_string_equal(html.data, "<td class=\"number\" data-value=\"0.5\">0.50</td>"
                                   "<td class=\"range\">0.25\u2009\u2026\u20091.00</td>");
    html.length = 0;
    html_cell_interval(&html, &alone, 2);
    assert_string_equal(html.data, "<td class=\"number\" data-value=\"0.5\">0.50</td>"
                                   "<td class=\"range\"></td>");
    mem_free(html.data);
}

/* --- pictures, unpacked by the description in the header -------------------------- */

static unsigned char *from_base64(const char *text, size_t *size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char *bytes = mem_alloc(strlen(text), 1);
    uint32_t bits = 0;
    int held = 0;
    *size = 0;
    for (; *text && *text != '='; text++) {
        bits = bits << 6 | (uint32_t)(strchr(digits, *text) - digits);
        held += 6;
        if (held >= 8)
            bytes[(*size)++] = (unsigned char)(bits >> (held -= 8) & 255);
    }
    return bytes;
}

static double from_half(uint16_t half)
{
    int exponent = half >> 10 & 31, rest = half & 1023;
    double size = exponent == 31  ? (rest ? (double)NAN : (double)INFINITY)
                  : exponent == 0 ? ldexp(rest, -24)
                                  : ldexp(1024 + rest, exponent - 25);
    return half & 0x8000 ? -size : size;
}

static uint16_t number_at(const unsigned char *bytes, const uint16_t *done, size_t plane,
                          int width, int height, size_t i)
{
    size_t pixels = (size_t)width * (size_t)height, w = (size_t)width;
    uint16_t z = (uint16_t)(bytes[2 * plane * pixels + i] |
                            bytes[(2 * plane + 1) * pixels + i] << 8);
    uint16_t difference = (uint16_t)(z >> 1 ^ (z & 1 ? 0xffff : 0));
    uint16_t guess = 0;
    if (i >= w && i % w > 0)
        guess = (uint16_t)(((int16_t)done[i - 1] + (int16_t)done[i - w]) >> 1);
    else if (i > 0)
        guess = i < w ? done[i - 1] : done[i - w];
    return (uint16_t)(guess + difference);
}

static void unpack(const char *base64, int exponent, int shift, struct image *image)
{
    size_t packed_size, pixels = (size_t)image->width * (size_t)image->height;
    unsigned char *packed = from_base64(base64, &packed_size);
    uLongf size = (uLongf)(6 * pixels);
    unsigned char *bytes = mem_alloc(size, 1);
    uint16_t *numbers = mem_alloc(3 * pixels, sizeof *numbers);
    assert_int_equal(uncompress(bytes, &size, packed, packed_size), Z_OK);
    assert_int_equal(size, 6 * pixels);
    for (size_t plane = 0; plane < 3; plane++)
        for (size_t i = 0; i < pixels; i++)
            numbers[plane * pixels + i] = number_at(
                bytes, numbers + plane * pixels, plane, image->width, image->height, i);
    for (size_t i = 0; i < pixels; i++) {
        uint16_t g = numbers[i];
        uint16_t rgb[3] = {(uint16_t)(g + numbers[pixels + i]), g,
                           (uint16_t)(g + numbers[2 * pixels + i])};
        for (int c = 0; c < 3; c++)
            image->pixels[3 * i + (size_t)c] = (float)ldexp(
                from_half((uint16_t)(rgb[c] << shift)), exponent);
    }
    mem_free(packed);
    mem_free(bytes);
    mem_free(numbers);
}

/* Values over 20 powers of two, some negative, some 0. */
static struct image *picture(int width, int height, double unit)
{
    struct rng rng;
    struct image *image = image_create(width, height);
    rng_init(&rng, 7, RNG_TEST, 0);
    for (int i = 0; i < 3 * width * height; i++) {
        double size = unit * exp2(-20.0 * rng_double(&rng)), u = rng_double(&rng);
        image->pixels[i] = (float)(u < 0.1 ? 0.0 : u < 0.2 ? -size : size);
    }
    return image;
}

static void check_packed(int width, int height, double unit, int shift)
{
    struct image *image = picture(width, height, unit);
    struct image *back = image_create(width, height);
    struct text base64 = {0};
    int exponent;
    report_encode(image, shift, &base64, &exponent);
    unpack(base64.data, exponent, shift, back);
    for (int i = 0; i < 3 * width * height; i++) {
        double x = (double)image->pixels[i], y = (double)back->pixels[i];
        /* Rounded once to 11 bits, and once more to what is kept of them. */
        double most = exp2(-11.0) + (shift ? exp2(-11.0 + shift) : 0.0);
        assert_true(fabs(x - y) <= fabs(x) * most);
    }
    image_destroy(image);
    image_destroy(back);
    mem_free(base64.data);
}

static void test_packing(void **state)
{
    (void)state;
    check_packed(37, 21, 1.0, 0);
    check_packed(1, 1, 1.0, 0);
    check_packed(1, 9, 3.7, 0);
    check_packed(16, 1, 1e-25, 0);
    check_packed(64, 48, 1e25, 0);
    check_packed(64, 48, 0.3, 4);
}

static void test_not_finite(void **state)
{
    (void)state;
    struct image *image = image_create(3, 1), *back = image_create(3, 1);
    struct text base64 = {0};
    int exponent;
    image->pixels[0] = NAN;
    image->pixels[3] = INFINITY;
    image->pixels[7] = 2.5f;
    report_encode(image, 4, &base64, &exponent);
    unpack(base64.data, exponent, 4, back);
    assert_true(isnan(back->pixels[0]));
    assert_true(isinf(back->pixels[3]));
    assert_true(back->pixels[7] == 2.5f && back->pixels[8] == 0.0f);
    image_destroy(image);
    image_destroy(back);
    mem_free(base64.data);
}

static void test_reducing(void **state)
{
    (void)state;
    struct image *image = image_create(5, 4);
    for (int i = 0; i < 3 * 20; i++)
        image->pixels[i] = (float)i;
    struct image *small = report_reduce(image, 2);
    assert_int_equal(small->width, 2);
    assert_int_equal(small->height, 2);
    /* Pixels (2,2), (3,2), (2,3), (3,3): the first numbers 36, 39, 51, 54. */
    assert_true(image_at(small, 1, 1)[0] == 45.0f);
    image_destroy(small);
    small = report_reduce(image, 100);
    assert_int_equal(small->width * small->height, 1);
    image_destroy(small);
    image_destroy(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_text),       cmocka_unit_test(test_figures),
        cmocka_unit_test(test_interval),   cmocka_unit_test(test_packing),
        cmocka_unit_test(test_not_finite), cmocka_unit_test(test_reducing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
