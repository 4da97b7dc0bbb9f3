/* The books of a run, exactly: budgets, the start within the whole, what a picture's mean
 * must be, small films, clocks, hooks and stops. */

#include <string.h>

#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "support/near.h"

static struct run_result run_words(const struct scene *scene, const char *a,
                                   const char *b, const char *c, const char *d)
{
    const char *const words[] = {"bootstrap=1000", "max_depth=4", a, b, c, d, NULL};
    struct settings s = test_settings(words);
    return test_run(scene, &s);
}

static void test_mean(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    const char *const words[][3] = {
        {"integrator=pt", "seed=1", "seed=2"},
        {"integrator=bdpt", "seed=1", "seed=2"},
        {"estimator=plain", "seed=1", "large_step_probability=auto"},
        {"estimator=plain", "large_step_probability=0.2", "chains=3"},
        {"estimator=plain", "large_step_probability=1", "builder=pt"},
        {"estimator=plain", "large_step_probability=0.3", "integrator=mmlt"},
        {"estimator=plain", "per=length", "integrator=mmlt"},
        {"estimator=plain", "direct=separate", "integrator=mmlt"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct run_result r = run_words(scene, "mutations_per_pixel=37", words[i][0],
                                        words[i][1], words[i][2]);
        assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
        /* The budget exactly, but that chains end together: three make it 9474 of 9472.
         */
        double over = r.statistics.paths - 37.0 * 256.0;
        assert_true(over == 0.0 ||
                    (i >= 3 && over > 0.0 && over < (double)r.statistics.chains));
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

static struct scene *furnace(int size)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 0), vec3(0, 0, 1), 40.0, size);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    test_sphere(desc, vec3(0, 0, 0), 10.0, black, rgb_grey(1.0), true);
    return test_build(desc, false);
}

/* Kelemen's weights where the target is 1 everywhere: a mutation made at p puts 1/(1+p)
 * into the one film and, if it is a large step, as much into the other. The start runs at
 * .5, the rest at p_l: b cancels, only the books are left. */
static void test_kelemen_weights(void **state)
{
    (void)state;
    static const char *const p_words[] = {"auto", "1", "0.3", "1e-9"};
    static const double p_main[] = {1.0, 1.0, 0.3, 1e-9};
    struct scene *scene = furnace(8);
    for (int i = 0; i < 4; i++) {
        char word[64];
        snprintf(word, sizeof word, "large_step_probability=%s", p_words[i]);
        struct run_result r = run_words(scene, "mutations_per_pixel=100", word,
                                        "chains=10", "seed=5");
        const struct run_statistics *s = &r.statistics;
        assert_true(s->plarge.p_l == p_main[i] && s->plarge_auto == (i == 0));
        double p_start = i == 0 ? 0.5 : p_main[i];
        double large_start = (double)s->start.large, large = (double)s->whole.large;
        double sum = (s->start_mutations + large_start) / (1.0 + p_start) +
                     (s->paths - s->start_mutations + large - large_start) /
                         (1.0 + p_main[i]);
        assert_relative(rgb_luminance(test_image_mean(r.image)), sum / s->paths, 1e-6);
        assert_relative(s->b, 1.0, 1e-7);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* The whole holds the start; at p_l = 1 no small step follows it. */
static void test_start_and_whole(void **state)
{
    (void)state;
    struct scene *scene = furnace(8);
    struct run_result r = run_words(scene, "mutations_per_pixel=100", "chains=10",
                                    "seed=1", "seed=2");
    const struct run_statistics *s = &r.statistics;
    assert_true(s->paths == 6400.0 && s->bootstrap_paths == 1000.0);
    assert_true(r.mutations_per_pixel == 100.0);
    /* 64 of the 640 mutations a chain: more than 2 %, less than 20 % of them. */
    assert_true(s->start_mutations == 640.0 && s->start_looks == 1);
    assert_true((double)(s->start.small + s->start.large) == s->start_mutations);
    assert_true((double)(s->whole.small + s->whole.large) == s->paths);
    assert_true(s->whole.small == s->start.small && s->start.small > 200);
    assert_true(s->start.eta_s == 1.0 && s->start.eta_l == 1.0 && s->start.eta_0 == 1.0);
    assert_true(s->acceptance == 1.0 && s->failure_rate == 0.0);
    assert_true(s->most_rejections_in_row == 0.0 && s->chains_never_moved == 0.0);
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* mutations a chain asked for, chains -> start, whole. */
static void test_budgets(void **state)
{
    (void)state;
    static const struct {
        const char *mpp, *chains, *start, *cap;
        double start_mutations, paths;
    } rows[] = {
        {"1", "256", "start=0.02", "start_cap=0.2", 256, 256}, /* one each */
        {"1", "1000", "start=0.02", "start_cap=0.2", 1000, 1000},
        {"100", "1", "start=0.02", "start_cap=0.2", 128, 6400}, /* the share */
        {"10", "4", "start=0.02", "start_cap=0.2", 128, 640},   /* the cap, rounded up */
        {"10", "4", "start=0", "start_cap=0", 4, 640},
        {"10", "4", "start=1", "start_cap=1", 640, 640}, /* nothing but the start */
    };
    struct scene *scene = furnace(8);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char mpp[64], chains[64];
        snprintf(mpp, sizeof mpp, "mutations_per_pixel=%s", rows[i].mpp);
        snprintf(chains, sizeof chains, "chains=%s", rows[i].chains);
        const char *const words[] = {"bootstrap=100",
                                     mpp,
                                     chains,
                                     rows[i].start,
                                     rows[i].cap,
                                     "estimator=plain",
                                     "large_step_probability=0.4",
                                     NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.start_mutations == rows[i].start_mutations);
        assert_true(r.statistics.paths == rows[i].paths);
        assert_int_equal(r.statistics.start_looks, 1);
        assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* The mutations per pixel that a run reports give that run again, for any length: 11 of
 * 5 chains on 25 pixels are 2.2 a pixel, and 2.2 * 25 / 5 is a little more than 11. */
static void test_budget_again(void **state)
{
    (void)state;
    const char *const words[] = {"bootstrap=50", "chains=5", "estimator=plain",
                                 "large_step_probability=0.5", NULL};
    struct scene *scene = furnace(5);
    struct settings s = test_settings(words);
    for (int mutations = 1; mutations <= 60; mutations++) {
        s.mutations_per_pixel = mutations * 5.0 / 25.0;
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.paths == mutations * 5.0);
        assert_true(r.mutations_per_pixel == s.mutations_per_pixel);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* A single chain tells no standard error, so the branch stays unsure and the start
 * doubles up to its cap: 82, 164, 328, 656, 819 of 4096. */
static void test_single_chain(void **state)
{
    (void)state;
    struct scene *scene = furnace(8);
    struct run_result r = run_words(scene, "mutations_per_pixel=64", "chains=1", "seed=1",
                                    "seed=2");
    const struct run_statistics *s = &r.statistics;
    assert_true(s->start_mutations == 819.0 && s->paths == 4096.0);
    assert_int_equal(s->start_looks, 5);
    assert_true(s->plarge.unsure && isinf(s->start.eta_s_se));
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* --- films ------------------------------------------------------------------------ */

/* A lamp that fills the pixels x in [2,4), y = 1 of an 8 x 4 film, and nothing else. */
static struct scene *lit_pixels(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 90.0, 4);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    desc->width = 8;
    /* At distance 4 a pixel is 2 wide; rows go down, and x to the left of one who looks
     * along -z with y up. */
    test_quad(desc, vec3(2, 1, 0), vec3(2, 0, 0), vec3(0, 1, 0), black, rgb_grey(3.0));
    return test_build(desc, false);
}

/* Where b_0 is a poor guess of b: the target is 3 or 0, so that a chain from a lit seed
 * stays lit, and the picture's mean follows from the counts. b_0, which no run reports,
 * follows from b, as b is the mean of the bootstrap and all large steps. */
static void test_kelemen_units(void **state)
{
    (void)state;
    const double p = 0.5, target = 3.0, bootstrap = 50.0;
    const char *const words[] = {"bootstrap=50",
                                 "max_depth=1",
                                 "mutations_per_pixel=300",
                                 "chains=7",
                                 "large_step_probability=0.5",
                                 NULL};
    struct scene *scene = lit_pixels();
    struct settings s = test_settings(words);
    double worst_guess = 0.0;
    for (s.seed = 1; s.seed <= 5; s.seed++) {
        struct run_result r = test_run(scene, &s);
        const struct statistics *all = &r.statistics.whole;
        double large = (double)all->large, lit = round(all->eta_0 * large);
        double b = r.statistics.b;
        double b0 = (b * (bootstrap + large) - target * lit) / bootstrap;
        double sum = (b * r.statistics.paths + b0 * lit) * target / (target + p * b0);
        assert_relative(rgb_luminance(test_image_mean(r.image)), sum / r.statistics.paths,
                        1e-6);
        worst_guess = fmax(worst_guess, fabs(b / b0 - 1.0));
        double share = b / target; /* of lit ones among all independent paths */
        assert_relative(r.statistics.b_se,
                        target * sqrt(share * (1.0 - share) / (bootstrap + large - 1.0)),
                        1e-9);
        run_result_deinit(&r);
    }
    assert_true(worst_guess > 0.1);
    scene_destroy(scene);
}

/* Chains of large steps alone move when they hit the lamp, one time of sixteen. */
static void test_stays(void **state)
{
    (void)state;
    struct scene *scene = lit_pixels();
    struct run_result one = run_words(scene, "mutations_per_pixel=8", "chains=256",
                                      "large_step_probability=1", "seed=1");
    const struct run_statistics *s = &one.statistics;
    assert_true(s->paths == 256.0); /* one each */
    assert_true(s->chains_never_moved == 256.0 - round(s->acceptance * 256.0));
    assert_true(s->most_rejections_in_row == 1.0);
    assert_true(s->chains_never_moved > 200.0 && s->chains_never_moved < 256.0);
    assert_near(one.verdict.never_moved_share, s->chains_never_moved / 256.0, 1e-12);
    struct run_result many = run_words(scene, "mutations_per_pixel=25", "chains=8",
                                       "large_step_probability=1", "seed=1");
    s = &many.statistics;
    assert_true(s->paths == 800.0);
    assert_true(s->most_rejections_in_row > 16.0 && s->most_rejections_in_row <= 100.0);
    run_result_deinit(&one);
    run_result_deinit(&many);
    scene_destroy(scene);
}

static void test_pixels(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=pt", "integrator=bdpt",
                                              "integrator=pssmlt"};
    struct scene *scene = lit_pixels();
    for (int i = 0; i < 3; i++) {
        struct run_result r = run_words(scene, "mutations_per_pixel=2000", integrators[i],
                                        "threads=1", "seed=3");
        for (int pixel = 0; pixel < 32; pixel++) {
            double value = (double)r.image->pixels[3 * pixel + 1];
            bool lit = pixel == 8 + 2 || pixel == 8 + 3;
            /* An edge of the lamp may fall a rounding error beside the pixel's. */
            assert_relative(1.0 + value, lit ? 4.0 : 1.0, i < 2 ? 1e-6 : 0.1);
        }
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

static void test_thin_films(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 9}, {9, 1}};
    static const char *const words[] = {"integrator=pt", "integrator=bdpt",
                                        "estimator=plain"};
    for (int i = 0; i < 3; i++) {
        struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 1);
        test_room(desc);
        test_lamp(desc, 0.35, rgb(3, 2, 1));
        desc->width = sizes[i][0];
        desc->height = sizes[i][1];
        struct scene *scene = test_build(desc, false);
        for (int j = 0; j < 3; j++) {
            struct run_result r = run_words(scene, "mutations_per_pixel=300", words[j],
                                            "threads=1", "seed=3");
            assert_int_equal(r.image->width, sizes[i][0]);
            assert_int_equal(r.image->height, sizes[i][1]);
            assert_true(r.statistics.nonfinite == 0.0);
            assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
            run_result_deinit(&r);
        }
        scene_destroy(scene);
    }
}

/* A speck lit from so far away that a pilot of a few thousand paths finds nothing, and
 * that every splat of the light image is far below the emission: none may round to 0. */
static void test_faint(void **state)
{
    (void)state;
    const float far = 6e6f, half = 1e4f;
    struct scene_desc *desc = test_desc(vec3(0, 0, far), vec3(0, 0, 0), 34.0, 8);
    test_quad(desc, vec3(0, 0, 0), vec3(half, 0, 0), vec3(0, half, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    test_point_light(desc, vec3(0, 0, 1e6f), rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    static const char *const seeds[] = {"seed=2", "seed=3", "seed=4"};
    for (int i = 0; i < 3; i++) {
        struct run_result r = run_words(scene, "mutations_per_pixel=2000",
                                        "integrator=bdpt", seeds[i], "threads=1");
        assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* --- clocks, hooks, stops --------------------------------------------------------- */

static void test_seconds(void **state)
{
    (void)state;
    static const char *const words[] = {"integrator=pt", "integrator=bdpt",
                                        "estimator=plain"};
    struct scene *scene = furnace(8);
    for (int i = 0; i < 3; i++) {
        struct run_result r = run_words(scene, "seconds=0.05", words[i], "chains=10",
                                        "seed=3");
        assert_true(r.seconds_total >= 0.05 && r.seconds_cpu > 0.0);
        assert_true(r.statistics.paths > 0.0 && !r.interrupted);
        assert_true(r.statistics.seconds_startup < r.seconds_total);
        if (i == 2)
            assert_true(r.statistics.start_mutations <= r.statistics.paths);
        assert_relative(test_mean_over_b(&r), 1.0, 1e-6);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

static void test_startup_only(void **state)
{
    (void)state;
    struct scene *scene = furnace(8);
    const char *const words[] = {"mutations_per_pixel=100", "chains=10", "bootstrap=1000",
                                 NULL};
    struct settings s = test_settings(words);
    struct run_options options = {.scene = scene, .settings = &s, .startup_only = true};
    struct run_result r = {0};
    struct err err = {0};
    assert_true(run_render(&options, &r, &err));
    assert_true(r.statistics.paths == 640.0);
    assert_true(r.statistics.start_mutations == 640.0);
    assert_memory_equal(&r.statistics.start, &r.statistics.whole,
                        sizeof r.statistics.start);
    run_result_deinit(&r);
    scene_destroy(scene);
}

struct rows {
    int count, stop_after;
    double last_paths, last_mpp, last_wall;
};

static bool on_row(void *ctx, const struct error_row *row)
{
    struct rows *rows = ctx;
    assert_true(row->wall_s > rows->last_wall && row->paths > rows->last_paths);
    rows->last_wall = row->wall_s;
    rows->last_paths = row->paths;
    rows->last_mpp = row->mutations_per_pixel;
    return ++rows->count != rows->stop_after;
}

static bool run_with_rows(const struct scene *scene, const char *const *words,
                          struct rows *rows, const volatile sig_atomic_t *stop,
                          struct run_result *r)
{
    struct settings s = test_settings(words);
    struct image *reference = image_create(8, 8);
    for (int i = 0; i < 3 * 64; i++)
        reference->pixels[i] = 1.0f;
    struct run_options options = {
        .scene = scene,
        .settings = &s,
        .reference = reference,
        .stop = stop,
        .on_error_row = on_row,
        .hook_ctx = rows,
    };
    struct err err = {0};
    bool ok = run_render(&options, r, &err);
    if (!ok && err.message[0])
        fprintf(stderr, "%s\n", err.message);
    image_destroy(reference);
    return ok;
}

/* From .1 s on by factors of 1.25, and the end. On a busy machine a round may take longer
 * than the run shall: a longer run then has its two rows. */
static void test_rows(void **state)
{
    (void)state;
    struct scene *scene = furnace(8);
    struct rows rows = {0};
    struct run_result r = {0};
    for (double seconds = 0.3; rows.count < 2; seconds *= 2.0) {
        char budget[32];
        snprintf(budget, sizeof budget, "seconds=%g", seconds);
        const char *const words[] = {budget, "bootstrap=1000", NULL};
        rows = (struct rows){0};
        assert_true(seconds < 40.0 && run_with_rows(scene, words, &rows, NULL, &r));
        assert_in_range(rows.count, 1, 2 + (int)(log(10.0 * seconds) / log(1.25)));
        assert_true(rows.last_paths == r.statistics.paths);
        assert_true(rows.last_mpp == r.mutations_per_pixel);
        run_result_deinit(&r);
    }
    const char *const words[] = {"seconds=100", "bootstrap=1000", NULL};
    rows = (struct rows){.stop_after = 2};
    assert_false(run_with_rows(scene, words, &rows, NULL, &r));
    assert_int_equal(rows.count, 2);
    assert_true(r.statistics.paths == rows.last_paths);
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* A stop ends pt at once, chains after the round that is under way; what there is stands.
 */
static void test_stop(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=pt", "integrator=pssmlt"};
    struct scene *scene = furnace(8);
    volatile sig_atomic_t stop = 1;
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {integrators[i], "bootstrap=1000", NULL};
        struct rows rows = {.last_paths = -1.0};
        struct run_result r = {0};
        assert_true(run_with_rows(scene, words, &rows, &stop, &r));
        assert_int_equal(rows.count, 1);
        assert_true(r.interrupted);
        assert_true(r.statistics.paths == 0.0);
        assert_true(r.statistics.unsampled == (i == 0 ? 1.0 : 0.0));
        assert_int_equal(r.statistics.start_looks, 0);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* A p_l that was given is reported as such in a black picture too. */
static void test_dark_manual(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 9), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    struct run_result r = run_words(scene, "large_step_probability=0.25", "seed=1",
                                    "seed=2", "seed=3");
    assert_true(r.statistics.plarge.p_l == 0.25 && !r.statistics.plarge_auto);
    assert_non_null(strstr(r.statistics.plarge.reason, "was given"));
    assert_true(r.statistics.b == 0.0 && r.statistics.paths == 0.0);
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* A wall and a point light before it: all light has two edges. */
static struct scene *direct_only(bool lit)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 5), vec3(0, 0, 0), 40.0, 16);
    test_quad(desc, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    test_point_light(desc, vec3(0, 0, lit ? 2.0f : -2.0f), rgb_grey(1.0));
    if (!lit) /* behind two walls */
        test_quad(desc, vec3(0, 0, -1), vec3(9, 0, 0), vec3(0, 9, 0),
                  test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0),
                  rgb_grey(0.0));
    return test_build(desc, false);
}

/* What needs no chain is not missed for want of one; what is dark is dark. */
static void test_no_chain_needed(void **state)
{
    (void)state;
    for (int lit = 0; lit < 2; lit++) {
        struct scene *scene = direct_only(lit);
        const char *const integrators[] = {"integrator=mmlt", "integrator=pfmlt"};
        for (int i = 0; i < 2; i++) {
            struct run_result r = run_words(scene, "mutations_per_pixel=80",
                                            integrators[i], "direct=separate", "seed=1");
            assert_int_equal(r.verdict.call, lit ? VERDICT_CONVERGED : VERDICT_NOT);
            assert_int_equal(r.statistics.plain_only, lit);
            assert_true(!lit || (r.statistics.b_trusted && !r.statistics.seeds_few));
            assert_true(lit == (strstr(r.statistics.plarge.reason,
                                       "no chain is needed") != NULL));
            assert_true(lit || strstr(r.verdict.words, "no light was found"));
            run_result_deinit(&r);
        }
        scene_destroy(scene);
    }
}

static bool same_pictures(const struct run_result *a, const struct run_result *b)
{
    size_t bytes = 3 * sizeof(float) * (size_t)a->image->width * (size_t)a->image->height;
    return memcmp(a->image->pixels, b->image->pixels, bytes) == 0;
}

/* A run that ended early is the run of that length: looks leave no trace. Two looks in
 * succession that say "converged" cannot be before 121.5 a pixel: pt's first eight spans
 * are 64 samples. */
static void test_until(void **state)
{
    (void)state;
    struct scene *scene = direct_only(true);
    struct run_result early = run_words(scene, "mutations_per_pixel=2000",
                                        "integrator=pt", "until_converged=true",
                                        "seed=1");
    assert_int_equal(early.end, RUN_UNTIL);
    assert_int_equal(early.verdict.call, VERDICT_CONVERGED);
    assert_int_equal(early.until.looks, 8); /* 8 * 1.5^7 = 136.7 */
    assert_true(early.statistics.paths == 137.0 * 256.0);
    struct run_result plain = run_words(scene, "mutations_per_pixel=137", "integrator=pt",
                                        "seed=1", "max_depth=4");
    assert_int_equal(plain.end, RUN_BUDGET);
    assert_true(same_pictures(&early, &plain));
    run_result_deinit(&early);
    run_result_deinit(&plain);
    struct run_result never = run_words(scene, "mutations_per_pixel=137", "integrator=pt",
                                        "until_relmse=1e-12", "seed=1");
    assert_int_equal(never.end, RUN_BUDGET);
    assert_true(never.until.bound > 1e-12);
    run_result_deinit(&never);
    scene_destroy(scene);
    /* Chains: with any number of threads, and as far as without looks. */
    scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {
        "integrator=mmlt",   "bootstrap=1000", "mutations_per_pixel=2000",
        "until_relmse=0.05", "chains=32",      NULL};
    struct settings s = test_settings(words);
    struct run_result one = test_run(scene, &s);
    s.threads = 3;
    struct run_result three = test_run(scene, &s);
    assert_int_equal(one.end, RUN_UNTIL);
    assert_true(one.until.bound < 0.05 && one.verdict.relmse < 0.05);
    assert_true(one.statistics.paths == three.statistics.paths);
    assert_true(same_pictures(&one, &three));
    run_result_deinit(&one);
    run_result_deinit(&three);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean),
        cmocka_unit_test(test_kelemen_weights),
        cmocka_unit_test(test_start_and_whole),
        cmocka_unit_test(test_budgets),
        cmocka_unit_test(test_budget_again),
        cmocka_unit_test(test_single_chain),
        cmocka_unit_test(test_kelemen_units),
        cmocka_unit_test(test_stays),
        cmocka_unit_test(test_pixels),
        cmocka_unit_test(test_thin_films),
        cmocka_unit_test(test_faint),
        cmocka_unit_test(test_seconds),
        cmocka_unit_test(test_startup_only),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_stop),
        cmocka_unit_test(test_dark_manual),
        cmocka_unit_test(test_no_chain_needed),
        cmocka_unit_test(test_until),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
