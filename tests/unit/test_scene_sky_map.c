/* Pictures of the sphere: every texel as the picture has it, in both ways to store them,
 * and lookups against the definition. */
#include "math/rng.h"
#include "math/warp.h"
#include "scene/sky_map.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

/* Values that half floats hold, or `exact` false, some that they do not. */
static const struct texture_image *picture(struct texture_set *set, int width, int height,
                                           bool exact)
{
    static const float odd[] = {0x1p-24f, 1e5f, 0.1f, 0x1.002p0f, 0x1p-15f};
    struct texture_image *image = texture_image_create(set, width, height);
    struct rng rng;
    rng_init(&rng, (uint64_t)(width * 100 + height), RNG_TEST, 0);
    for (int i = 0; i < 3 * width * height; i++)
        image->floats[i] = ldexpf((float)(1024 + rng_u64(&rng) % 1024),
                                  (int)(rng_u64(&rng) % 30) - 24);
    image->floats[0] = 0.0f;
    if (width * height > 1)
        image->floats[4] = 65504.0f;
    if (!exact)
        image->floats[2] = odd[(width + height) % 5];
    return image;
}

static void texels_are_the_pictures_own(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {2, 1}, {3, 5}, {8, 4}, {17, 9}, {64, 64}};
    for (int k = 0; k < 12; k++) {
        struct texture_set set = {0};
        struct sky_map map;
        const int *size = sizes[k / 2];
        const struct texture_image *image = picture(&set, size[0], size[1], k % 2);
        sky_map_build(&map, image, false);
        assert_true((map.half != NULL) == (k % 2 == 1) && !map.half != !map.full);
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++) {
                struct rgb a = texture_image_texel(image, x, y);
                struct rgb b = sky_map_texel(&map, x, y);
                assert_true(a.r == b.r && a.g == b.g && a.b == b.b);
            }
        sky_map_deinit(&map);
        texture_set_deinit(&set);
    }
}

/* Each value that does not fit keeps floats. */
static void what_halves_do_not_hold_stays_whole(void **state)
{
    (void)state;
    static const float odd[] = {0x1p-24f, 65536.0f, 0.1f, 0x1.002p0f, 0x1.8p-15f};
    for (int k = 0; k < 5; k++) {
        struct texture_set set = {0};
        struct sky_map map;
        struct texture_image *image = texture_image_create(&set, 4, 2);
        image->floats[7] = odd[k];
        sky_map_build(&map, image, false);
        assert_null(map.half);
        assert_true(sky_map_texel(&map, 2, 0).g == (double)odd[k]);
        sky_map_deinit(&map);
        texture_set_deinit(&set);
    }
}

/* Bilinear between centres at longitude and latitude: column round, row to the poles. */
static struct rgb by_definition(const struct texture_image *image, const double d[3])
{
    double u = atan2(d[1], d[0]) / (2.0 * MATH_PI), sum[3] = {0};
    double v = atan2(hypot(d[0], d[1]), d[2]) / MATH_PI;
    double x = (u < 0.0 ? u + 1.0 : u) * image->width - 0.5, y = v * image->height - 0.5;
    for (int k = 0; k < 4; k++) {
        double i = floor(x) + k % 2, j = floor(y) + k / 2;
        double share = (1.0 - fabs(x - i)) * (1.0 - fabs(y - j));
        int row = (int)fmin(fmax(j, 0.0), image->height - 1.0);
        int column = ((int)i + image->width) % image->width;
        struct rgb texel = texture_image_texel(image, column, row);
        sum[0] += share * texel.r;
        sum[1] += share * texel.g;
        sum[2] += share * texel.b;
    }
    return rgb(sum[0], sum[1], sum[2]);
}

static void lookups_interpolate(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {3, 5}, {8, 4}, {37, 21}};
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int k = 0; k < 8; k++) {
        struct texture_set set = {0};
        struct sky_map map;
        const struct texture_image *image = picture(&set, sizes[k / 2][0],
                                                    sizes[k / 2][1], k % 2);
        sky_map_build(&map, image, false);
        for (int n = 0; n < 20000; n++) {
            double z = 2.0 * rng_double(&rng) - 1.0, phi = 6.2831 * rng_double(&rng);
            double s = sqrt(1.0 - z * z);
            const double d[3] = {s * cos(phi), s * sin(phi), z};
            struct rgb a = by_definition(image, d), b = sky_map_at(&map, d);
            double scale = 1e-9 * 65504.0; /* 1e-13 of a texel, over 2^30 of range */
            assert_true(fabs(a.r - b.r) < scale && fabs(a.g - b.g) < scale &&
                        fabs(a.b - b.b) < scale);
        }
        sky_map_deinit(&map);
        texture_set_deinit(&set);
    }
}

/* The axes, where longitude or latitude are at an end. */
static void axes_lie_within_the_picture(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct sky_map map;
    const struct texture_image *image = picture(&set, 8, 4, true);
    for (int k = 0; k < 2; k++) {
        sky_map_build(&map, image, k);
        for (int axis = 0; axis < 6; axis++) {
            double d[3] = {-0.0, -0.0, -0.0};
            d[axis / 2] = axis % 2 ? -1.0 : 1.0;
            struct rgb c = sky_map_at(&map, d);
            assert_true(c.r >= 0.0 && c.r <= 65504.0 && c.g >= 0.0 && c.b >= 0.0);
        }
        sky_map_deinit(&map);
    }
    texture_set_deinit(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_the_pictures_own),
        cmocka_unit_test(what_halves_do_not_hold_stays_whole),
        cmocka_unit_test(lookups_interpolate),
        cmocka_unit_test(axes_lie_within_the_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
