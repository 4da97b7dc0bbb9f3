/* Films that path lengths share (integrator/markov/markov_films.c), in a white room whose
 * light is spread over many lengths: with room for one film all lengths but the brightest
 * share another, and the picture is that of films of their own but for noise. A bootstrap
 * of a handful of paths a length tells next to nothing about how the lengths compare, so
 * that is left to the run. False alarms: 1e-4 in all. */
#include "support/picture_test.h"

#include <stdlib.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define ALPHA 1e-4

/* Closed but for the wall behind the camera, and as white as milk. */
static struct scene *white_room(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 0.95f), vec3(0, 1, 0), 80.0, 4);
    int white = test_diffuse(desc, 0.95, 0.95, 0.95);
    struct rgb dark = {0.0, 0.0, 0.0};
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 1), vec3(1, 0, 0), white, dark);
    test_quad(desc, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1), white, dark);
    test_quad(desc, vec3(0, 1, -1), vec3(1, 0, 0), vec3(0, 1, 0), white, dark);
    test_quad(desc, vec3(0, 1, 1), vec3(0, 1, 0), vec3(1, 0, 0), white, dark);
    test_quad(desc, vec3(-1, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), white, dark);
    test_quad(desc, vec3(1, 1, 0), vec3(0, 0, 1), vec3(0, 1, 0), white, dark);
    test_lamp(desc, 0.4, rgb(3.0, 2.0, 1.0));
    return test_build(desc, false);
}

/* Replicates with films for all lengths (bytes 0), or for the brightest alone. */
static struct pictures render(const struct scene *scene, const char *const *words,
                              double bytes, int first_seed)
{
    struct pictures p;
    struct settings s = test_settings(words);
    s.memory_limit = bytes;
    for (int i = 0; i < PICTURE_REPLICATES; i++) {
        s.seed = first_seed + i;
        struct run_result r = test_run(scene, &s);
        p.run[i] = r.image;
        r.image = NULL;
        run_result_deinit(&r);
    }
    return p;
}

/* How many lengths have a hundredth of the light. */
static int bright_lengths(const struct scene *scene, const char *const *words)
{
    struct settings s = test_settings(words);
    struct run_result r = test_run(scene, &s);
    int count = 0;
    for (int i = 0; i < r.statistics.length_count; i++)
        count += r.statistics.lengths[i].b > 0.01 * r.statistics.b;
    run_result_deinit(&r);
    return count;
}

static void compare(const char *estimator)
{
    const char *const words[] = {"integrator=mmlt",
                                 "max_depth=28",
                                 "direct=joint",
                                 "bootstrap=300",
                                 "chains=60",
                                 "large_step_probability=0.5",
                                 getenv("ETALON_LONG") ? "mutations_per_pixel=20000"
                                                       : "mutations_per_pixel=2000",
                                 estimator,
                                 NULL};
    struct scene *scene = white_room();
    assert_true(bright_lengths(scene, words) > 16);
    struct pictures own = render(scene, words, 0.0, 1);
    struct pictures shared = render(scene, words, 1.0, 101);
    double level = stat_sidak(ALPHA, 2);
    bool same = picture_same(&shared, &own, 2, 2, level);
    pictures_deinit(&own);
    pictures_deinit(&shared);
    scene_destroy(scene);
    assert_true(same);
}

static void test_plain(void **state)
{
    (void)state;
    compare("estimator=plain");
}

static void test_kelemen(void **state)
{
    (void)state;
    if (!getenv("ETALON_LONG"))
        skip();
    compare("estimator=kelemen");
}

/* Where every length has a hit in the bootstrap, no chain starts from a black state,
 * every mutation weighs 1, and the picture's mean is b. */
static void test_nothing_lost(void **state)
{
    (void)state;
    const char *const words[] = {"integrator=mmlt",
                                 "max_depth=12",
                                 "direct=joint",
                                 "bootstrap=30000",
                                 "chains=60",
                                 "large_step_probability=0.5",
                                 "estimator=plain",
                                 "mutations_per_pixel=400",
                                 NULL};
    struct scene *scene = white_room();
    struct settings s = test_settings(words);
    s.memory_limit = 1.0;
    struct run_result r = test_run(scene, &s);
    assert_true(fabs(test_mean_over_b(&r) - 1.0) < 1e-6);
    run_result_deinit(&r);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_lost),
        cmocka_unit_test(test_plain),
        cmocka_unit_test(test_kelemen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
