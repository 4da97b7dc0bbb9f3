/* Previews decode back to the right sRGB values; a failure leaves nothing behind. */
#include "base/mem.h"
#include "base/text.h"
#include "image/preview.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>
#include <stb/stb_image.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char directory[] = "/tmp/etalon-preview-XXXXXX";

static int make_directory(void **state)
{
    (void)state;
    return mkdtemp(directory) ? 0 : -1;
}

static int remove_directory(void **state)
{
    (void)state;
    return rmdir(directory); /* fails if a test left a file behind */
}

/* Writes, decodes with stb_image and removes the file; free() the answer. */
static unsigned char *round_trip(const struct image *image, double exposure)
{
    char *path = text_join(directory, "preview.png");
    struct err err = {0};
    assert_true(preview_write_png(path, image, exposure, &err));
    size_t size = 0;
    char *png = text_read_file(path, &size, NULL, &err);
    assert_non_null(png);
    int width = 0, height = 0, channels = 0;
    unsigned char *pixels = stbi_load_from_memory((const unsigned char *)png, (int)size,
                                                  &width, &height, &channels, 3);
    assert_non_null(pixels);
    assert_true(width == image->width && height == image->height && channels == 3);
    mem_free(png);
    unlink(path);
    mem_free(path);
    return pixels;
}

/* Known pairs of the sRGB curve: the linear part, its end, middle grey, white. */
static void values_are_srgb(void **state)
{
    (void)state;
    static const struct {
        float linear;
        int code;
    } known[] = {
        {0.0f, 0},      {-1.0f, 0},        {0.001f, 3},       {0.0031308f, 10},
        {0.18f, 118},   {0.2140411f, 127}, {0.2158605f, 128}, {0.5f, 188},
        {0.73f, 222},   {1.0f, 255},       {7.0f, 255},       {INFINITY, 255},
        {-INFINITY, 0}, {NAN, 0},
    };
    enum { COUNT = sizeof known / sizeof known[0] };
    struct image *image = image_create(COUNT, 2);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) {
            image_at(image, i, 0)[c] = c == 1 ? known[i].linear : 0.0f;
            image_at(image, i, 1)[c] = c == 1 ? 0.0f : known[i].linear;
        }
    unsigned char *pixels = round_trip(image, 0.0);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) {
            assert_int_equal(pixels[3 * i + c], c == 1 ? known[i].code : 0);
            assert_int_equal(pixels[3 * (COUNT + i) + c], c == 1 ? 0 : known[i].code);
        }
    stbi_image_free(pixels);
    image_destroy(image);
}

/* Every code is the nearest one: the curve's inverse at half codes. */
static void every_code_is_the_nearest(void **state)
{
    (void)state;
    struct image *image = image_create(255, 2);
    for (int i = 0; i < 255; i++) {
        double v = (i + 0.5) / 255.0;
        double edge = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        for (int c = 0; c < 3; c++) {
            image_at(image, i, 0)[c] = (float)(edge * (1.0 - 1e-4));
            image_at(image, i, 1)[c] = (float)(edge * (1.0 + 1e-4));
        }
    }
    unsigned char *pixels = round_trip(image, 0.0);
    for (int i = 0; i < 255; i++) {
        assert_int_equal(pixels[3 * i], i);
        assert_int_equal(pixels[3 * (255 + i)], i + 1);
    }
    stbi_image_free(pixels);
    image_destroy(image);
}

static void exposure_counts_stops(void **state)
{
    (void)state;
    struct image *image = image_create(2, 1);
    for (int c = 0; c < 3; c++) {
        image_at(image, 0, 0)[c] = 0.125f;
        image_at(image, 1, 0)[c] = 4.0f;
    }
    unsigned char *pixels = round_trip(image, 2.0);
    assert_int_equal(pixels[0], 188); /* 0.5 */
    stbi_image_free(pixels);
    pixels = round_trip(image, -3.0);
    assert_int_equal(pixels[3], 188);
    stbi_image_free(pixels);
    image_destroy(image);
}

/* The automatic exposure takes a plain picture to middle grey whatever its scale and
 * however much of it is black, and keeps the order and the hue of highlights. */
static void automatic_exposure_finds_middle_grey(void **state)
{
    (void)state;
    for (int power = -30; power <= 30; power += 15) {
        struct image *image = image_create(40, 40);
        for (int y = 0; y < 30; y++) /* a quarter stays black */
            for (int x = 0; x < 40; x++)
                for (int c = 0; c < 3; c++)
                    image_at(image, x, y)[c] = powf(10.0f, (float)power);
        unsigned char *pixels = round_trip(image, (double)NAN);
        assert_true(abs(pixels[0] - 118) <= 1);
        assert_int_equal(pixels[3 * 1599], 0);
        stbi_image_free(pixels);
        for (int x = 0; x < 5; x++) {
            image_at(image, x, 0)[0] *= (float)(4 << x);
            image_at(image, x, 0)[1] *= (float)(2 << x);
        }
        pixels = round_trip(image, (double)NAN);
        for (int x = 0; x < 4; x++) {
            assert_true(pixels[3 * x] <= pixels[3 * x + 3]);
            assert_true(pixels[3 * x] > pixels[3 * x + 1]);
        }
        assert_true(pixels[0] < pixels[3] && pixels[3] < 255);
        stbi_image_free(pixels);
        image_destroy(image);
    }
}

static void pictures_without_light_are_black(void **state)
{
    (void)state;
    struct image *image = image_create(3, 1);
    image->pixels[0] = NAN;
    image->pixels[4] = -5.0f;
    unsigned char *pixels = round_trip(image, (double)NAN);
    for (int i = 0; i < 9; i++)
        assert_int_equal(pixels[i], 0);
    stbi_image_free(pixels);
    image_destroy(image);
}

static void failure_leaves_nothing_behind(void **state)
{
    (void)state;
    struct image *image = image_create(3, 3);
    char *missing = text_join(directory, "no/such/preview.png");
    char *taken = text_join(directory, "taken.png");
    struct err err = {0};
    assert_false(preview_write_png(missing, image, 0.0, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_non_null(strstr(err.message, "No such file"));
    assert_non_null(strstr(err.message, missing));
    assert_int_equal(mkdir(taken, 0777), 0);
    err = (struct err){0};
    assert_false(preview_write_png(taken, image, 0.0, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_int_equal(rmdir(taken), 0);
    mem_free(missing);
    mem_free(taken);
    image_destroy(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_srgb),
        cmocka_unit_test(every_code_is_the_nearest),
        cmocka_unit_test(exposure_counts_stops),
        cmocka_unit_test(automatic_exposure_finds_middle_grey),
        cmocka_unit_test(pictures_without_light_are_black),
        cmocka_unit_test(failure_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
