/* Inverse samples of lights and cameras: the choice of a light with a point on it, the
 * direction that leaves it, and the position on the film. The numbers found give the same
 * point and direction again. The choice loses what its number is within its interval; so
 * the numbers found are compared with those that were drawn, by chi-squared of 6 x 6 x 6
 * cells, 20000 of each. All scenes together raise a false alarm with the rate
 * FALSE_ALARM. By the noncentral law, a light of half of the power that is picked 13 %
 * too often is seen with a power of .9; a number kept in place of one drawn gives p below
 * 1e-50. */

#include "math/rng.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define SAMPLES     40000
#define SIDE        6
#define CELLS       (SIDE * SIDE * SIDE)

/* In units of 2^-24, of directions, and of places relative to the largest coordinate: the
 * rounding of a place on a curved surface, and of a direction in its frame. */
#define ULPS 8.0

/* Lamps of all shapes. */
static struct scene *lamps(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    static const enum shape_kind kinds[] = {SHAPE_SPHERE, SHAPE_DISK, SHAPE_CYLINDER,
                                            SHAPE_MESH};
    test_room(desc);
    for (int i = 0; i < 4; i++) {
        const double profile[] = {0.3, 0.0, 0.5, 0.3, 0.1, 0.6};
        struct xform place = xform_translate(0.5 * i - 0.8, 0.7 + 0.2 * i, 0.1 * i);
        struct xform turn = xform_rotate(40.0, 1.0, 0.3, 0.2 * i);
        struct shape_desc shape = {
            .kind = kinds[i],
            .mesh = kinds[i] == SHAPE_MESH ? mesh_lathe(profile, 3, 7, false, 0.0) : NULL,
            .to_world = xform_mul(&place, &turn),
            .radius = 0.2 + 0.05 * i,
            .height = 0.1,
            .z_min = -0.1,
            .z_max = 0.3,
            .material = black,
            .emits = true,
            .two_sided = i % 2 == 1,
            .radiance = rgb_grey(1.0 + i)};
        scene_desc_add_shape(desc, &shape);
    }
    return test_build(desc, false);
}

static double apart(struct vec3 a, struct vec3 b, double scale)
{
    struct vec3 d = vec3_sub(a, b);
    return sqrt((double)vec3_dot(d, d)) / (scale * 0x1p-24);
}

static int cell(const double u[3])
{
    int at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (int)(u[i] * SIDE);
    return (at[0] * SIDE + at[1]) * SIDE + at[2];
}

static void draw(struct rng *rng, double *u, int count)
{
    for (int i = 0; i < count; i++)
        u[i] = rng_double(rng);
}

/* Returns the difference, in ulps, of what is sampled again. */
static double check_direction(const struct light *light, const struct ray_endpoint *at,
                              struct rng *rng)
{
    struct ray_endpoint point = *at, again = *at;
    double u[2], v[2], pdf;
    struct vec3 w, back;
    struct rgb weight;
    draw(rng, u, 2);
    draw(rng, v, 2);
    if (!light->type->sample_direction(light, &point, u, &w, &pdf, &weight))
        return 0.0;
    /* A path from infinity goes through some place in the scene. */
    struct vec3 through = vec3_mad(point.p, (float)rng_double(rng), w);
    assert_true(light->type->invert_direction(light, &point, w, through, v));
    assert_true(light->type->sample_direction(light, &again, v, &back, &pdf, &weight));
    double scale = light->infinite ? light->sphere.radius : 5.0;
    return fmax(apart(w, back, 1.0), apart(point.p, again.p, scale));
}

static bool check_lights(const char *name, const struct scene *scene, double level,
                         struct rng *rng)
{
    double before[CELLS] = {0.0}, after[CELLS] = {0.0}, worst = 0.0, worst_w = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        double u[3], v[3];
        struct hit point, again;
        draw(rng, u, 3);
        draw(rng, v, 3);
        const struct light *light = light_sample(scene, u[0], u + 1, &point);
        assert_true(light_invert(scene, light, &point, &v[0], v + 1));
        (i % 2 ? before : after)[cell(i % 2 ? u : v)] += 1.0;
        assert_ptr_equal(light_sample(scene, v[0], v + 1, &again), light);
        worst = fmax(worst, light->infinite ? apart(point.at.ng, again.at.ng, 1.0)
                                            : apart(point.at.p, again.at.p, 5.0));
        worst_w = fmax(worst_w, check_direction(light, &point.at, rng));
    }
    double p = stat_chi2_two_p(before, after, CELLS);
    printf("%-14s %d lights: points within %.3g ulp, directions %.3g; p %.3g\n", name,
           scene->light_count, worst, worst_w, p);
    assert_true(worst <= ULPS && worst_w <= ULPS);
    return stat_ok(name, p, level);
}

/* In units of the lens. */
static double check_lens(const struct camera *camera, const struct ray_endpoint *from,
                         const struct ray_endpoint *start, struct vec3 w, struct rng *rng)
{
    double v[2];
    draw(rng, v, 2);
    assert_true(camera_invert_lens(camera, start, w, v));
    struct ray_endpoint again = camera_sample_lens(camera, v);
    double size = (double)vec3_max_abs(camera->origin) + camera->lens_radius;
    return apart(from->p, again.p, size);
}

static void check_camera(const char *name, const struct scene *scene, struct rng *rng)
{
    const struct camera *camera = &scene->camera;
    double worst = 0.0, worst_lens = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        double lens[2], u[2], v[2], pdf;
        struct vec3 w;
        draw(rng, lens, 2);
        draw(rng, u, 2);
        struct ray_endpoint centre = camera_sample_lens(camera, lens), from = centre;
        camera_sample_direction(camera, &from, u, &w, &pdf);
        worst_lens = fmax(worst_lens, check_lens(camera, &centre, &from, w, rng));
        /* A film position that rounds to the edge has no inverse. */
        if (!camera_invert_direction(camera, &from, w, v)) {
            double edge = fmin(fmin(u[0], 1.0 - u[0]), fmin(u[1], 1.0 - u[1]));
            assert_true(edge < 1e-6);
            continue;
        }
        worst = fmax(worst, fmax(fabs(u[0] - v[0]), fabs(u[1] - v[1])) / 0x1p-24);
    }
    printf("%-14s camera: film positions within %.3g ulp, lens points %.3g\n", name,
           worst, worst_lens);
    assert_true(worst <= 4.0 && worst_lens <= ULPS);
}

static void test_lights_and_cameras(void **state)
{
    struct rng rng;
    bool ok = true;
    double level = stat_sidak(FALSE_ALARM, TEST_CONTENTS + 1);
    (void)state;
    rng_init(&rng, 42, RNG_TEST, 0);
    for (int i = 0; i <= TEST_CONTENTS; i++) {
        const char *name = i < TEST_CONTENTS ? test_contents_name[i] : "lamps";
        struct scene *scene = i < TEST_CONTENTS ? test_scene((enum test_contents)i, false)
                                                : lamps();
        ok = check_lights(name, scene, level, &rng) && ok;
        check_camera(name, scene, &rng);
        scene_destroy(scene);
    }
    assert_true(ok);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lights_and_cameras),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
