/* Textures: filtering and wrapping by hand, files that are not what they say, and BSDFs
 * made from them. */

#include "support/bsdf_make.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "surface/texture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static void assert_is(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-6))
        fail_msg("%.9g is not %.9g", value, expected);
}

/* Two columns 0.1 and 0.7, two rows: the lower one has a tenth of it. */
static struct texture *quad(struct texture_set *set, enum texture_wrap wrap)
{
    static const float value[4] = {0.1f, 0.7f, 0.01f, 0.07f};
    struct texture_image *image = texture_image_create(set, 2, 2);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            image->floats[3 * i + k] = value[i] * (float)(k + 1);
    return texture_picture(set, image, wrap);
}

static void test_bilinear(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct texture *t = quad(&set, TEXTURE_CLAMP);
    assert_is(texture_eval_uv(t, 0.25, 0.75).r, 0.1); /* v goes up, rows go down */
    assert_is(texture_eval_uv(t, 0.75, 0.75).g, 1.4);
    assert_is(texture_eval_uv(t, 0.75, 0.25).b, 0.21);
    assert_is(texture_eval_uv(t, 0.5, 0.75).r, 0.4);
    assert_is(texture_eval_uv(t, 0.5, 0.5).r, 0.22);
    t->uv[0][0] = 2.0;
    t->uv[0][2] = 0.05;
    assert_is(texture_eval_uv(t, 0.1, 0.75).r, 0.1);
    texture_set_deinit(&set);
}

static char *write_temporary(char path[64], const char *ending, const void *data,
                             size_t size)
{
    snprintf(path, 64, "/tmp/etalon_texture_%d%s", (int)getpid(), ending);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
    return path;
}

static const struct texture_image *load_bytes(struct texture_set *set, const char *ending,
                                              const void *data, size_t size,
                                              struct err *err)
{
    char path[64];
    struct log log;
    log_init(&log);
    const struct texture_image *image = texture_image_load(
        set, write_temporary(path, ending, data, size), TEXTURE_AUTO, NULL, &log, err);
    log_deinit(&log);
    unlink(path);
    return image;
}

/* Two rows of one pixel, the lower one first: grey, or colour; both byte orders. */
static void test_pfm(void **state)
{
    (void)state;
    static const unsigned char grey[] = "Pf\n1 2\n-2.0\n\0\0\x80\x3f\0\0\0\x40";
    static const unsigned char colour[] =
        "PF 1 2\r\n0.5\r\n\x3f\x80\0\0\x40\0\0\0\x40\x80\0\0"
        "\x41\0\0\0\x41\x80\0\0\x42\0\0\0";
    struct texture_set set = {0};
    struct err err = {0};
    const struct texture_image *a = load_bytes(&set, "a.pfm", grey, sizeof grey - 1,
                                               &err);
    const struct texture_image *b = load_bytes(&set, "b.pfm", colour, sizeof colour - 1,
                                               &err);
    assert_true(a && b && a->width == 1 && a->height == 2 && b->height == 2);
    assert_is(texture_image_texel(a, 0, 0).g, 4.0);
    assert_is(texture_image_texel(a, 0, 1).b, 2.0);
    assert_is(texture_image_texel(b, 0, 0).r, 4.0);
    assert_is(texture_image_texel(b, 0, 0).b, 16.0);
    assert_is(texture_image_texel(b, 0, 1).r, 0.5);
    assert_is(texture_image_texel(b, 0, 1).g, 1.0);
    for (size_t cut = 3; cut < sizeof colour - 1; cut++) {
        struct err bad = {0};
        assert_null(load_bytes(&set, "c.pfm", colour, cut, &bad));
        assert_true(strstr(bad.message, "cut short") || strstr(bad.message, "header"));
    }
    static const char *const heads[] = {"PF\n0 1\n-1\n", "PF\n1 1\n0\n", "PF\n1 x\n-1\n",
                                        "PF\n99999999 99999999\n-1\n", "PF\n1.5 1\n-1\n"};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        struct err bad = {0};
        assert_null(load_bytes(&set, "d.pfm", heads[i], strlen(heads[i]), &bad));
        assert_non_null(strstr(bad.message, "header"));
    }
    texture_set_deinit(&set);
}

static void put_chunk(unsigned char *png, size_t *size, const char *name,
                      const unsigned char *data, uint32_t length)
{
    unsigned char *at = png + *size;
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(length >> (24 - 8 * i));
    memcpy(at + 4, name, 4);
    memcpy(at + 8, data, length);
    uint32_t sum = (uint32_t)crc32(crc32(0, NULL, 0), at + 4, length + 4);
    for (int i = 0; i < 4; i++)
        at[8 + length + (uint32_t)i] = (unsigned char)(sum >> (24 - 8 * i));
    *size += length + 12;
}

/* 1024 x 1024 white pixels of a bit each: packed more densely than a byte a pixel could
 * be; with a header of as many pixels of 16 bits colour it is refused. */
static void test_one_bit_png(void **state)
{
    (void)state;
    enum { SIDE = 1024, RAW = SIDE * (SIDE / 8 + 1) };
    unsigned char head[13] = {0, 0, 4, 0, 0, 0, 4, 0, 1, 0, 0, 0, 0}, png[4096];
    unsigned char *raw = mem_alloc(RAW, 1), packed[2048];
    for (size_t i = 0; i < RAW; i++)
        raw[i] = i % (SIDE / 8 + 1) ? 0xff : 0;
    uLongf length = sizeof packed;
    assert_int_equal(compress2(packed, &length, raw, RAW, 9), Z_OK);
    assert_true(length < SIDE * SIDE / 1100);
    for (int wide = 0; wide < 2; wide++) {
        struct texture_set set = {0};
        struct err err = {0};
        size_t size = 8;
        head[8] = wide ? 16 : 1;
        head[9] = wide ? 2 : 0;
        memcpy(png, "\x89PNG\r\n\x1a\n", 8);
        put_chunk(png, &size, "IHDR", head, 13);
        put_chunk(png, &size, "IDAT", packed, (uint32_t)length);
        put_chunk(png, &size, "IEND", packed, 0);
        const struct texture_image *image = load_bytes(&set, ".png", png, size, &err);
        if (wide) {
            assert_null(image);
            assert_non_null(strstr(err.message, "asks for more than it holds"));
        } else {
            assert_non_null(image);
            assert_is(texture_image_texel(image, 700, 900).r, 1.0);
        }
        texture_set_deinit(&set);
    }
    mem_free(raw);
}

static void test_wrap(void **state)
{
    (void)state;
    static const struct {
        enum texture_wrap wrap;
        double left, far; /* at u = -.25 and 1.75 */
        double edge;      /* at u = 0 */
    } rows[] = {{TEXTURE_REPEAT, 0.7, 0.7, 0.4},
                {TEXTURE_CLAMP, 0.1, 0.7, 0.1},
                {TEXTURE_BLACK, 0.0, 0.0, 0.05},
                {TEXTURE_MIRROR, 0.1, 0.1, 0.1}};
    for (int i = 0; i < 4; i++) {
        struct texture_set set = {0};
        struct texture *t = quad(&set, rows[i].wrap);
        assert_is(texture_eval_uv(t, -0.25, 0.75).r, rows[i].left);
        assert_is(texture_eval_uv(t, 1.75, 0.75).r, rows[i].far);
        assert_is(texture_eval_uv(t, 0.0, 0.75).r, rows[i].edge);
        /* Beyond all whole numbers something finite comes back. */
        assert_true(isfinite(texture_eval_uv(t, 1e30, -1e30).r));
        assert_true(isfinite(texture_eval_uv(t, HUGE_VAL, (double)NAN).r));
        texture_set_deinit(&set);
    }
}

static void test_nodes(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct texture *a = texture_constant(&set, rgb(0.1, 0.2, 0.3));
    struct texture *b = texture_constant(&set, rgb(0.5, 0.5, 1.0));
    struct texture *checks = texture_checkerboard(&set, a, b);
    struct texture *quarter = texture_constant(&set, rgb_grey(0.25));
    assert_is(texture_eval_uv(checks, 0.5, 0.5).r, 0.1);
    assert_is(texture_eval_uv(checks, 1.5, 0.5).r, 0.5);
    assert_is(texture_eval_uv(checks, -0.5, 0.5).r, 0.5);
    assert_is(texture_eval_uv(texture_product(&set, a, b), 0, 0).b, 0.3);
    assert_is(texture_eval_uv(texture_mix(&set, a, b, quarter), 0, 0).r, 0.2);
    assert_true(texture_set_bytes(&set) >= 6 * sizeof(struct texture));
    texture_set_deinit(&set);
}

static const char *temp_file(const char *name, const void *data, size_t size)
{
    static char path[256];
    snprintf(path, sizeof path, "/tmp/etalon-texture-%d-%s", (int)getpid(), name);
    assert_true(text_write_file(path, data, size, NULL));
    return path;
}

/* A tga of 1 x 2 pixels: (255, 128, 0) above black. */
static const unsigned char tga[] = {0, 0, 2, 0, 0,  0,    0, 0,   0,   0, 0, 0,
                                    1, 0, 2, 0, 24, 0x20, 0, 128, 255, 0, 0, 0};

static void test_files(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct log log;
    struct err err = {0};
    const struct place at = {"s.pbrt", 2, 5};
    log_init(&log);
    const char *path = temp_file("a.tga", tga, sizeof tga);
    const struct texture_image *image = texture_image_load(&set, path, TEXTURE_AUTO, &at,
                                                           &log, &err);
    assert_non_null(image);
    assert_int_equal(image->width, 1);
    assert_int_equal(image->height, 2);
    assert_is(texture_image_texel(image, 0, 0).r, 1.0);
    assert_is(texture_image_texel(image, 0, 0).g,
              pow((128 / 255.0 + 0.055) / 1.055, 2.4));
    assert_ptr_equal(image,
                     texture_image_load(&set, path, TEXTURE_AUTO, &at, &log, &err));
    const struct texture_image *raw = texture_image_load(&set, path, TEXTURE_LINEAR, &at,
                                                         &log, &err);
    assert_is(texture_image_texel(raw, 0, 0).g, 128 / 255.0);
    assert_int_equal(set.image_count, 2);
    unlink(path);
    /* Missing: a note, no error. */
    assert_null(
        texture_image_load(&set, "/nowhere/x.png", TEXTURE_AUTO, &at, &log, &err));
    assert_int_equal(err.code, ERR_NONE);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.notes[0].text, "/nowhere/x.png"));
    texture_set_deinit(&set);
    log_deinit(&log);
}

static void load_fails(const char *path, const char *said)
{
    struct texture_set set = {0};
    struct log log;
    struct err err = {0};
    const struct place at = {"s.pbrt", 2, 5};
    log_init(&log);
    assert_null(texture_image_load(&set, path, TEXTURE_AUTO, &at, &log, &err));
    assert_int_equal(err.line, 2);
    if (!strstr(err.message, said))
        fail_msg("\"%s\" does not say \"%s\"", err.message, said);
    assert_int_equal(set.image_count, 0);
    texture_set_deinit(&set);
    log_deinit(&log);
}

static void test_absurd_files(void **state)
{
    (void)state;
    load_fails("/tmp", "a directory");
    const char *path = temp_file("cut.tga", tga, 16);
    load_fails(path, "cannot read the picture");
    unlink(path);
    unsigned char huge[sizeof tga];
    memcpy(huge, tga, sizeof tga);
    huge[12] = huge[13] = huge[14] = huge[15] = 0xff;
    path = temp_file("huge.tga", huge, sizeof huge);
    load_fails(path, "more than it holds");
    unlink(path);
    path = temp_file("text.png", "hello", 5);
    load_fails(path, "cannot read the picture");
    unlink(path);
}

static void test_nan_texels(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct log log;
    struct err err = {0};
    char path[256];
    log_init(&log);
    snprintf(path, sizeof path, "/tmp/etalon-texture-%d.exr", (int)getpid());
    struct image *image = image_create(2, 1);
    image->pixels[0] = NAN;
    image->pixels[1] = -1.0f;
    image->pixels[2] = 3.0f;
    assert_true(exr_write(path, image, NULL, 0, NULL, &err));
    image_destroy(image);
    const struct texture_image *read = texture_image_load(&set, path, TEXTURE_AUTO, NULL,
                                                          &log, &err);
    assert_non_null(read);
    assert_is(texture_image_texel(read, 0, 0).r, 0.0);
    assert_is(texture_image_texel(read, 0, 0).b, 3.0);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.notes[0].text, "2 values"));
    unlink(path);
    texture_set_deinit(&set);
    log_deinit(&log);
}

/* The BSDF at a point is the one that the texture's value there would have made. */
static void test_bsdf_at(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct texture *t = quad(&set, TEXTURE_REPEAT);
    struct bsdf material;
    struct bsdf_nodes nodes = {0};
    struct bsdf_value a, b;
    bsdf_init(&material, bsdf_find("diffuse"));
    assert_true(bsdf_bind(&material, "reflectance", t, NULL, NULL));
    assert_true(bsdf_prepare(&material, NULL, NULL));
    assert_true(material.flags & BSDF_TEXTURED);
    const struct bsdf *here = bsdf_at(
        &material, &(struct texture_point){.u = 0.25, .v = 0.75}, &nodes);
    struct bsdf same = bsdf_make("diffuse", "reflectance", 0.1, NULL);
    struct vec3 up = bsdf_direction(0.9, 0.0);
    assert_false(here->flags & BSDF_TEXTURED);
    assert_true(bsdf_eval(here, up, up, TRANSPORT_RADIANCE, &a));
    assert_true(bsdf_eval(&same, up, up, TRANSPORT_RADIANCE, &b));
    assert_is(a.f.r, b.f.r);
    assert_is(a.f.b, 3.0 * b.f.r);
    /* 1.4 and 2.1 are clamped to the range of a reflectance. */
    nodes.count = 0;
    here = bsdf_at(&material, &(struct texture_point){.u = 0.75, .v = 0.75}, &nodes);
    assert_true(bsdf_eval(here, up, up, TRANSPORT_RADIANCE, &a));
    assert_is(a.f.g * 3.14159265358979, 1.0);
    struct err err = {0};
    bsdf_init(&material, bsdf_find("dielectric"));
    assert_false(bsdf_bind(&material, "eta", t, NULL, &err));
    assert_non_null(strstr(err.message, "takes no texture"));
    texture_set_deinit(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bilinear),     cmocka_unit_test(test_pfm),
        cmocka_unit_test(test_one_bit_png),  cmocka_unit_test(test_wrap),
        cmocka_unit_test(test_nodes),        cmocka_unit_test(test_files),
        cmocka_unit_test(test_absurd_files), cmocka_unit_test(test_nan_texels),
        cmocka_unit_test(test_bsdf_at),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
