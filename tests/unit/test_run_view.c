/* Looks at a run while it goes: they change no bit of it, show what it then is, and keep
 * to their share of its time however dear they are. */

#include "run/run_view.h"

#include "base/clock.h"
#include "base/mem.h"

#include <string.h>

#include "support/test_run.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

struct watcher {
    struct run_viewer viewer;
    double share;
    double cost; /* s, that it claims a look took */
    bool absent;
    bool pictures; /* alone, no verdict */
    long looks, verdicts;
    double paths; /* at the last look */
};

static bool wanted(void *ctx)
{
    struct watcher *w = ctx;
    return !w->absent;
}

static void show(void *ctx, const struct run_result *now)
{
    struct watcher *w = ctx;
    w->looks++;
    w->verdicts += now->verdict.words[0] || now->verdict.call != VERDICT_NONE;
    assert_true(now->statistics.paths >= w->paths);
    assert_int_equal(now->end, RUN_GOING);
    assert_int_equal(now->image->width, 16);
    if (now->statistics.paths > 0.0 && now->statistics.b > 0.0)
        assert_true(rgb_luminance(test_image_mean(now->image)) > 0.0);
    w->paths = now->statistics.paths;
}

static double cpu(void *ctx)
{
    struct watcher *w = ctx;
    return w->cost * (double)w->looks;
}

static struct run_result run(const struct scene *scene, struct watcher *w,
                             const char *integrator)
{
    const char *const words[] = {"bootstrap=1000", "max_depth=4",
                                 "mutations_per_pixel=600", integrator, NULL};
    struct settings s = test_settings(words);
    struct run_options options = {.scene = scene, .settings = &s};
    struct run_result result = {0};
    struct err err = {0};
    if (w) {
        w->viewer = (struct run_viewer){1e-9, w->share, !w->pictures, wanted, show,
                                        cpu,  w};
        options.viewer = &w->viewer;
    }
    assert_true(run_render(&options, &result, &err));
    return result;
}

static void test_changes_nothing(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=pssmlt", "integrator=mmlt",
                                              "integrator=bdpt"};
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    for (size_t i = 0; i < sizeof integrators / sizeof *integrators; i++) {
        struct watcher w = {.share = 1e9}; /* a look after each round */
        struct run_result alone = run(scene, NULL, integrators[i]);
        struct run_result seen = run(scene, &w, integrators[i]);
        assert_true(w.looks > 3 && w.verdicts >= 2);
        assert_memory_equal(alone.image->pixels, seen.image->pixels,
                            3 * 256 * sizeof(float));
        assert_memory_equal(alone.verdict.se, seen.verdict.se, 256 * sizeof(float));
        assert_string_equal(alone.verdict.words, seen.verdict.words);
        run_result_deinit(&alone);
        run_result_deinit(&seen);
    }
    scene_destroy(scene);
}

/* A look that takes more than one kind of looks may take of the whole run is the only one
 * of its kind; nobody who is absent is shown anything. */
static void test_share(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct watcher w = {.cost = 1e6, .share = 1e3},
                   nobody = {.absent = true, .share = 1e9};
    struct run_result dear = run(scene, &w, "integrator=pssmlt");
    struct run_result unseen = run(scene, &nobody, "integrator=pssmlt");
    assert_true(dear.seconds_cpu < 100.0);
    assert_true(w.looks >= 1 && w.looks <= 2);
    assert_int_equal(nobody.looks, 0);
    run_result_deinit(&dear);
    run_result_deinit(&unseen);
    scene_destroy(scene);
}

/* Looks at the picture leave enough of their share for two more: the look at the end. */
static void test_last_look(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct watcher w = {.cost = 0.001, .share = 0.1, .pictures = true};
    struct run_result result = run(scene, &w, "integrator=pssmlt");
    assert_true(w.looks >= 1 && w.verdicts == 0);
    assert_true(w.cost * (double)(w.looks + 2) <= w.share * result.seconds_cpu);
    run_result_deinit(&result);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_changes_nothing),
        cmocka_unit_test(test_share),
        cmocka_unit_test(test_last_look),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
