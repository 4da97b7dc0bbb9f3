/* Noise and the textures made of it, against values that a second program computed from
 * the definition: weights of the eight corners multiplied out, gradients by the bits of
 * the hash, Bernstein polynomials in place of de Casteljau's scheme. */

#include "surface/perlin.h"
#include "surface/texture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>

static void assert_is(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-11))
        fail_msg("%.13g is not %.13g", value, expected);
}

static const double point[3] = {0.3, 1.7, -2.4};

static void test_noise(void **state)
{
    (void)state;
    assert_is(perlin_noise(0.5, 0.5, 0.5), -0.125);
    assert_is(perlin_noise(0.3, 1.7, -2.4), -0.433525924254);
    assert_is(perlin_noise(-17.25, 300.6, 5.1), -0.247722481155);
    assert_is(perlin_noise(255.9, 0.1, 0.2), 0.134202646873); /* the table's end */
    assert_is(perlin_noise(3.0, 4.0, 5.0), 0.0);
    assert_is(perlin_fbm(point, 0.5, 3), -0.578836793010);
    assert_is(perlin_fbm(point, 0.5, 8), -0.611275438133);
    assert_is(perlin_fbm(point, 0.5, 0), 0.0);
    assert_is(perlin_turbulence(point, 0.6, 4), 0.633135088260);
}

static struct rgb value_at(const struct texture *texture, double x, double y, double z)
{
    const struct texture_point at = {.p = {x, y, z}};
    return texture_eval(texture, &at);
}

static void test_textures_of_noise(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct texture *fbm = texture_fbm(&set, 3, 0.5);
    assert_is(value_at(fbm, 0.3, 1.7, -2.4).r, -0.578836793010);
    assert_is(value_at(texture_wrinkled(&set, 4, 0.6), 0.3, 1.7, -2.4).g, 0.633135088260);
    assert_is(value_at(texture_windy(&set), 0.3, 1.7, -2.4).b, -0.048540409826);
    /* Twice the place, moved and with the axes exchanged. */
    const double space[3][4] = {{0, 2, 0, 0.5}, {0, 0, 2, 1.0}, {2, 0, 0, -1.5}};
    for (int i = 0; i < 12; i++)
        fbm->space[i / 4][i % 4] = space[i / 4][i % 4];
    assert_is(value_at(fbm, -0.45, -0.1, 0.35).r, -0.578836793010);
    texture_set_deinit(&set);
}

static void marble_is(double x, double y, double z, double scale, double r, double g,
                      double b)
{
    struct texture_set set = {0};
    const struct texture_noise noise = {8, 0.5, scale, 0.2};
    struct rgb c = value_at(texture_marble(&set, &noise), x, y, z);
    assert_is(c.r, r);
    assert_is(c.g, g);
    assert_is(c.b, b);
    texture_set_deinit(&set);
}

/* Of the spline's six pieces, all but the first. */
static void test_marble(void **state)
{
    (void)state;
    marble_is(0.4, -0.1, 0.9, 4, 0.8322004312578557, 0.8258362096118023,
              0.8241115416650792);
    marble_is(0.4, -0.1, 0.9, 1, 0.8233359706862384, 0.8200013200645296,
              0.8266640355601087);
    marble_is(1.0, 0.2, 0.4, 1, 0.8438580901251616, 0.8372165448638883,
              0.8374356589807224);
    marble_is(0.3, 1.7, -2.4, 4, 0.8672234286077654, 0.8618079044225535,
              0.8795003796929506);
    marble_is(0.3, 1.7, -2.4, 1, 0.8698761729477889, 0.8698761729477889,
              0.8999120176207973);
}

static void test_dots_and_checks(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct texture *in = texture_constant(&set, rgb_grey(1.0));
    struct texture *out = texture_constant(&set, rgb_grey(0.0));
    /* A dot around (1.11315, 2.01190), none in the square of (1, 1). */
    struct texture *dots = texture_dots(&set, in, out);
    assert_is(texture_eval_uv(dots, 1.1131, 2.0119).r, 1.0);
    assert_is(texture_eval_uv(dots, 1.1131 + 0.349, 2.0119).r, 1.0);
    assert_is(texture_eval_uv(dots, 1.1131 - 0.351, 2.0119).r, 0.0);
    assert_is(texture_eval_uv(dots, 1.1131, 2.0119 - 0.349).r, 1.0);
    assert_is(texture_eval_uv(dots, 1.1131, 2.0119 + 0.351).r, 0.0);
    assert_is(texture_eval_uv(dots, 1.0, 1.0).r, 0.0);
    struct texture *checks = texture_checkerboard_3d(&set, in, out);
    assert_is(value_at(checks, 0.5, 0.5, 0.5).r, 1.0);
    assert_is(value_at(checks, 0.5, 0.5, -0.5).r, 0.0);
    assert_is(value_at(checks, -0.5, 0.5, -0.5).r, 1.0);
    texture_set_deinit(&set);
}

static void test_finite(void **state)
{
    (void)state;
    static const double far[] = {9e8, 1e30, HUGE_VAL, (double)NAN};
    struct texture_set set = {0};
    const struct texture_noise noise = {PERLIN_OCTAVES_MAX, 1e300, 1e300, 1e300};
    const struct texture *all[] = {texture_fbm(&set, PERLIN_OCTAVES_MAX, -1e300),
                                   texture_wrinkled(&set, PERLIN_OCTAVES_MAX, 1e300),
                                   texture_windy(&set), texture_marble(&set, &noise)};
    for (int i = 0; i < 16; i++) {
        assert_true(isfinite(value_at(all[i % 4], far[i / 4], 0.3, -far[i / 4]).r));
        assert_true(isfinite(value_at(all[i % 4], 0.3, 0.4, 0.6).r));
    }
    texture_set_deinit(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noise),  cmocka_unit_test(test_textures_of_noise),
        cmocka_unit_test(test_marble), cmocka_unit_test(test_dots_and_checks),
        cmocka_unit_test(test_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
