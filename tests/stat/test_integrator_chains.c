/* Chains against bdpt, block by block, by z-tests over replicate runs: pssmlt over both
 * builders, mmlt; both estimators, both kernels, automatic and manual p_l; on a diffuse
 * scene and on one with glass, a lens and a point light. */

#include "math/accum.h"

#include <string.h>

#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define REPLICATES  12
#define BLOCKS      16 /* 4 x 4 pixels each, of a 16 x 16 film */

struct blocks {
    struct welford cell[3 * BLOCKS + 1]; /* over replicates; last: luminance b */
};

static void add_run(struct blocks *blocks, const struct run_result *r)
{
    double sum[3 * BLOCKS] = {0};
    for (int pixel = 0; pixel < 256; pixel++)
        for (int c = 0; c < 3; c++)
            sum[3 * (pixel / 64 * 4 + pixel % 16 / 4) + c] +=
                (double)r->image->pixels[3 * pixel + c] / 16.0;
    for (int i = 0; i < 3 * BLOCKS; i++)
        welford_add(&blocks->cell[i], sum[i]);
    welford_add(&blocks->cell[3 * BLOCKS], r->statistics.b);
}

static struct blocks replicate(const struct scene *scene, const char *const *words)
{
    struct blocks blocks = {0};
    struct settings s = test_settings(words);
    for (int i = 0; i < REPLICATES; i++) {
        s.seed = 100 + i;
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.nonfinite == 0.0 && r.statistics.saturated == 0.0);
        add_run(&blocks, &r);
        run_result_deinit(&r);
    }
    return blocks;
}

static const char *const variants[][6] = {
    {"bootstrap=20000", NULL},
    {"bootstrap=20000", "estimator=plain", "large_step_probability=0.3", NULL},
    {"bootstrap=20000", "kernel=gaussian", "large_step_probability=0.05", NULL},
    {"bootstrap=20000", "builder=pt", NULL},
    {"bootstrap=20000", "builder=pt", "estimator=plain", "large_step_probability=1",
     NULL},
    {"bootstrap=20000", "integrator=mmlt", NULL},
    {"bootstrap=20000", "integrator=mmlt", "estimator=plain",
     "large_step_probability=0.3", NULL},
    {"bootstrap=20000", "integrator=mmlt", "kernel=gaussian", "per=length", NULL},
    {"bootstrap=20000", "integrator=mmlt", "direct=separate", NULL},
    {"bootstrap=20000", "integrator=mmlt", "allocation=brightness", NULL},
    {"bootstrap=20000", "integrator=pfmlt", NULL},
    {"bootstrap=20000", "integrator=pfmlt", "mode=counted", "per=length", NULL},
    {"bootstrap=20000", "integrator=pfmlt", "direct=separate", "estimator=plain", NULL},
};

static const enum test_contents contents[] = {TEST_DIFFUSE, TEST_POINT};

#define CONTENTS ((int)(sizeof contents / sizeof contents[0]))
#define VARIANTS ((int)(sizeof variants / sizeof variants[0]))

static void compare(const char *name, const struct blocks *a, const struct blocks *b)
{
    int cells = 3 * BLOCKS + 1;
    double level = stat_sidak(FALSE_ALARM, cells * VARIANTS * CONTENTS), worst = 0.0;
    for (int i = 0; i < cells; i++) {
        double se = hypot(welford_se(&a->cell[i]), welford_se(&b->cell[i]));
        double z = (a->cell[i].mean - b->cell[i].mean) / se;
        worst = fabs(z) > fabs(worst) ? z : worst;
        assert_true(stat_ok(name, stat_t_p(z, REPLICATES - 1), level));
    }
    printf("%s: b %.6f +- %.6f against %.6f; worst t of %d: %.2f\n", name,
           a->cell[cells - 1].mean, welford_se(&a->cell[cells - 1]),
           b->cell[cells - 1].mean, cells, worst);
}

static void check_scene(enum test_contents which)
{
    bool full = getenv("ETALON_LONG") != NULL;
    const char *mpp = full ? "mutations_per_pixel=20000" : "mutations_per_pixel=100";
    const char *const reference[] = {"integrator=bdpt", mpp, "max_depth=5", NULL};
    struct scene *scene = test_scene(which, false);
    struct blocks bdpt = replicate(scene, reference);
    for (int i = 0; i < VARIANTS; i++) {
        const char *words[8] = {mpp, "max_depth=5"};
        bool pt = false;
        for (int j = 0; variants[i][j]; j++) {
            words[2 + j] = variants[i][j];
            pt = pt || strcmp(variants[i][j], "builder=pt") == 0;
        }
        if (pt && which == TEST_POINT)
            continue; /* pt does not find the caustic of a point light */
        struct blocks chains = replicate(scene, words);
        compare(variants[i][1] ? variants[i][1] : "default", &chains, &bdpt);
    }
    scene_destroy(scene);
}

static void test_against_bdpt(void **state)
{
    (void)state;
    for (int i = 0; i < CONTENTS; i++)
        check_scene(contents[i]);
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
        cmocka_unit_test(test_against_bdpt),
        cmocka_unit_test(test_brightness_coverage),
        cmocka_unit_test(test_brightness_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
