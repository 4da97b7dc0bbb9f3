/* Environment maps: directions follow the density that pdf_point names (chi-squared over
 * cells of the sphere), that density is there wherever the map shines, its integral is 1,
 * and the power of the light is that of the map. Rate of false alarms 1e-4. */

#include "math/rng.h"
#include "math/warp.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define ROWS        16
#define COLUMNS     32
#define CELLS       (ROWS * COLUMNS)

static struct scene *sky_scene(bool octahedral)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    test_sky(desc, 2.0);
    desc->lights[0].octahedral = octahedral;
    test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                rgb_grey(0.0), false);
    return test_build(desc, false);
}

/* Cells of equal height in z, equal width in azimuth, of the world. */
static int cell_of(struct vec3 w)
{
    int row = (int)((double)(0.5f * (w.z + 1.0f)) * ROWS);
    double phi = atan2((double)w.y, (double)w.x) / (2.0 * MATH_PI) + 0.5;
    int column = (int)(phi * COLUMNS);
    row = row >= ROWS ? ROWS - 1 : row;
    return row * COLUMNS + (column >= COLUMNS ? COLUMNS - 1 : column);
}

/* The direction in the middle of sub-cell (i, j) of n x n in a cell. */
static struct vec3 direction_in(int cell, int i, int j, int n)
{
    double z = 2.0 * (cell / COLUMNS + (i + 0.5) / n) / ROWS - 1.0;
    double phi = 2.0 * MATH_PI * ((cell % COLUMNS + (j + 0.5) / n) / COLUMNS - 0.5);
    double s = sqrt(fmax(0.0, 1.0 - z * z));
    return vec3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)z);
}

static void check_sampling(bool octahedral)
{
    enum { N = 100000, SUB = 40 };
    double observed[CELLS] = {0}, expected[CELLS] = {0};
    struct scene *scene = sky_scene(octahedral);
    const struct light *light = scene->environment;
    assert_non_null(light);
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    for (int k = 0; k < N; k++) {
        const double u[2] = {rng_double(&rng), rng_double(&rng)};
        struct ray_endpoint point;
        light->type->sample_point(scene, light, u, &point);
        assert_true(light->type->pdf_point(light, &point) > 0.0);
        observed[cell_of(point.ng)] += 1.0;
    }
    double total = 0.0, radiance = 0.0, area = 4.0 * MATH_PI / (CELLS * SUB * SUB);
    for (int cell = 0; cell < CELLS; cell++)
        for (int i = 0; i < SUB * SUB; i++) {
            struct ray_endpoint point = {.ng = direction_in(cell, i / SUB, i % SUB, SUB)};
            double pdf = light->type->pdf_point(light, &point);
            double shines = rgb_luminance(light_emission(light, &point, point.ng));
            assert_true(pdf > 0.0 || shines == 0.0);
            expected[cell] += pdf * area * N;
            total += pdf * area;
            radiance += shines * area;
        }
    printf("integral of the density %.6f, of the radiance %.6f, power / (pi R^2) %.6f\n",
           total, radiance, light->power * light_enter_pdf(light));
    /* Midpoints of 800 x 1280 cells on steps and kinks: 1e-3 of the whole. */
    assert_true(fabs(total - 1.0) < 1e-3);
    assert_true(fabs(light->power * light_enter_pdf(light) / radiance - 1.0) < 2e-3);
    assert_true(
        stat_ok("environment", stat_chi2_p(observed, expected, CELLS), FALSE_ALARM));
    scene_destroy(scene);
}

static void test_sampling(void **state)
{
    (void)state;
    check_sampling(false);
}

static void test_octahedral(void **state)
{
    (void)state;
    check_sampling(true);
}

static struct rgb seen_from(const struct scene *scene, double x, double y, double z)
{
    double s = 1.0 / sqrt(x * x + y * y + z * z);
    struct vec3 w = {(float)(-s * x), (float)(-s * y), (float)(-s * z)};
    struct ray_endpoint point = {.ng = w};
    return light_emission(scene->environment, &point, w);
}

/* The middle of the square is +z, and what lies beside each other on the sphere is as
 * bright across the square's edges. */
static void test_octahedral_orientation(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    struct texture_image *map = texture_image_create(&desc->textures, 8, 8);
    for (int i = 0; i < 64; i++)
        for (int k = 0; k < 3; k++)
            map->floats[3 * i + k] = (float)(1 + i);
    struct light_desc light = {.type = &light_environment,
                               .intensity = rgb_grey(1.0),
                               .to_world = xform_identity(),
                               .map = map,
                               .octahedral = true};
    scene_desc_add_light(desc, &light);
    test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                rgb_grey(0.0), false);
    struct scene *scene = test_build(desc, false);
    double scale = scene->emission_scale;
    /* Between texels 27, 28, 35 and 36, counted from 0. */
    assert_true(fabs(seen_from(scene, 0, 0, 1).g * scale - 32.5) < 1e-4);
    /* The middle of the right edge, +x, lies between 31 and 39, and of the lower, +y,
     * between 59 and 60. */
    assert_true(fabs(seen_from(scene, 1, 0, 0).g * scale - 36.0) < 1e-4);
    assert_true(fabs(seen_from(scene, 0, 1, 0).g * scale - 60.5) < 1e-4);
    for (int k = 0; k < 8; k++) {
        double a = 0.785 * k + 0.1, e = 1e-6;
        const double ways[][3] = {{0, e, 0}, {e, 0, 0}};
        for (int i = 0; i < 2; i++) { /* the planes x = 0, y = 0 below: the edges */
            double x = i == 0 ? 0.0 : cos(a), y = i == 0 ? cos(a) : 0.0;
            double z = -fabs(sin(a));
            struct rgb one = seen_from(scene, x + ways[i][1], y + ways[i][0], z);
            struct rgb two = seen_from(scene, x - ways[i][1], y - ways[i][0], z);
            assert_true(fabs(one.g - two.g) * scale < 1e-3);
        }
    }
    scene_destroy(scene);
}

/* pbrt's convention, which light_desc states: row 0 is +z, u runs from x to y. */
static void test_orientation(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    struct texture_image *map = texture_image_create(&desc->textures, 8, 4);
    for (int i = 0; i < 32; i++)
        for (int k = 0; k < 3; k++)
            map->floats[3 * i + k] = (float)(1 + i);
    struct light_desc light = {.type = &light_environment,
                               .intensity = rgb_grey(1.0),
                               .to_world = xform_identity(),
                               .map = map};
    scene_desc_add_light(desc, &light);
    test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                rgb_grey(0.0), false);
    struct scene *scene = test_build(desc, false);
    /* Texel (2, 1) has its centre at phi = 2 pi 2.5/8, theta = pi 1.5/4. */
    double phi = 2.0 * MATH_PI * 2.5 / 8.0, theta = MATH_PI * 1.5 / 4.0;
    struct vec3 w = {(float)(-sin(theta) * cos(phi)), (float)(-sin(theta) * sin(phi)),
                     (float)-cos(theta)};
    struct ray_endpoint point = {.ng = w};
    struct rgb seen = light_emission(scene->environment, &point, w);
    assert_true(fabs(seen.g * scene->emission_scale - 11.0) < 1e-4);
    scene_destroy(scene);
}

/* Four quarters of the sphere, each of one brightness inside, whose mean is known. What
 * is above the mean has it taken off, what is below keeps a twentieth [Karlik19]. Cells
 * that are compared lie as high as each other over the equator or below it. */
static void test_compensation(void **state)
{
    (void)state;
    static const double value[2][2] = {{6.0, 4.0}, {1.0, 0.5}};
    const double mean = 11.5 / 4.0;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    struct texture_image *map = texture_image_create(&desc->textures, 16, 8);
    for (int i = 0; i < 3 * 128; i++)
        map->floats[i] = (float)value[i / 3 / 64][i / 3 / 8 % 2];
    struct light_desc light = {.type = &light_environment,
                               .intensity = rgb_grey(1.0),
                               .to_world = xform_identity(),
                               .map = map};
    scene_desc_add_light(desc, &light);
    test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                rgb_grey(0.0), false);
    struct scene *scene = test_build(desc, false);
    double unit = 0.0;
    for (int k = 0; k < 4; k++) {
        double phi = 2.0 * MATH_PI * (k % 2 ? 11.5 : 3.5) / 16.0;
        double theta = MATH_PI * (k < 2 ? 1.5 : 6.5) / 8.0;
        struct ray_endpoint point = {.ng = {(float)(-sin(theta) * cos(phi)),
                                            (float)(-sin(theta) * sin(phi)),
                                            (float)-cos(theta)}};
        double shines = value[k / 2][k % 2];
        double expected = fmax(shines - mean, 0.05 * shines);
        double pdf = scene->environment->type->pdf_point(scene->environment, &point);
        unit = k == 0 ? pdf / expected : unit;
        assert_true(fabs(pdf / (unit * expected) - 1.0) < 1e-5); /* of a float */
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sampling),
        cmocka_unit_test(test_octahedral),
        cmocka_unit_test(test_octahedral_orientation),
        cmocka_unit_test(test_orientation),
        cmocka_unit_test(test_compensation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
