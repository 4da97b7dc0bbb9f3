/* What the density of a sky is for: the variance of luminance over density, for suns of
 * few texels in black pictures, where the density must follow the texels. All figures are
 * sums over a fixed grid of u: no false alarms. */
#include "math/rgb.h"
#include "scene/sky_density.h"
#include "support/test_scene.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>

struct moments {
    double variance; /* of luminance over density, relative to the squared mean */
    double black;    /* share of the samples that carry nothing */
    double mean;     /* over the integral that the builder returned */
};

/* A sun of side x side texels in a black picture, 60 degrees from its upper pole. */
static void sun_map(struct sky_map *map, int width, int side)
{
    struct texture_set set = {0};
    int height = width / 2;
    struct texture_image *image = texture_image_create(&set, width, height);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            for (int k = 0; k < 3; k++)
                image->floats[3 * ((height / 3 + y) * width + width / 5 + x) + k] = 1.0f;
    sky_map_build(map, image, false);
    texture_set_deinit(&set);
}

static struct moments measure(int width, int side)
{
    enum { N = 500 };
    struct sky_map map;
    struct dist_tree density;
    double sum = 0.0, squares = 0.0, black = 0.0;
    sun_map(&map, width, side);
    double integral = sky_density_build(&density, &map, rgb_grey(1.0));
    assert_true(integral > 0.0);
    for (int k = 0; k < N * N; k++) {
        const double u[2] = {(k % N + 0.5) / N, (k / N + 0.5) / N};
        double d[3];
        sky_density_sample(&density, u, d);
        double shines = rgb_luminance(sky_map_at(&map, d));
        double ratio = shines / sky_density_pdf(&density, d);
        sum += ratio;
        squares += ratio * ratio;
        black += shines == 0.0;
    }
    printf("%d wide, sun of %d: variance %.3f, black %.3f, mean %.4f, %d nodes\n", width,
           side, squares * N * N / (sum * sum) - 1.0, black / (N * N),
           sum / (N * N) / integral, density.node_count);
    dist_tree_deinit(&density);
    sky_map_deinit(&map);
    return (struct moments){squares * N * N / (sum * sum) - 1.0, black / (N * N),
                            sum / (N * N) / integral};
}

/* Seen: variances of .003 to .02, and .05 to .21 in the widest, where a texel is about
 * two parts of a divided cell wide; black up to .005 and .04. With cells of one size,
 * 1024 along an axis, 4096 wide had a variance of 10 and 82 % black. */
static void suns_are_followed(void **state)
{
    (void)state;
    static const int widths[] = {256, 1024, 4096};
    for (int k = 0; k < 9; k++) {
        bool wide = k / 3 == 2;
        struct moments m = measure(widths[k / 3], 1 << k % 3);
        assert_true(m.variance < (wide ? 0.3 : 0.05));
        assert_true(m.black < (wide ? 0.06 : 0.01));
        assert_true(fabs(m.mean - 1.0) < (wide ? 0.01 : 0.003));
    }
}

/* The picture's texels are freed once the light has its own, unless a texture of a
 * surface reads them too. */
static void texels_are_kept_once(void **state)
{
    (void)state;
    for (int shared = 0; shared < 2; shared++) {
        struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
        test_sky(desc, 1.0);
        test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                    rgb_grey(0.0), false);
        const struct texture_image *map = desc->lights[0].map;
        const struct texture *texture =
            shared ? texture_picture(&desc->textures, map, TEXTURE_REPEAT) : NULL;
        struct scene *scene = test_build(desc, false);
        assert_true((map->floats != NULL) == shared);
        assert_int_equal(map->width, 16);
        if (shared)
            assert_true(texture_eval_uv(texture, 0.3, 0.7).g > 0.0);
        double seen = 0.0;
        for (int k = 0; k < 2; k++) {
            struct ray_endpoint point = {.ng = vec3(0.0f, k ? 1.0f : -1.0f, 0.0f)};
            seen += light_emission(scene->environment, &point, point.ng).g;
        }
        assert_true(seen > 0.0);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(suns_are_followed),
                                       cmocka_unit_test(texels_are_kept_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
