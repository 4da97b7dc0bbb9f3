/* Error bars against a truth that is known: a white-ish diffuse disk that fills the film,
 * inside a sphere that emits radiance 1; every pixel is the disk's reflectance. Squared
 * errors less squared bars have mean 0 over replicate runs, and 95 % bars cover that
 * and little more. With ETALON_LONG=1 more runs. */

#include <string.h>

#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define ALBEDO      0.8
/* Bars of 95 % on few parts are wide: the rate is at least theirs. */
#define COVERS_LEAST 0.95
#define COVERS_MOST  0.985
#define SIDE         12
#define MOST         200

static const char *const runs[][5] = {
    {"integrator=pt", "max_depth=2", "mutations_per_pixel=64", NULL},
    {"integrator=bdpt", "max_depth=2", "mutations_per_pixel=64", NULL},
    {"integrator=pssmlt", "max_depth=2", "chains=32", "bootstrap=4000", NULL},
    {"integrator=pssmlt", "chains=5", "builder=pt", "bootstrap=4000", NULL},
    {"integrator=mmlt", "direct=joint", "chains=4", "bootstrap=4000", NULL},
    {"integrator=mmlt", "direct=separate", "chains=16", "bootstrap=4000", NULL},
};

#define RUNS ((int)(sizeof runs / sizeof runs[0]))

static struct scene *furnace(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 20.0, SIDE);
    struct shape_desc disk = {
        .kind = SHAPE_DISK,
        .radius = 3.0,
        .to_world = xform_rotate(50.0, 1.0, 0.0, 0.0),
        .material = test_diffuse(desc, ALBEDO, ALBEDO, ALBEDO),
    };
    scene_desc_add_shape(desc, &disk);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    test_sphere(desc, vec3(0, 0, 0), 10.0, black, rgb_grey(1.0), true);
    return test_build(desc, false);
}

/* Mean of squared error less squared bar, relative to the bar; the share covered. */
static double one_run(const struct scene *scene, const struct settings *s,
                      double *covered)
{
    struct run_result r = test_run(scene, s);
    double excess = 0.0, bars = 0.0;
    assert_non_null(r.verdict.se);
    *covered = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double error = (double)r.image->pixels[3 * i] - ALBEDO;
        double se = (double)r.verdict.se[i];
        excess += error * error - se * se;
        bars += se * se;
        *covered += (fabs(error) <= r.verdict.bar_95 * se) / (double)(SIDE * SIDE);
    }
    run_result_deinit(&r);
    return excess / bars;
}

static void check(const struct scene *scene, int index)
{
    const char *words[8] = {"mutations_per_pixel=100", "max_depth=2"};
    double excess[MOST], covered[MOST], coverage = 0.0, mean = 0.0;
    int n = getenv("ETALON_LONG") ? MOST : 24;
    for (int i = 0; runs[index][i]; i++)
        words[2 + i] = runs[index][i];
    struct settings s = test_settings(words);
    for (int i = 0; i < n; i++) {
        s.seed = 100 + i;
        excess[i] = one_run(scene, &s, &covered[i]);
        coverage += covered[i] / n;
        mean += excess[i] / n;
    }
    printf("%s %s: squared errors are %.3f of squared bars; 95 %% bars cover %.3f\n",
           words[2], words[3], 1.0 + mean, coverage);
    double level = stat_sidak(FALSE_ALARM, 2 * RUNS);
    assert_true(stat_ok(words[2], stat_mean_p(excess, n, 0.0), level));
    if (coverage < COVERS_LEAST)
        assert_true(stat_ok("too few", stat_mean_p(covered, n, COVERS_LEAST), level));
    if (coverage > COVERS_MOST)
        assert_true(stat_ok("too many", stat_mean_p(covered, n, COVERS_MOST), level));
}

static void test_coverage(void **state)
{
    (void)state;
    struct scene *scene = furnace();
    for (int i = 0; i < RUNS; i++)
        check(scene, i);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_coverage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
