/* Textures: filtering and wrapping by hand, files that are not what they say, and BSDFs
 * made from them. */

#include "support/bsdf_make.h"

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
    assert_is(texture_eval(t, 0.25, 0.75).r, 0.1); /* v goes up, rows go down */
    assert_is(texture_eval(t, 0.75, 0.75).g, 1.4);
    assert_is(texture_eval(t, 0.75, 0.25).b, 0.21);
    assert_is(texture_eval(t, 0.5, 0.75).r, 0.4);
    assert_is(texture_eval(t, 0.5, 0.5).r, 0.22);
    t->uv[0][0] = 2.0;
    t->uv[0][2] = 0.05;
    assert_is(texture_eval(t, 0.1, 0.75).r, 0.1);
    texture_set_deinit(&set);
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
        assert_is(texture_eval(t, -0.25, 0.75).r, rows[i].left);
        assert_is(texture_eval(t, 1.75, 0.75).r, rows[i].far);
        assert_is(texture_eval(t, 0.0, 0.75).r, rows[i].edge);
        /* Beyond all whole numbers something finite comes back. */
        assert_true(isfinite(texture_eval(t, 1e30, -1e30).r));
        assert_true(isfinite(texture_eval(t, HUGE_VAL, (double)NAN).r));
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
    assert_is(texture_eval(checks, 0.5, 0.5).r, 0.1);
    assert_is(texture_eval(checks, 1.5, 0.5).r, 0.5);
    assert_is(texture_eval(checks, -0.5, 0.5).r, 0.5);
    assert_is(texture_eval(texture_product(&set, a, b), 0, 0).b, 0.3);
    assert_is(texture_eval(texture_mix(&set, a, b, quarter), 0, 0).r, 0.2);
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
    assert_true(exr_write(path, image, NULL, 0, NULL, 0, &err));
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
    const struct bsdf *here = bsdf_at(&material, 0.25, 0.75, &nodes);
    struct bsdf same = bsdf_make("diffuse", "reflectance", 0.1, NULL);
    struct vec3 up = bsdf_direction(0.9, 0.0);
    assert_false(here->flags & BSDF_TEXTURED);
    assert_true(bsdf_eval(here, up, up, TRANSPORT_RADIANCE, &a));
    assert_true(bsdf_eval(&same, up, up, TRANSPORT_RADIANCE, &b));
    assert_is(a.f.r, b.f.r);
    assert_is(a.f.b, 3.0 * b.f.r);
    /* 1.4 and 2.1 are clamped to the range of a reflectance. */
    nodes.count = 0;
    here = bsdf_at(&material, 0.75, 0.75, &nodes);
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
        cmocka_unit_test(test_bilinear),     cmocka_unit_test(test_wrap),
        cmocka_unit_test(test_nodes),        cmocka_unit_test(test_files),
        cmocka_unit_test(test_absurd_files), cmocka_unit_test(test_nan_texels),
        cmocka_unit_test(test_bsdf_at),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
