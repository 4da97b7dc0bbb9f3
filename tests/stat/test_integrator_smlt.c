/* smlt against bdpt on a scene with glass, a point light and a lens, pixel by pixel, for
 * shares from next to nothing to all, for a guess of the picture that is good and for one
 * that is wrong (made from a single sample), with automatic parameters; and the error
 * bars of its two parts together.
 *
 * False alarms: FALSE_ALARM for all pictures together, and again for all error bars.
 * Power: each fault of bench/mutants/122 to 127 is seen by the pictures, by
 * tests/stat/test_integrator_grey.c or by tests/unit/test_integrator_split.c. The mean
 * squared error that the error bars claim has a standard error of 12 % at most (SEES,
 * asserted): the test sees, nine times in ten, that they claim a third of it. */

#include "support/picture_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define COMMON      "integrator=smlt", "max_depth=5"

static const char *const variants[][8] = {
    {COMMON, "mutations_per_pixel=48", "share_floor=1", "ceiling=3", "passes_share=0.3"},
    {COMMON, "mutations_per_pixel=48", "share_floor=0.01", "ceiling=0.5",
     "passes_share=0.6", "estimator=plain"},
    {COMMON, "mutations_per_pixel=48", "share_floor=30", "ceiling=none",
     "passes_share=0.5"},
    /* The guess comes from one sample. */
    {COMMON, "mutations_per_pixel=48", "share_floor=1", "ceiling=10", "passes_share=0.4",
     "bootstrap=2"},
    {COMMON, "mutations_per_pixel=96", "share_floor=1", "ceiling=3", "passes_share=0.3",
     "metropolis=mmlt"},
    {COMMON, "mutations_per_pixel=96", "share_floor=0.3", "ceiling=10",
     "passes_share=0.4", "metropolis=mmlt", "bootstrap=24"},
    {COMMON, "mutations_per_pixel=96", "metropolis=mmlt"},
};

#define VARIANTS ((int)(sizeof variants / sizeof *variants))

static void test_pictures(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    const char *const reference[] = {"integrator=bdpt", "max_depth=5",
                                     "mutations_per_pixel=200", NULL};
    struct pictures bdpt = pictures_render(scene, reference, 1, false);
    double level = stat_sidak(FALSE_ALARM, VARIANTS);
    for (int i = 0; i < VARIANTS; i++) {
        printf("%s %s %s\n", variants[i][3], variants[i][4] ? variants[i][4] : "",
               variants[i][7] ? variants[i][7] : "");
        struct pictures smlt = pictures_render(scene, variants[i], 1001 + 100 * i, false);
        assert_true(picture_same(&smlt, &bdpt, 4, 4, level));
        pictures_deinit(&smlt);
    }
    pictures_deinit(&bdpt);
    scene_destroy(scene);
}

/* --- error bars -------------------------------------------------------------------- */

#define SEEDS 60
#define SEES  0.12

/* Mean squared error of luminance against the mean of the bdpt pictures, whose own share
 * of it is small; and what the error bars claim of it. */
static void add_errors(const struct run_result *r, const struct pictures *bdpt,
                       struct welford *real, struct welford *difference)
{
    double squares = 0.0, claimed = 0.0;
    long count = (long)r->image->width * r->image->height;
    for (long j = 0; j < count; j++) {
        double d = rgb_luminance(image_pixel(r->image, j)), se = (double)r->verdict.se[j];
        for (int i = 0; i < PICTURE_REPLICATES; i++)
            d -= rgb_luminance(image_pixel(bdpt->run[i], j)) / PICTURE_REPLICATES;
        squares += d * d / (double)count;
        claimed += se * se / (double)count;
    }
    welford_add(real, squares);
    welford_add(difference, claimed - squares);
}

static void check_error_bars(const struct scene *scene, const char *const *words,
                             const struct pictures *bdpt)
{
    struct settings s = test_settings(words);
    struct welford difference = {0}, real = {0};
    for (s.seed = 5001; s.seed <= 5000 + SEEDS; s.seed++) {
        struct run_result r = test_run(scene, &s);
        assert_non_null(r.verdict.se);
        add_errors(&r, bdpt, &real, &difference);
        run_result_deinit(&r);
    }
    double se = welford_se(&difference), t = difference.mean / se;
    printf("squared error %.4g, that of the error bars more by %.2g +- %.2g\n", real.mean,
           difference.mean, se);
    assert_true(
        stat_ok("error bars", stat_t_p(t, SEEDS - 1.0), stat_sidak(FALSE_ALARM, 2)));
    assert_true(se < SEES * real.mean);
}

static void test_error_bars(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const reference[] = {"integrator=bdpt", "max_depth=5",
                                     "mutations_per_pixel=400", NULL};
    struct pictures bdpt = pictures_render(scene, reference, 1, false);
    check_error_bars(scene, variants[0], &bdpt);
    check_error_bars(scene, variants[4], &bdpt);
    pictures_deinit(&bdpt);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_error_bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
