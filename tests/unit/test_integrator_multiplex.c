/* The books of mmlt and pfmlt: how chains are shared out among the path lengths, lengths
 * that the bootstrap did not meet, plain samples for short paths, budgets where a
 * mutation traces two paths, the map of failures, films that lengths share. */

#include <string.h>

#include "image/film.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "support/near.h"

/* --- chains by length ------------------------------------------------------------- */

static int sum_chains(const struct run_statistics *s)
{
    int sum = 0;
    for (int i = 0; i < s->length_count; i++)
        sum += s->lengths[i].chains;
    return sum;
}

static void test_chains_of_all_lengths(void **state)
{
    (void)state;
    static const char *const allocation[] = {"allocation=error", "allocation=brightness"};
    static const int chains[] = {1, 11, 12, 13, 64, 301};
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    for (int i = 0; i < 12; i++) {
        const char *const words[] = {"integrator=mmlt", "max_depth=6", "bootstrap=3000",
                                     allocation[i / 6], NULL};
        struct settings s = test_settings(words);
        s.chains = chains[i % 6];
        s.mutations_per_pixel = 4.0;
        struct run_result r = test_run(scene, &s);
        const struct run_statistics *all = &r.statistics;
        assert_int_equal(all->length_count, 6);
        assert_int_equal(sum_chains(all), s.chains > 12 ? s.chains : 12);
        for (int j = 0; j < 6; j++) {
            assert_int_equal(all->lengths[j].length, j + 1);
            assert_true(all->lengths[j].chains >= 2);
        }
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* Without large steps b of a length is that of its bootstrap, which shares out. */
static void test_chains_by_brightness(void **state)
{
    (void)state;
    static const char *const allocation[] = {"allocation=brightness", "allocation=error"};
    double lamp_share[2];
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 128);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(12, 10, 8));
    struct scene *scene = test_build(desc, false);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {
            "integrator=mmlt",       "max_depth=5",
            "bootstrap=20000",       "large_step_probability=1e-9",
            "mutations_per_pixel=4", "chains=500",
            allocation[i],           NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        const struct run_statistics *all = &r.statistics;
        assert_true(all->whole.large == 0);
        for (int j = 0; i == 0 && j < all->length_count; j++) {
            double due = 500.0 * all->lengths[j].b / all->b;
            assert_true(due > 3.0 && fabs(all->lengths[j].chains - due) < 1.0);
        }
        lamp_share[i] = all->lengths[0].chains / 500.0;
        run_result_deinit(&r);
    }
    /* A lamp that is seen directly is bright and has little error. */
    assert_true(lamp_share[1] < 0.5 * lamp_share[0]);
    scene_destroy(scene);
}

static void test_lengths_not_met(void **state)
{
    (void)state;
    int found = 0, met_later = 0;
    struct scene *scene = test_scene(TEST_GLASS, false);
    for (int seed = 1; seed <= 6; seed++) {
        const char *const words[] = {"integrator=mmlt", "max_depth=12",
                                     "bootstrap=60",    "mutations_per_pixel=50",
                                     "direct=joint",    NULL};
        struct settings s = test_settings(words);
        s.seed = seed;
        struct run_result r = test_run(scene, &s);
        const struct run_statistics *all = &r.statistics;
        assert_int_equal(all->length_count, 12);
        /* Few seeds: up to four doublings, the budget allowing. */
        assert_true(all->bootstrap_paths >= 60.0 && all->bootstrap_paths <= 960.0);
        assert_true(all->nonfinite == 0.0);
        for (int i = 0; i < 12; i++) {
            const struct length_statistics *length = &all->lengths[i];
            assert_true(isfinite(length->b) && length->b >= 0.0 && length->chains >= 2);
            found += length->found;
            met_later += !length->found && length->b > 0.0;
        }
        run_result_deinit(&r);
    }
    /* Five paths of each length: of the long ones most carry nothing. */
    assert_true(found >= 6 && found <= 60);
    assert_true(met_later >= 6);
    scene_destroy(scene);
}

/* The published rule's answer to the statistics of the measured start, length by length.
 */
static void test_per_length(void **state)
{
    (void)state;
    static const char *const per[] = {"per=all", "per=length"};
    struct scene *scene = test_scene(TEST_GLASS, false);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {"integrator=mmlt",
                                     "max_depth=5",
                                     "bootstrap=5000",
                                     "mutations_per_pixel=2000",
                                     per[i],
                                     "rule=zsolnai2013",
                                     NULL};
        struct settings s = test_settings(words);
        struct run_options options = {
            .scene = scene, .settings = &s, .startup_only = true};
        struct run_result r = {0};
        struct err err = {0};
        assert_true(run_render(&options, &r, &err));
        const struct run_statistics *all = &r.statistics;
        double sum = 0.0, lowest = 1.0, highest = 0.0;
        for (int j = 0; j < all->length_count; j++) {
            const struct length_statistics *length = &all->lengths[j];
            const struct statistics *own = i ? &length->whole : &all->start;
            assert_true(length->p_l == plarge_zsolnai2013(own).p_l);
            sum += length->p_l * length->chains;
            lowest = fmin(lowest, length->p_l);
            highest = fmax(highest, length->p_l);
        }
        assert_relative(all->plarge.p_l, sum / sum_chains(all), 1e-12);
        assert_true(i ? highest > lowest : highest == lowest);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* --- plain samples for short paths ------------------------------------------------ */

static struct run_result run_pt(const struct scene *scene, int depth, double samples)
{
    const char *const words[] = {"integrator=pt", NULL};
    struct settings s = test_settings(words);
    s.max_depth = depth;
    s.mutations_per_pixel = samples;
    return test_run(scene, &s);
}

static void test_separate(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    for (int depth = 1; depth <= 4; depth++) {
        const char *const words[] = {"integrator=mmlt",
                                     "direct=separate",
                                     "estimator=plain",
                                     "large_step_probability=0.3",
                                     "mutations_per_pixel=60",
                                     "bootstrap=8000",
                                     NULL};
        struct settings s = test_settings(words);
        s.max_depth = depth;
        struct run_result r = test_run(scene, &s);
        const struct run_statistics *all = &r.statistics;
        int plain = depth > 2 ? 2 : depth - 1; /* the longest always has chains */
        assert_int_equal(all->plain_lengths, plain);
        assert_int_equal(all->length_count, depth - plain);
        assert_int_equal(all->lengths[0].length, plain + 1);
        assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
        double b = all->plain_b;
        for (int i = 0; i < all->length_count; i++)
            b += all->lengths[i].b;
        assert_relative(all->b, b, 1e-12);
        if (plain > 0) {
            /* A quarter of all paths, in whole passes; the very samples of pt. */
            assert_true(all->plain_samples > 13.0 * 256.0 &&
                        all->plain_samples < 16.0 * 256.0);
            assert_true(all->paths == 60.0 * 256.0);
            struct run_result pt = run_pt(scene, plain, all->plain_samples / 256.0);
            assert_true(pt.statistics.b == all->plain_b);
            assert_true(pt.statistics.b_se == all->plain_b_se);
            run_result_deinit(&pt);
        }
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* A floor and a lamp above it: no path has more than two edges, and the chains of the
 * others have nothing to do. */
static void test_separate_alone(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=mmlt", "integrator=pfmlt"};
    struct scene_desc *desc = test_desc(vec3(0, 1, 4), vec3(0, 0.5f, 0), 60.0, 8);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 4), vec3(4, 0, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    test_lamp(desc, 0.5, rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    struct run_result pt = run_pt(scene, 5, 40.0);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {integrators[i],  "direct=separate",
                                     "max_depth=5",   "mutations_per_pixel=40",
                                     "bootstrap=600", NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.paths == 40.0 * 64.0);
        assert_true(r.statistics.plain_samples == 40.0 * 64.0);
        assert_int_equal(r.statistics.plarge.branch, PLARGE_DARK);
        assert_true(r.statistics.b == pt.statistics.b && r.statistics.b > 0.0);
        assert_memory_equal(r.image->pixels, pt.image->pixels, 3 * 64 * sizeof(float));
        run_result_deinit(&r);
    }
    run_result_deinit(&pt);
    scene_destroy(scene);
}

/* --- pfmlt ------------------------------------------------------------------------ */

/* How many paths a mutation of mode exact traces is known only afterwards. The run ends
 * by what its start predicts, so that parts of a run, which do not know of each other,
 * end alike: the paths made differ from the budget by the error of the prediction, which
 * these short starts of 14 chains keep below 3 %. That is no random event: the seed is
 * fixed. The numbers are counted, not predicted. All others meet their budgets:
 * tests/unit/test_run_render.c. */
static void test_exact_budget(void **state)
{
    (void)state;
    const double mpp[] = {0.01, 0.5, 3.0, 7.3, 15.5, 60.0};
    const int chains = 14;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    for (int i = 0; i < 12; i++) {
        const char *const words[] = {"integrator=pfmlt",
                                     "max_depth=4",
                                     "bootstrap=2000",
                                     "chains=14",
                                     "seed=3",
                                     "large_step_probability=0.3",
                                     i % 2 ? "direct=separate" : "direct=joint",
                                     NULL};
        struct settings s = test_settings(words);
        s.mutations_per_pixel = mpp[i / 2];
        struct run_result first = test_run(scene, &s);
        double budget = mpp[i / 2] * 256.0, paths = first.statistics.paths;
        double least = i % 2 ? 2.0 * 256.0 : 0.0; /* two passes come first */
        assert_true(paths >= 0.97 * budget - 2.0 * chains);
        assert_true(paths < 1.03 * fmax(budget, least) + 2.0 * chains);
        const struct path_counters *counters = &first.statistics.counters;
        assert_true(counters->total + first.statistics.plain_samples == paths);
        assert_true(counters->second_stage > 0.0 || budget < 600.0);
        assert_relative(first.mutations_per_pixel, paths / 256.0, 1e-15);
        run_result_deinit(&first);
    }
    scene_destroy(scene);
}

static const char *const modes[] = {"mode=exact", "mode=counted", "mode=paper"};

/* On a film of one pixel the map is the failure rate. */
static void test_failure_map_is_the_rate(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 1);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    for (int i = 0; i < 3; i++) {
        const char *const words[] = {"integrator=pfmlt", "max_depth=4",
                                     "bootstrap=4000",   "mutations_per_pixel=20000",
                                     modes[i],           NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.failure_rate > 0.1 && r.statistics.failure_rate < 0.9);
        assert_relative((double)layers_find(&r.layers, "failures.Y")[0],
                        r.statistics.failure_rate, 1e-7);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* A share where a state was, -1 elsewhere; only pfmlt has one. */
static void test_failure_map_values(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 90.0, 8);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    /* The left half of the film, but for its outermost pixels. */
    test_quad(desc, vec3(-1.5f, 0, 0), vec3(1.4f, 0, 0), vec3(0, 3.5f, 0), black,
              rgb_grey(2.0));
    struct scene *scene = test_build(desc, false);
    for (int i = 0; i < 3; i++) {
        const char *const words[] = {"integrator=pfmlt", "max_depth=1",
                                     "bootstrap=1000",   "mutations_per_pixel=200",
                                     modes[i],           NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        int inside = 0;
        for (int j = 0; j < 64; j++) {
            double value = (double)layers_find(&r.layers, "failures.Y")[j];
            bool lit = r.image->pixels[3 * j] > 0.0f;
            assert_true(lit ? value >= 0.0 && value <= 1.0 : value == -1.0);
            inside += lit;
        }
        assert_in_range(inside, 20, 36);
        run_result_deinit(&r);
    }
    const char *const mmlt[] = {"integrator=mmlt", "max_depth=1", "bootstrap=100",
                                "mutations_per_pixel=4", NULL};
    struct settings s = test_settings(mmlt);
    struct run_result r = test_run(scene, &s);
    assert_null(layers_find(&r.layers, "failures.Y"));
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* --- films that lengths share ----------------------------------------------------- */

/* Three lamps side by side: one seen directly, a faint one behind a pane that neither
 * bends nor mirrors, and one behind two. So each third of the film has paths of one
 * length, 1, 2 and 3, which all carry the lamp's radiance. */
static const double radiance[] = {1.0, 0.006, 0.003};

static struct scene *panes(int size)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 90.0, size);
    struct rgb dark = rgb_grey(0.0);
    int black = test_material(desc, "black", NULL, dark, NULL, 0.0);
    int pane = test_material(desc, "dielectric", NULL, dark, "eta", 1.0);
    struct vec3 half = {0.9f, 0, 0}, wide = {1.1f, 0, 0}, up = {0, 2, 0};
    for (int i = 0; i < 3; i++) {
        float x = 2.5f * (1.0f - (float)i); /* +x is on the left */
        test_quad(desc, vec3(x, 0, 0), half, up, black, rgb_grey(radiance[i]));
        for (int j = 0; j < i; j++)
            test_quad(desc, vec3(x, 0, 0.02f * (float)(j + 1)), wide,
                      vec3_scale(up, 1.1f), pane, dark);
    }
    return test_build(desc, false);
}

/* Mean over the whole film of what is in one third of it. */
static void third_means(const struct image *image, double means[3])
{
    means[0] = means[1] = means[2] = 0.0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            means[3 * x / image->width] += (double)image_at(image, x, y)[1];
    for (int i = 0; i < 3; i++)
        means[i] /= (double)image->width * image->height;
}

static struct run_result run_panes(const struct scene *scene, const char *p_large,
                                   const char *estimator)
{
    const char *const words[] = {"integrator=mmlt", "bootstrap=6000",
                                 "max_depth=12",    "mutations_per_pixel=8",
                                 "direct=joint",    "start_mutations=128",
                                 "start_cap=1",     p_large,
                                 estimator,         NULL};
    struct settings s = test_settings(words);
    s.memory_limit = 1.0;
    struct run_result r = test_run(scene, &s);
    assert_int_equal(r.statistics.length_count, 12);
    for (int i = 0; i < 12; i++)
        assert_true(r.statistics.lengths[i].found == (i < 3));
    return r;
}

/* Films that would take too much, so that faint lengths share one: their splats are terms
 * of one sum in which every length has its part by the b of when the round began, here
 * the only one, so that it is the bootstrap's b0. All of it is known exactly, for each
 * length has one target I where it is not 0. Without large steps b is b0, and a third's
 * mean is its b. With nothing but large steps, H of M of which hit,
 *     third = (b + b0 H/M) I/(I + b0),
 * where for those that share b is the part b0/sum b0 of the sum of their b. */
static void test_shared_film(void **state)
{
    (void)state;
    struct scene *scene = panes(64);
    struct run_result small = run_panes(scene, "large_step_probability=1e-9",
                                        "estimator=plain");
    struct run_result large = run_panes(scene, "large_step_probability=1",
                                        "estimator=kelemen");
    const struct length_statistics *before = small.statistics.lengths,
                                   *after = large.statistics.lengths;
    double means[3], shared_b0 = before[1].b + before[2].b;
    double shared_b = after[1].b + after[2].b;
    assert_true(shared_b0 < 0.01 * before[0].b && shared_b != shared_b0);
    assert_true(before[1].b > 1.5 * before[2].b); /* parts that differ */
    third_means(small.image, means);
    for (int i = 0; i < 3; i++)
        assert_relative(means[i], before[i].b, 1e-6);
    third_means(large.image, means);
    for (int i = 0; i < 3; i++) {
        double b0 = before[i].b, b = i == 0 ? after[i].b : shared_b * b0 / shared_b0;
        double target = radiance[i], hits = after[i].whole.eta_0;
        assert_relative(means[i], (b + b0 * hits) * target / (target + b0), 1e-6);
    }
    run_result_deinit(&small);
    run_result_deinit(&large);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chains_of_all_lengths),
        cmocka_unit_test(test_chains_by_brightness),
        cmocka_unit_test(test_lengths_not_met),
        cmocka_unit_test(test_per_length),
        cmocka_unit_test(test_separate),
        cmocka_unit_test(test_separate_alone),
        cmocka_unit_test(test_exact_budget),
        cmocka_unit_test(test_failure_map_is_the_rate),
        cmocka_unit_test(test_failure_map_values),
        cmocka_unit_test(test_shared_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
