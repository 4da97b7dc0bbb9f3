/* Every integrator and its main designs (support/designs.h) on a diffuse scene, on one
 * with glass, a lens and a point light, and on one whose lamp and camera are behind panes
 * and which has a masked card, against tables of what bdpt's estimator gives
 * in the long run. test_integrator_grey.c, whose truth is exact, sees smaller errors of
 * the picture as a whole; here is what a furnace, where all is alike, cannot show. Then b
 * and its standard error.
 *
 * False alarms: FALSE_ALARM for all figures of all designs and scenes together. What the
 * pictures' tests see is printed. */

#include "path/estimate.h"
#include "support/designs.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define REPLICATES  40

/* --- scenes whose truth is a table ------------------------------------------------ */

/* Means over 40 batches of 200000 samples of bdpt's estimator, no run's nor film's; pt's
 * agrees where it finds all light. With ETALON_REFERENCE=1 the test prints the table. */
static const struct reference {
    enum test_contents contents;
    bool pt; /* finds all light: not the caustic of a point light */
    double mutations;
    struct truth truth;
} references[] = {
    {.contents = TEST_DIFFUSE,
     .pt = true,
     .mutations = 60.0,
     .truth = {{0.293901, 0.293901, 1, 0.34535, 0.202309, 1.52862, 1.44896, 0.622154,
                0.400274, 0.146846, 0.0972357, 0.030628, 0.0137324, 0.00545959},
               {0.0005, 0.0005, 0, 0.0006, 0.0004, 0.004, 0.003, 0.001, 0.0007, 0.0005,
                2e-05, 1e-05, 7e-06, 3e-06}}},
    {.contents = TEST_POINT,
     .pt = false,
     .mutations = 60.0,
     .truth = {{0.433888, 0.433888, 1, 0.563416, 0.294476, 1.17164, 1.32006, 0.546674,
                0.961632, 0.186499, 0.149949, 0.0467592, 0.0343525, 0.0163278},
               {0.0005, 0.0005, 0, 0.0006, 0.0004, 0.002, 0.002, 0.0007, 0.002, 0.0005,
                5e-05, 2e-05, 3e-05, 2e-05}}},
    {.contents = TEST_PANES,
     .pt = true,
     .mutations = 60.0,
     .truth = {{0.656195, 0.656195, 1, 0.818394, 0.372921, 1.15278, 0.967564, 1.06006,
                0.819601, 0.127525, 0.468693, 0.0386295, 0.0145717, 0.00677665},
               {0.0006, 0.0006, 0, 0.0008, 0.0004, 0.002, 0.001, 0.002, 0.001, 0.0004,
                0.0004, 5e-05, 2e-05, 1e-05}}},
};

#define REFERENCES ((int)(sizeof references / sizeof references[0]))

#define BATCHES       40
#define BATCH_SAMPLES 200000

static void add_sample(const struct contrib *c, double sum[FIGURES])
{
    for (int i = 0; i < c->count; i++) {
        const struct splat *s = &c->splats[i];
        double luminance = rgb_luminance(s->value);
        int x = s->pixel % DESIGN_SIDE, y = s->pixel / DESIGN_SIDE;
        int quarter = 2 * (2 * y / DESIGN_SIDE) + 2 * x / DESIGN_SIDE;
        sum[FIGURE_FILM] += luminance;
        sum[FIGURE_RED] += s->value.r;
        sum[FIGURE_BLUE] += s->value.b;
        sum[FIGURE_QUARTER + quarter] += 4.0 * luminance;
        sum[FIGURE_LENGTH + s->s + s->t - 2] += luminance;
    }
}

/* One batch's figures. */
static void estimate_batch(struct subpaths *paths, const struct numbers *numbers,
                           struct contrib *c, double scale, struct welford of[FIGURES])
{
    double sum[FIGURES] = {0.0};
    for (long i = 0; i < BATCH_SAMPLES; i++) {
        estimate_bdpt_techniques(paths, numbers, c);
        add_sample(c, sum);
    }
    for (int i = 0; i < FIGURES; i++)
        sum[i] *= scale / BATCH_SAMPLES;
    sum[FIGURE_B] = sum[FIGURE_FILM];
    for (int i = 0; i < 4; i++)
        sum[FIGURE_QUARTER + i] /= sum[FIGURE_FILM];
    sum[FIGURE_FILM_B] = 1.0;
    for (int i = 0; i < FIGURES; i++)
        welford_add(&of[i], sum[i]);
}

static void print_reference(const struct scene *scene)
{
    struct subpaths paths;
    struct rng rng;
    struct ustream_random u;
    struct contrib c;
    struct welford of[FIGURES] = {{0}};
    rng_init(&rng, 31, RNG_TEST, 0);
    ustream_random_init(&u, &rng);
    subpaths_init(&paths, scene, DESIGN_DEPTH);
    contrib_init(&c, estimate_splats_techniques(DESIGN_DEPTH));
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    for (int i = 0; i < BATCHES; i++)
        estimate_batch(&paths, &numbers, &c, scene->emission_scale, of);
    for (int i = 0; i < FIGURES; i++)
        printf("%s%.6g", i ? ", " : "{", of[i].mean);
    for (int i = 0; i < FIGURES; i++)
        printf("%s%.1g", i ? ", " : "},\n{", welford_se(&of[i]));
    printf("}\n");
    contrib_deinit(&c);
    subpaths_deinit(&paths);
}

static void check_scene(const struct reference *reference)
{
    struct scene *scene = test_scene(reference->contents, false);
    const char *name = test_contents_name[reference->contents];
    double level = stat_sidak(FALSE_ALARM, FIGURES * DESIGNS * REFERENCES), sees;
    if (getenv("ETALON_REFERENCE")) {
        print_reference(scene);
        scene_destroy(scene);
        return;
    }
    int count = getenv("ETALON_LONG") ? DESIGNS : DESIGNS - VARIANTS;
    for (int i = 0; i < count; i++) {
        if (!reference->pt && design_over_pt(&designs[i]))
            continue;
        struct figures f = design_run(scene, &designs[i], REPLICATES,
                                      reference->mutations);
        design_print(name, &designs[i]);
        assert_true(figures_agree(name, &f, &reference->truth, level, &sees));
    }
    scene_destroy(scene);
}

static void test_scenes(void **state)
{
    (void)state;
    for (int i = 0; i < REFERENCES; i++)
        check_scene(&references[i]);
}

/* --- b and its standard error ----------------------------------------------------- */

static const char *const brightness_variants[][2] = {
    {"integrator=pssmlt", "mutations_per_pixel=20"},
    {"integrator=mmlt", "mutations_per_pixel=100"},
    {"integrator=mmlt", "direct=separate"},
    {"integrator=pfmlt", "mutations_per_pixel=100"},
};

/* Whether normal 95 % intervals of short runs hold the true brightness as often as they
 * should. */
static void check_coverage(const struct scene *scene, const char *const variant[2],
                           const struct run_statistics *truth, double level)
{
    const char *const words[] = {"mutations_per_pixel=60",
                                 "bootstrap=2000",
                                 "max_depth=4",
                                 variant[0],
                                 variant[1],
                                 NULL};
    const int runs = 100;
    struct settings s = test_settings(words);
    int covered = 0;
    for (int i = 0; i < runs; i++) {
        s.seed = 1000 + i;
        struct run_result r = test_run(scene, &s);
        double se = hypot(r.statistics.b_se, truth->b_se);
        covered += fabs(r.statistics.b - truth->b) <= 1.96 * se;
        run_result_deinit(&r);
    }
    printf("%s, %s: b +- 1.96 b_se covers the truth in %d of %d runs\n", variant[0],
           variant[1], covered, runs);
    assert_true(stat_ok("coverage", stat_binomial_p(covered, runs, 0.95), level));
}

static void test_brightness_coverage(void **state)
{
    (void)state;
    const char *const reference[] = {"integrator=bdpt", "mutations_per_pixel=3000",
                                     "max_depth=4", NULL};
    const int count = (int)(sizeof brightness_variants / sizeof *brightness_variants);
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(reference);
    struct run_result truth = test_run(scene, &s);
    for (int i = 0; i < count; i++)
        check_coverage(scene, brightness_variants[i], &truth.statistics,
                       stat_sidak(FALSE_ALARM, count));
    run_result_deinit(&truth);
    scene_destroy(scene);
}

/* b is right in the mean, however poor the bootstrap: a length that it found bright gets
 * more chains, hence more large steps, and must not count for less because of it. */
static void test_brightness_mean(void **state)
{
    (void)state;
    const char *const reference[] = {"integrator=bdpt", "mutations_per_pixel=2500",
                                     "max_depth=6", NULL};
    static const char *const allocation[] = {"allocation=error", "allocation=brightness"};
    struct scene *scene = test_scene(TEST_POINT, false);
    struct settings s = test_settings(reference);
    struct run_result truth = test_run(scene, &s);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {
            "integrator=mmlt", allocation[i], "mutations_per_pixel=10",
            "bootstrap=240",   "max_depth=6", NULL};
        struct welford b = {0};
        s = test_settings(words);
        for (s.seed = 1; s.seed <= 300; s.seed++) {
            struct run_result r = test_run(scene, &s);
            welford_add(&b, r.statistics.b);
            run_result_deinit(&r);
        }
        double z = (b.mean - truth.statistics.b) /
                   hypot(welford_se(&b), truth.statistics.b_se);
        printf("%s: mean of b over %.0f runs %.5f +- %.5f, truth %.5f +- %.5f, z %.2f\n",
               allocation[i], b.count, b.mean, welford_se(&b), truth.statistics.b,
               truth.statistics.b_se, z);
        assert_true(stat_ok("mean of b", stat_z_p(z), stat_sidak(FALSE_ALARM, 2)));
    }
    run_result_deinit(&truth);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenes),
        cmocka_unit_test(test_brightness_coverage),
        cmocka_unit_test(test_brightness_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
