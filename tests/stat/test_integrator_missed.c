/* Places that chains do not reach, though independent large steps see light there: two
 * rooms, of which one has a millionth of the other's light. Without a film of large steps
 * the dim one comes out too dark, and the run has to say so; two rooms alike have nothing
 * to hide. A few chains of every length on deep paths: none may be called converged. */
#include "support/stability_cases.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define SIDE 32

static struct scene *rooms(double x, int side)
{
    struct scene_desc *desc = make_two_rooms(x);
    desc->width = desc->height = side;
    return test_build(desc, false);
}

/* Whether these words are in the verdict; limit: settings.memory_limit. */
static bool says(const struct scene *scene, const char *const *words, double limit,
                 const char *what, enum verdict_call *call)
{
    struct settings s = test_settings(words);
    s.memory_limit = limit;
    struct run_result r = test_run(scene, &s);
    bool found = strstr(r.verdict.words, what) != NULL;
    printf("%s %s: %s: %s\n", words[0], words[1], verdict_name(r.verdict.call),
           r.verdict.words);
    *call = r.verdict.call;
    run_result_deinit(&r);
    return found;
}

#define PLAIN                                                                 \
    "estimator=plain", "mutations_per_pixel=256", "max_depth=2", "chains=64", \
        "bootstrap=20000", "rule=zsolnai2013", NULL

/* By the published rule, whose p_l is moderate here. */
static const char *const setups[][9] = {
    {"integrator=pssmlt", PLAIN},
    {"integrator=pssmlt", "builder=pt", PLAIN},
    {"integrator=mmlt", "direct=joint", PLAIN},
    {"integrator=pfmlt", "direct=joint", PLAIN},
};

static void a_dim_room_is_missed(void **state)
{
    (void)state;
    struct scene *dim = rooms(1e-6, SIDE), *alike = rooms(1.0, SIDE);
    for (size_t i = 0; i < sizeof setups / sizeof setups[0]; i++) {
        enum verdict_call call;
        assert_true(says(dim, setups[i], 0.0, "large steps find", &call));
        assert_int_equal(call, VERDICT_NOT);
        assert_false(says(alike, setups[i], 0.0, "large steps find", &call));
        assert_int_equal(call, VERDICT_CONVERGED);
    }
    scene_destroy(dim);
    scene_destroy(alike);
}

/* Films so small and runs so short that hardly a large step meets the dim room, or none:
 * its brightness tells, or the bootstrap does. Runs without a bootstrap path there (of
 * about eight a run, so one in 3000) would be silent: all eight tell but for a chance of
 * 3e-3. A room of 1/4 holds far more than ten states: with Poisson's law none in
 * 1e9 is called dim. */
static void few_large_steps_will_do(void **state)
{
    (void)state;
    static const double dim[] = {1e-12, 1e-6};
    const char *words[] = {"integrator=mmlt",         "direct=joint", "estimator=plain",
                           "mutations_per_pixel=512", "max_depth=2",  "chains=8",
                           "bootstrap=32000",         NULL,           NULL};
    for (int k = 0; k < 2; k++) {
        struct scene *scene = rooms(dim[k], 4), *alike = rooms(0.25, 4);
        for (int seed = 1; seed <= 4; seed++) {
            char text[32];
            enum verdict_call call;
            snprintf(text, sizeof text, "seed=%d", seed);
            words[7] = text;
            assert_true(says(scene, words, 0.0, "of the film, about", &call));
            assert_int_equal(call, VERDICT_NOT);
            assert_false(says(alike, words, 0.0, "of the film, about", &call));
        }
        scene_destroy(scene);
        scene_destroy(alike);
    }
}

/* Plain samples light a place that chains hardly add to: nothing there is missing. */
static void light_of_plain_samples_is_no_doubt(void **state)
{
    (void)state;
    const char *const words[] = {
        "integrator=mmlt", "direct=separate", "estimator=plain", "mutations_per_pixel=64",
        "max_depth=3",     "chains=16",       "bootstrap=20000", NULL};
    struct scene_desc *desc = make_two_rooms(1.0);
    for (int side = -1; side <= 1; side += 2) {
        double albedo = side < 0 ? 0.9 : 1e-7;
        test_quad(desc, vec3(1.5f * (float)side, 1, 0), vec3(0, 1, 0), vec3(0, 0, 2),
                  test_diffuse(desc, albedo, albedo, albedo), rgb_grey(0.0));
    }
    desc->width = desc->height = SIDE;
    struct scene *scene = test_build(desc, false);
    enum verdict_call call;
    assert_false(says(scene, words, 0.0, "of the film, about", &call));
    scene_destroy(scene);
}

/* Where a table of all chains and tiles takes too much, the tiles are larger: four for
 * sixteen here. They see it as well. */
static void larger_tiles_see_it(void **state)
{
    (void)state;
    const char *const words[] = {
        "integrator=pssmlt",      "builder=pt",       "estimator=plain",
        "mutations_per_pixel=64", "max_depth=2",      "chains=64",
        "bootstrap=20000",        "rule=zsolnai2013", NULL};
    struct scene *dim = rooms(1e-6, 2 * SIDE);
    enum verdict_call call;
    double limit = 64.0 * 4.0 * sizeof(double);
    assert_true(says(dim, words, 0.0, "large steps find", &call));
    assert_true(says(dim, words, limit, "in 2 places large steps find", &call));
    scene_destroy(dim);
}

/* Two chains a length, paths of thirty edges: whatever the seed, what hangs on so few
 * chains has not converged. */
static void few_chains_are_doubted(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_ROUGH, false);
    const char *words[] = {
        "integrator=mmlt", "chains=2", "max_depth=30", NULL, NULL, NULL};
    words[3] = "mutations_per_pixel=800";
    for (int seed = 1; seed <= 3; seed++) {
        char text[32];
        enum verdict_call call;
        snprintf(text, sizeof text, "seed=%d", seed);
        words[4] = text;
        assert_true(says(scene, words, 0.0, "fewer than 4 chains", &call));
        assert_int_equal(call, VERDICT_NOT);
    }
    scene_destroy(scene);
}

/* All light that plain chains add is known beforehand, however much b is refined on the
 * way and however few chains a length has: no part can be brighter than another. */
static void brightness_that_is_known_is_no_doubt(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_ROUGH, false);
    const char *words[] = {"integrator=mmlt", "chains=32",
                           "max_depth=6",     "bootstrap=3000",
                           "estimator=plain", "mutations_per_pixel=128",
                           "direct=joint",    NULL};
    struct settings s = test_settings(words);
    struct run_result r = test_run(scene, &s);
    int least = r.statistics.lengths[0].chains, most = least;
    for (int i = 1; i < r.statistics.length_count; i++) {
        int chains = r.statistics.lengths[i].chains;
        least = chains < least ? chains : least;
        most = chains > most ? chains : most;
    }
    assert_true(least < s.replicas && most >= s.replicas);
    assert_true(r.verdict.agreement_p == 1.0);
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* A room in yellow light, and a blue lamp behind glass that paths find by chance alone:
 * its noise is hardly any of luminance. Without a colour that stands apart no doubt. */
static void noise_of_one_colour_is_seen(void **state)
{
    (void)state;
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=64", "max_depth=5",
                                 NULL};
    for (int blue = 0; blue < 2; blue++) {
        struct scene_desc *desc = test_desc(vec3(0, 1, 3.5f), vec3(0, 1, 0), 40.0, SIDE);
        int glass = test_material(desc, "dielectric", NULL, rgb_grey(0.0), NULL, 0.0);
        int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
        test_room(desc);
        test_lamp(desc, 0.9, rgb(1.0, 1.0, blue ? 0.2 : 1.0));
        test_sphere(desc, vec3(0.5f, 0.5f, 0), 0.2, glass, rgb_grey(0.0), false);
        test_sphere(desc, vec3(0.5f, 0.5f, 0), 0.1, black,
                    rgb(0.0, 0.0, blue ? 40.0 : 1e-3), false);
        struct scene *scene = test_build(desc, false);
        enum verdict_call call;
        assert_true(says(scene, words, 0.0, "noise of blue", &call) == (blue == 1));
        assert_int_equal(call, blue ? VERDICT_NOT : VERDICT_CONVERGED);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dim_room_is_missed),
        cmocka_unit_test(few_large_steps_will_do),
        cmocka_unit_test(light_of_plain_samples_is_no_doubt),
        cmocka_unit_test(larger_tiles_see_it),
        cmocka_unit_test(few_chains_are_doubted),
        cmocka_unit_test(brightness_that_is_known_is_no_doubt),
        cmocka_unit_test(noise_of_one_colour_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
