/* With a mutation budget a run gives the same bits for 1, 2 and 3 threads. */

#include <string.h>

#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void same_bits(const char *const *words)
{
    struct scene *scene = test_scene(TEST_POINT, false);
    struct run_result first = {0};
    for (int threads = 1; threads <= 3; threads++) {
        struct settings s = test_settings(words);
        s.threads = threads;
        struct run_result r = test_run(scene, &s);
        if (threads == 1) {
            first = r;
            assert_true(rgb_luminance(test_image_mean(r.image)) > 0.0);
            continue;
        }
        size_t bytes = sizeof(float) * 3 * (size_t)(r.image->width * r.image->height);
        assert_memory_equal(first.image->pixels, r.image->pixels, bytes);
        assert_true(first.statistics.b == r.statistics.b);
        assert_true(first.statistics.b_se == r.statistics.b_se);
        assert_int_equal(first.layers.count, r.layers.count);
        for (int i = 0; i < r.layers.count; i++)
            assert_memory_equal(first.layers.list[i].values, r.layers.list[i].values,
                                bytes / 3);
        if (r.verdict.se) {
            assert_memory_equal(first.verdict.se, r.verdict.se, bytes / 3);
            assert_memory_equal(first.verdict.rhat, r.verdict.rhat, bytes / 3);
            assert_memory_equal(first.verdict.ess, r.verdict.ess, bytes / 3);
            assert_true(first.verdict.relmse == r.verdict.relmse);
            assert_true(first.verdict.energy_top == r.verdict.energy_top);
        }
        run_result_deinit(&r);
    }
    run_result_deinit(&first);
    scene_destroy(scene);
}

static void test_pssmlt(void **state)
{
    (void)state;
    const char *const kelemen[] = {"mutations_per_pixel=200", "bootstrap=3000", NULL};
    const char *const plain[] = {"mutations_per_pixel=200", "bootstrap=3000",
                                 "estimator=plain",         "builder=pt",
                                 "kernel=gaussian",         NULL};
    same_bits(kelemen);
    same_bits(plain);
}

static void test_mmlt(void **state)
{
    (void)state;
    const char *const kelemen[] = {"integrator=mmlt", "mutations_per_pixel=200",
                                   "bootstrap=3000", NULL};
    const char *const plain[] = {"integrator=mmlt", "mutations_per_pixel=200",
                                 "bootstrap=3000",  "estimator=plain",
                                 "per=length",      NULL};
    const char *const separate[] = {"integrator=pfmlt", "mutations_per_pixel=200",
                                    "bootstrap=3000", "direct=separate", NULL};
    const char *const paper[] = {"integrator=pfmlt", "mutations_per_pixel=200",
                                 "bootstrap=3000", "mode=paper", NULL};
    same_bits(kelemen);
    same_bits(plain);
    same_bits(separate);
    same_bits(paper);
    const char *const jumps[] = {"integrator=rjmlt", "mutations_per_pixel=200",
                                 "bootstrap=3000", "jump_probability=0.5", NULL};
    same_bits(jumps);
}

static void test_smlt(void **state)
{
    (void)state;
    const char *const whole[] = {"integrator=smlt", "mutations_per_pixel=200",
                                 "bootstrap=3000",  "share_floor=1",
                                 "ceiling=5",       NULL};
    const char *const techniques[] = {"integrator=smlt", "mutations_per_pixel=200",
                                      "metropolis=mmlt", "share_floor=0.3",
                                      "passes_share=.4", NULL};
    const char *const automatic[] = {"integrator=smlt", "mutations_per_pixel=200",
                                     "builder=pt", NULL};
    same_bits(whole);
    same_bits(techniques);
    same_bits(automatic);
}

static void test_mlt(void **state)
{
    (void)state;
    const char *const joint[] = {"integrator=mlt",   "mutations_per_pixel=200",
                                 "bootstrap=3000",   "direct=joint",
                                 "weight_numbers=1", NULL};
    const char *const separate[] = {"integrator=mlt",  "mutations_per_pixel=200",
                                    "bootstrap=3000",  "direct=separate",
                                    "estimator=plain", NULL};
    same_bits(joint);
    same_bits(separate);
}

static void test_passes(void **state)
{
    (void)state;
    const char *const bdpt[] = {"integrator=bdpt", "mutations_per_pixel=40", NULL};
    const char *const pt[] = {"integrator=pt", "mutations_per_pixel=40", NULL};
    const char *const race[] = {"integrator=auto", "mutations_per_pixel=1000",
                                "max_depth=3", NULL};
    same_bits(bdpt);
    same_bits(pt);
    same_bits(race);
}

static const char *const scaled_variants[][2] = {
    {"integrator=pssmlt", "seed=1"},        {"integrator=mmlt", "seed=1"},
    {"integrator=mmlt", "direct=separate"}, {"integrator=pfmlt", "per=length"},
    {"integrator=rjmlt", "seed=1"},         {"integrator=mlt", "direct=joint"},
};

/* Emission times a power of two: the same decisions, so the same picture, scaled. */
static void check_emission_scale(const char *const variant[2], double scale)
{
    const char *const words[] = {"mutations_per_pixel=100", "bootstrap=3000", variant[0],
                                 variant[1], NULL};
    struct settings s = test_settings(words);
    struct run_result results[2];
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
        test_room(desc);
        test_lamp(desc, 0.3, rgb_scale(rgb(3, 2, 1), i ? scale : 1.0));
        struct scene *scene = test_build(desc, false);
        results[i] = test_run(scene, &s);
        scene_destroy(scene);
    }
    const struct run_statistics *a = &results[0].statistics, *b = &results[1].statistics;
    assert_true(a->acceptance == b->acceptance && a->acceptance > 0.0);
    assert_true(a->counters.total == b->counters.total);
    assert_true(a->b * scale == b->b && a->b_se * scale == b->b_se);
    assert_int_equal(a->length_count, b->length_count);
    for (int i = 0; i < a->length_count; i++) {
        assert_int_equal(a->lengths[i].chains, b->lengths[i].chains);
        assert_true(a->lengths[i].p_l == b->lengths[i].p_l);
    }
    for (int i = 0; i < 3 * 16 * 16; i++)
        assert_true(results[0].image->pixels[i] * (float)scale ==
                    results[1].image->pixels[i]);
    run_result_deinit(&results[0]);
    run_result_deinit(&results[1]);
}

static void test_emission_scale(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scaled_variants / sizeof *scaled_variants; i++) {
        check_emission_scale(scaled_variants[i], 0x1p100);
        check_emission_scale(scaled_variants[i], 0x1p-90);
    }
}

/* A lamp that no path reaches: a black picture, zero b, and the rule says so. */
static void test_dark(void **state)
{
    (void)state;
    const char *const words[] = {"mutations_per_pixel=10", "bootstrap=500", NULL};
    struct settings s = test_settings(words);
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 9), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    struct run_result r = test_run(scene, &s);
    assert_true(r.statistics.b == 0.0);
    assert_int_equal(r.statistics.plarge.branch, PLARGE_DARK);
    assert_true(rgb_is_black(test_image_mean(r.image)));
    run_result_deinit(&r);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pssmlt),
        cmocka_unit_test(test_mmlt),
        cmocka_unit_test(test_smlt),
        cmocka_unit_test(test_passes),
        cmocka_unit_test(test_emission_scale),
        cmocka_unit_test(test_dark),
        cmocka_unit_test(test_mlt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
