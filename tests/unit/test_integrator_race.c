/* auto: the errors by which it chooses, from pictures whose noise is known, and where
 * chains stay at few places; and that its picture is, bit by bit, that of the chosen
 * integrator with the rest of the budget, so that the choice makes no bias.
 *
 * Errors are held against what was planted by t-tests over REPLICATES pictures, false
 * alarms FALSE_ALARM for all together. Their standard errors are below 2 % (SEES,
 * asserted): an error that is wrong by 15 % is seen. */

#include <string.h>

#include "integrator/race_error.h"
#include "math/accum.h"
#include "math/rng.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define WIDTH       48
#define HEIGHT      36
#define PIXELS      (WIDTH * HEIGHT)
#define METHODS     3
#define REPLICATES  24
#define FALSE_ALARM 1e-4
#define SEES        0.02

static const double spread[METHODS] = {0.1, 0.3, 0.2}; /* of each half, relative */
static float pictures[METHODS][2][PIXELS];

/* A normal number, nearly: the sum of 12 uniform ones. */
static double noise(struct rng *rng)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += rng_double(rng);
    return sum;
}

/* Flat pictures with noise; method 0 lacks `dark` of the light in a quarter of it. */
static void make(int number, double dark, struct race_halves halves[METHODS])
{
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, (uint64_t)number);
    for (int k = 0; k < METHODS; k++) {
        halves[k].samples = 1e6;
        halves[k].independent = k > 0;
        for (int half = 0; half < 2; half++) {
            halves[k].picture[half] = pictures[k][half];
            for (int j = 0; j < PIXELS; j++) {
                double light = k == 0 && j < PIXELS / 4 ? 1.0 - dark : 1.0;
                pictures[k][half][j] = (float)(light + spread[k] * noise(&rng));
            }
        }
    }
}

static void find(const struct race_halves *halves, struct race_error *errors)
{
    static double sum[PIXELS];
    struct race_light light = {.sum = sum};
    memset(sum, 0, sizeof sum);
    race_errors(halves, METHODS, WIDTH, HEIGHT, 0.01, &light, errors);
}

static void check(const char *name, const struct welford *w, double expected)
{
    double se = welford_se(w), t = (w->mean - expected) / se;
    printf("%s: %.4g +- %.2g, expected %.4g\n", name, w->mean, se, expected);
    assert_true(se < SEES * expected);
    assert_true(stat_ok(name, stat_t_p(t, REPLICATES - 1.0), stat_sidak(FALSE_ALARM, 5)));
}

static void test_errors(void **state)
{
    (void)state;
    struct welford sums[METHODS] = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        struct race_error errors[METHODS];
        make(n, 0.0, halves);
        find(halves, errors);
        for (int k = 0; k < METHODS; k++) {
            welford_add(&sums[k], errors[k].relmse);
            assert_true(errors[k].missing == 0.0);
        }
    }
    for (int k = 0; k < METHODS; k++)
        check("error", &sums[k], 0.5 * spread[k] * spread[k] / 1.01);
}

static void test_missing(void **state)
{
    (void)state;
    struct welford sum = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        struct race_error errors[METHODS];
        make(REPLICATES + n, 0.4, halves);
        find(halves, errors);
        welford_add(&sum, errors[0].missing);
        assert_true(errors[1].missing == 0.0 && errors[2].missing == 0.0);
    }
    check("missing", &sum, 0.25 * 0.4 * 0.4 / 1.01);
}

/* All that chains see, they see at one place in each half: next to what independent
 * samples find everywhere that is a great error. */
static void test_stuck(void **state)
{
    (void)state;
    struct welford sum = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        struct race_error errors[METHODS];
        make(2 * REPLICATES + n, 0.0, halves);
        memset(pictures[0], 0, sizeof pictures[0]);
        for (int half = 0; half < 2; half++)
            pictures[0][half][(17 + half) * WIDTH + 11] = PIXELS;
        find(halves, errors);
        welford_add(&sum, errors[0].relmse);
    }
    /* A pixel of PIXELS in each of two blocks. */
    check("stuck", &sum, 0.5 * PIXELS / 1.01);
}

/* A method that finds next to nothing is noticed, however little its halves differ. */
static void test_nothing(void **state)
{
    (void)state;
    struct race_halves halves[METHODS];
    struct race_error errors[METHODS];
    make(0, 0.0, halves);
    for (int half = 0; half < 2; half++)
        for (int j = 0; j < PIXELS; j++)
            pictures[0][half][j] *= 1e-4f;
    halves[2].samples = 0.0; /* not in the race */
    find(halves, errors);
    assert_true(errors[0].missing > 0.9 && errors[1].missing == 0.0);
    assert_true(errors[1].relmse < 0.5); /* relative to the light that there is */
}

/* --- the picture -------------------------------------------------------------------- */

/* Of a race with these words, which `chosen` has to win. */
static void check_picture(const char *const *words, const char *chosen)
{
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    struct run_result all = test_run(scene, &s);
    size_t values = 3 * (size_t)all.image->width * (size_t)all.image->height;
    const struct race_figures *race = &all.statistics.race;
    printf("%s: %s\n", race->chosen, race->reason);
    assert_string_equal(race->chosen, chosen);
    s.integrator = race->chosen;
    s.mutations_per_pixel -= race->equal_paths / ((double)values / 3.0);
    struct run_result own = test_run(scene, &s);
    assert_memory_equal(all.image->pixels, own.image->pixels, values * sizeof(float));
    assert_true(all.statistics.paths == own.statistics.paths + race->paths);
    assert_true(all.statistics.b == own.statistics.b);
    run_result_deinit(&all);
    run_result_deinit(&own);
    scene_destroy(scene);
}

static void test_picture(void **state)
{
    (void)state;
    const char *const short_run[] = {"integrator=auto", "mutations_per_pixel=20",
                                     "max_depth=4", NULL};
    const char *const race[] = {"integrator=auto", "mutations_per_pixel=1500",
                                "max_depth=4", NULL};
    check_picture(short_run, "bdpt");
    check_picture(race, "pt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors),  cmocka_unit_test(test_missing),
        cmocka_unit_test(test_nothing), cmocka_unit_test(test_stuck),
        cmocka_unit_test(test_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
