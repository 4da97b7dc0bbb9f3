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
        "bootstrap=20000", NULL

static const char *const setups[][8] = {
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

/* Where a table of all chains and tiles takes too much, the tiles are larger: four for
 * sixteen here. They see it as well. */
static void larger_tiles_see_it(void **state)
{
    (void)state;
    const char *const words[] = {
        "integrator=pssmlt", "builder=pt", "estimator=plain", "mutations_per_pixel=64",
        "max_depth=2",       "chains=64",  "bootstrap=20000", NULL};
    struct scene *dim = rooms(1e-6, 2 * SIDE);
    enum verdict_call call;
    double limit = 64.0 * 4.0 * sizeof(double);
    assert_true(says(dim, words, 0.0, "large steps find", &call));
    assert_true(says(dim, words, limit, "in 2 tiles large steps find", &call));
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_dim_room_is_missed),
                                       cmocka_unit_test(larger_tiles_see_it),
                                       cmocka_unit_test(few_chains_are_doubted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
