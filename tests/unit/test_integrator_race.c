/* auto: the errors by which it chooses, from pictures whose noise is known, the least
 * that chains can have, and where they stay at few places; and that its picture is, bit
 * by bit, that of the chosen integrator with the rest of the budget, so that the choice
 * makes no bias.
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
#define DRAWS       16 /* a pixel */
#define FALSE_ALARM 1e-4
#define SEES        0.02

#define BRIGHTNESS(x) (0.02f + (float)((x) < WIDTH / 3 ? 0 : (x)) / WIDTH)

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

/* Flat pictures with noise; method 0 has chains. */
static void make(int number, struct race_halves halves[METHODS])
{
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, (uint64_t)number);
    for (int k = 0; k < METHODS; k++) {
        halves[k].samples = 1e6;
        halves[k].independent = k > 0;
        for (int half = 0; half < 2; half++) {
            halves[k].picture[half] = pictures[k][half];
            for (int j = 0; j < PIXELS; j++)
                pictures[k][half][j] = (float)(1.0 + spread[k] * noise(&rng));
        }
    }
}

static void find(const struct race_halves *halves, double *errors)
{
    static float scale[PIXELS];
    race_level(halves, METHODS, (long)PIXELS);
    race_weigh(halves, METHODS, WIDTH, HEIGHT, 0.01, scale);
    race_errors(halves, METHODS, WIDTH, HEIGHT, scale, errors);
}

static void check(const char *name, const struct welford *w, double expected)
{
    double se = welford_se(w), t = (w->mean - expected) / se;
    printf("%s: %.4g +- %.2g, expected %.4g\n", name, w->mean, se, expected);
    assert_true(se < SEES * expected);
    assert_true(stat_ok(name, stat_t_p(t, REPLICATES - 1.0), stat_sidak(FALSE_ALARM, 6)));
}

static void test_errors(void **state)
{
    (void)state;
    struct welford sums[METHODS] = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        double errors[METHODS];
        make(n, halves);
        find(halves, errors);
        for (int k = 0; k < METHODS; k++)
            welford_add(&sums[k], errors[k]);
    }
    for (int k = 0; k < METHODS; k++)
        check("error", &sums[k], 0.5 * spread[k] * spread[k] / 1.01);
}

/* Chains of which one half is too bright as a whole have the same error: the brightness
 * of pilots is not judged. */
static void test_brightness(void **state)
{
    (void)state;
    struct welford sum = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        double errors[METHODS];
        make(REPLICATES + n, halves);
        for (int j = 0; j < PIXELS; j++)
            pictures[0][1][j] *= 3.0f;
        find(halves, errors);
        welford_add(&sum, errors[0]);
    }
    check("brightness", &sum, 0.5 * spread[0] * spread[0] / 1.01);
}

/* All that chains see, they see at one place in each half: next to what independent
 * samples find everywhere that is a great error. */
static void test_stuck(void **state)
{
    (void)state;
    struct welford sum = {0};
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        double errors[METHODS];
        make(2 * REPLICATES + n, halves);
        memset(pictures[0], 0, sizeof pictures[0]);
        for (int half = 0; half < 2; half++)
            pictures[0][half][(17 + half) * WIDTH + 11] = PIXELS;
        find(halves, errors);
        welford_add(&sum, errors[0]);
    }
    /* A pixel of PIXELS in each of two blocks. */
    check("stuck", &sum, 0.5 * PIXELS / 1.01);
}

/* Pictures of independent draws have the error that is predicted for them: brightness
 * grows from left to right, and a third of the picture is nearly black. */
static void test_draws(void **state)
{
    (void)state;
    struct welford sum = {0};
    static float scale[PIXELS];
    double predicted = 0.0;
    for (int n = 0; n < REPLICATES; n++) {
        struct race_halves halves[METHODS];
        struct rng rng;
        double draws = DRAWS * PIXELS, error = 0.0;
        make(3 * REPLICATES + n, halves);
        memset(pictures, 0, sizeof pictures);
        rng_init(&rng, 4, RNG_TEST, (uint64_t)n);
        for (int j = 0; j < PIXELS; j++)
            for (int k = 1; k < METHODS; k++)
                for (int half = 0; half < 2; half++)
                    pictures[k][half][j] = BRIGHTNESS(j % WIDTH);
        for (int i = 0; i < (int)draws; i++) {
            int x = (int)(rng_double(&rng) * WIDTH), y = (int)(rng_double(&rng) * HEIGHT);
            double u = rng_double(&rng) * (double)BRIGHTNESS(WIDTH - 1);
            if (u < (double)BRIGHTNESS(x))
                pictures[0][0][y * WIDTH + x] += 1.0f;
            else
                i--;
        }
        race_weigh(halves, METHODS, WIDTH, HEIGHT, 0.01, scale);
        predicted = race_draws_error(halves, METHODS, (long)PIXELS, scale);
        double mean = 0.0;
        for (int x = 0; x < WIDTH; x++)
            mean += (double)BRIGHTNESS(x) / WIDTH;
        for (int j = 0; j < PIXELS; j++) {
            double d = (double)pictures[0][0][j] / DRAWS * mean -
                       (double)BRIGHTNESS(j % WIDTH);
            error += pow(d * (double)scale[j] / PIXELS, 2.0);
        }
        welford_add(&sum, error * DRAWS);
    }
    check("draws", &sum, predicted);
}

/* What is not in the race is no guess of the brightness of pixels. */
static void test_nothing(void **state)
{
    (void)state;
    struct race_halves halves[METHODS];
    double errors[METHODS];
    make(0, halves);
    memset(pictures[2], 0, sizeof pictures[2]);
    halves[2].samples = 0.0;
    find(halves, errors);
    assert_true(isnan(errors[2]));
    assert_true(errors[1] < 1.2 * 0.5 * spread[1] * spread[1] / 1.01);
}

/* --- the picture -------------------------------------------------------------------- */

/* Of a race with these words, which `chosen` has to win for a reason with that text. */
static void check_picture(const char *const *words, const char *chosen,
                          const char *reason)
{
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    struct run_result all = test_run(scene, &s);
    size_t values = 3 * (size_t)all.image->width * (size_t)all.image->height;
    const struct race_figures *race = &all.statistics.race;
    printf("%s: %s\n", race->chosen, race->reason);
    assert_string_equal(race->chosen, chosen);
    assert_non_null(strstr(race->reason, reason));
    s.integrator = race->chosen;
    s.film_sampling = FILM_SAMPLING_ADAPTIVE;
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
    check_picture(short_run, "bdpt", "without a race");
    check_picture(race, "pt", "mmlt would have at least");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors),  cmocka_unit_test(test_brightness),
        cmocka_unit_test(test_nothing), cmocka_unit_test(test_stuck),
        cmocka_unit_test(test_draws),   cmocka_unit_test(test_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
