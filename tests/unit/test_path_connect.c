/* Connections to an environment whose density is 0 in the direction that was sampled: as
 * that is rounded to floats, it may lie in a black cell beside the one that was chosen.
 * Such a path carries nothing, where 0 / 0 would spoil its pixel. No false alarms. */

#include "path/connect.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static double no_density(const struct light *light, const struct ray_endpoint *point)
{
    (void)light, (void)point;
    return 0.0;
}

static struct rgb black(const struct light *light, const struct ray_endpoint *point,
                        struct vec3 w)
{
    (void)light, (void)point, (void)w;
    return rgb_grey(0.0);
}

static const double *half(struct ustream *self, int place, int count)
{
    static double value[64];
    (void)self, (void)count;
    for (int i = 0; i < 64; i++)
        value[i] = 0.5;
    return value + place;
}

/* A floor under a constant sky, with another type of light in the environment's place. */
static struct scene *sky_over_floor(const struct light_type *type)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 5), vec3(0, 0.1f, 0), 34.0, 16);
    test_quad(desc, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    struct light_desc sky = {.type = &light_environment,
                             .intensity = rgb_grey(1.0),
                             .to_world = xform_identity()};
    scene_desc_add_light(desc, &sky);
    struct scene *scene = test_build(desc, false);
    scene->lights[0].type = type;
    return scene;
}

/* All numbers whose direction lies above the floor, but for the horizon. */
static int connections(const struct light_type *type, int failures[2])
{
    struct scene *scene = sky_over_floor(type);
    struct subpaths paths;
    struct ustream numbers = {half};
    int good = 0;
    subpaths_init(&paths, scene, 3);
    walk_camera(&paths, &numbers, 2, HIT_ANY);
    assert_int_equal(paths.camera_count, 2);
    for (int i = 0; i < 100; i++) {
        struct connection x;
        const double u[3] = {0.5, (i / 10 + 0.5) / 10, (i % 10 + 0.5) / 10};
        enum failure failure = connect_light(&paths, u, &paths.camera[1],
                                             MIS_BIDIRECTIONAL, &x, NULL);
        good += failure == FAILURE_NONE;
        failures[failure == FAILURE_ZERO] += failure != FAILURE_NONE;
        if (failure == FAILURE_NONE)
            assert_true(isfinite(x.value.r) && isfinite(x.weight) && x.value.r > 0.0);
    }
    walk_light(&paths, &numbers, 3, HIT_ANY);
    assert_true(type == &light_environment || paths.light_count == 0);
    subpaths_deinit(&paths);
    scene_destroy(scene);
    return good;
}

static void test_no_density(void **state)
{
    (void)state;
    struct light_type shines = light_environment, dark;
    shines.pdf_point = no_density;
    dark = shines;
    dark.emission = black;
    int failures[2] = {0};
    assert_true(connections(&light_environment, failures) > 20);
    for (int k = 0; k < 2; k++) {
        memset(failures, 0, sizeof failures);
        assert_int_equal(connections(k ? &dark : &shines, failures), 0);
        assert_int_equal(failures[0], 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_density)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
