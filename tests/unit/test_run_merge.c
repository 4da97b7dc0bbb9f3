/* A run in parts is the run in one piece, bit for bit: picture, error bars, every layer,
 * verdict and statistics but times, for any number of parts and threads, wherever a part
 * was cut and resumed, with the measured start repeated or read from a file. Without one
 * of the parts the picture is that of fewer chains. No random event: there are no false
 * alarms in tests of bits; those of means state theirs. */

#include <string.h>

#include "lab/statistics.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

enum { PARTS_TESTED = 8 };

static char *file_name(const char *name, int index)
{
    const char *folder = getenv("TEST_TMP");
    return text_format("%s/test_run_merge.%s%d", folder ? folder : "/tmp", name, index);
}

/* --- outcomes --------------------------------------------------------------------- */

/* Everything that a run gives, as bytes; times, threads and memory apart. */
static struct text outcome(struct run_result *r, const struct settings *settings,
                           const struct scene *scene)
{
    struct text all = {0};
    struct statistics_record record;
    size_t values = (size_t)r->image->width * (size_t)r->image->height;
    r->statistics.seconds_startup = r->seconds_total = r->seconds_cpu = 0.0;
    r->threads = 0;
    statistics_record_init(&record, r, settings, scene, "");
    record.memory_peak = 0.0;
    record.run.memory.films = 0.0;
    char *yaml = statistics_yaml(&record);
    text_append(&all, "%s", yaml);
    mem_free(yaml);
    size_t bytes = values * sizeof(float) * (3 + (size_t)r->layers.count);
    all.data = mem_grow(all.data, &all.capacity, all.length + bytes, 1);
    memcpy(all.data + all.length, r->image->pixels, 12 * values);
    all.length += 12 * values;
    for (int i = 0; i < r->layers.count; i++) {
        memcpy(all.data + all.length, r->layers.list[i].values, 4 * values);
        all.length += 4 * values;
    }
    run_result_deinit(r);
    return all;
}

/* The first column that differs is named. */
static void assert_same_outcome(struct text *found, const struct text *expected)
{
    size_t i = 0, line = 0;
    while (i < found->length && i < expected->length && found->data[i] &&
           found->data[i] == expected->data[i])
        if (expected->data[i++] == '\n')
            line = i;
    if (i < strlen(expected->data))
        fail_msg("%.60s", expected->data + line);
    assert_int_equal(found->length, expected->length);
    assert_memory_equal(found->data, expected->data, expected->length);
    mem_free(found->data);
}

/* --- parts ------------------------------------------------------------------------ */

struct job {
    const struct scene *scene;
    struct settings settings;
    struct identity identity;
    int count;
    const char *start; /* file of the measured start, or NULL */
    double stop_at;    /* a part is stopped at this share and resumed; 0: never */
};

struct stopper {
    volatile sig_atomic_t stop;
    double at;
};

static void stop_late(void *ctx, const struct run_progress *progress)
{
    struct stopper *stopper = ctx;
    stopper->stop = progress->share >= stopper->at;
}

/* From `from` (NULL: the beginning), to the file `to`. */
static void run_part(struct job *job, int index, const char *from, const char *to,
                     double stop_at)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint checkpoint;
    struct run_part part = {index, job->count};
    struct stopper stopper = {0, stop_at};
    struct checkpoint_options writing = {
        .path = to, .every = (double)INFINITY, .identity = &job->identity};
    struct run_options options = {
        .scene = job->scene,
        .settings = &job->settings,
        .part = part,
        .checkpoint = &writing,
        .stop = stop_at > 0.0 ? &stopper.stop : NULL,
        .on_progress = stop_late,
        .hook_ctx = &stopper,
    };
    if (from) {
        if (!checkpoint_open(&checkpoint, from, &job->identity, &job->settings, part,
                             &err))
            test_scene_die(&err);
        options.resume = &checkpoint;
    }
    if (!run_render(&options, &r, &err))
        test_scene_die(&err);
    run_result_deinit(&r);
}

static void run_parts(struct job *job, char *files[PARTS_TESTED])
{
    for (int i = 0; i < job->count; i++) {
        files[i] = file_name("part", i);
        job->settings.threads = 1 + i % 3;
        run_part(job, i, job->start, files[i], job->stop_at);
        if (job->stop_at > 0.0)
            run_part(job, i, files[i], files[i], 0.0);
    }
}

static void remove_parts(const struct job *job, char *files[PARTS_TESTED])
{
    for (int i = 0; i < job->count; i++) {
        remove(files[i]);
        mem_free(files[i]);
    }
}

/* missing: a bit for each part that is left out. */
static struct run_result merge(struct job *job, char *files[PARTS_TESTED],
                               unsigned missing)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint parts[PARTS_TESTED];
    struct run_options options = {.scene = job->scene, .settings = &job->settings};
    int count = 0;
    for (int i = job->count - 1; i >= 0; i--) /* in any order */
        if (!(missing >> i & 1) &&
            !checkpoint_open(&parts[count++], files[i], &job->identity, &job->settings,
                             (struct run_part){i, job->count}, &err))
            test_scene_die(&err);
    if (!run_merge(&options, parts, count, &r, &err))
        test_scene_die(&err);
    return r;
}

static struct job job_of(const struct scene *scene, const char *const *words)
{
    struct job job = {.scene = scene, .settings = test_settings(words)};
    identity_add(&job.identity, "name", "%s", "value");
    return job;
}

/* --- bits ------------------------------------------------------------------------- */

static const char *const designs[][5] = {
    {"integrator=pssmlt"},
    {"integrator=pssmlt", "builder=pt", "estimator=plain", "kernel=gaussian"},
    {"integrator=pssmlt", "rule=tours"},
    {"integrator=mmlt", "direct=separate"},
    {"integrator=mmlt", "direct=separate", "rule=tours", "per=length"},
    {"integrator=mmlt", "direct=joint", "estimator=plain", "allocation=brightness"},
    {"integrator=mmlt", "direct=joint", "bootstrap=18", "estimator=plain"},
    {"integrator=pfmlt", "direct=joint"},
    {"integrator=pfmlt", "direct=separate", "large_step_probability=.3"},
    {"integrator=pfmlt", "mode=paper", "direct=joint"},
    {"integrator=pt"},
    {"integrator=bdpt"},
};

static struct job design_job(const struct scene *scene, size_t design)
{
    const char *words[16] = {"mutations_per_pixel=60", "chains=20", "bootstrap=1000",
                             "max_depth=5", "start_mutations=20"};
    int count = 5;
    for (int i = 0; i < 5 && designs[design][i]; i++)
        words[count++] = designs[design][i];
    return job_of(scene, words);
}

static void same_in_parts(struct job *job, const struct text *expected)
{
    char *files[PARTS_TESTED];
    run_parts(job, files);
    struct run_result r = merge(job, files, 0);
    struct text found = outcome(&r, &job->settings, job->scene);
    assert_same_outcome(&found, expected);
    remove_parts(job, files);
}

/* The start of all, as 'etalon startup --save' makes it. */
static void save_start(struct job *job, const char *path)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint_options writing = {
        .path = path, .every = (double)INFINITY, .identity = &job->identity};
    struct run_options options = {.scene = job->scene,
                                  .settings = &job->settings,
                                  .startup_only = true,
                                  .checkpoint = &writing};
    if (!run_render(&options, &r, &err))
        test_scene_die(&err);
    run_result_deinit(&r);
}

static void test_bits(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
        struct job job = design_job(scene, i);
        struct run_result whole = test_run(scene, &job.settings);
        assert_true(whole.statistics.b > 0.0 && whole.layers.count >= (i == 9 ? 1 : 3));
        struct text expected = outcome(&whole, &job.settings, scene);
        const int counts[] = {1, 2, 5, 8};
        /* All counts where nothing else has been tried of an integrator. */
        bool first = i == 0 || i == 3 || i == 7 || i >= 10;
        for (int j = 0; j < 4; j++) {
            if (!first && j != 2)
                continue;
            job.count = counts[j];
            job.stop_at = first && j == 1 ? 0.4 : 0.0;
            same_in_parts(&job, &expected);
        }
        if (i < 10) {
            char *start = file_name("start", 0);
            save_start(&job, start);
            job.start = start;
            job.count = 3;
            same_in_parts(&job, &expected);
            remove(start);
            mem_free(start);
        }
        mem_free(expected.data);
        identity_deinit(&job.identity);
    }
    scene_destroy(scene);
}

/* Lengths that share a film, as on large films of deep paths. */
static void test_shared_films(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    const char *const words[] = {"integrator=mmlt",
                                 "mutations_per_pixel=90",
                                 "direct=joint",
                                 "chains=20",
                                 "max_depth=6",
                                 "bootstrap=500",
                                 NULL};
    struct job job = job_of(scene, words);
    job.settings.memory_limit = 1.0;
    job.count = 3;
    struct run_result whole = test_run(scene, &job.settings);
    struct text expected = outcome(&whole, &job.settings, scene);
    same_in_parts(&job, &expected);
    mem_free(expected.data);
    identity_deinit(&job.identity);
    scene_destroy(scene);
}

/* Nothing is lit; and a wall that reflects infinitely much. */
static void test_dark_and_nonfinite(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f),
                                            vec3(0, 1, i < 2 ? 9.0f : 0.0f), 34.0, 8);
        test_room(desc);
        test_lamp(desc, 0.3, rgb(3, 2, 1));
        for (int j = 0; i >= 2 && j < 6; j++)
            desc->materials[1].param[j] = HUGE_VAL;
        struct scene *scene = test_build(desc, false);
        const char *const words[] = {i % 2 ? "integrator=mmlt" : "integrator=bdpt",
                                     "mutations_per_pixel=64",
                                     "bootstrap=500",
                                     "max_depth=4",
                                     "chains=8",
                                     NULL};
        struct job job = job_of(scene, words);
        job.count = 3;
        struct run_result whole = test_run(scene, &job.settings);
        assert_true(i < 2 || whole.statistics.nonfinite > 0.0);
        struct text expected = outcome(&whole, &job.settings, scene);
        same_in_parts(&job, &expected);
        mem_free(expected.data);
        identity_deinit(&job.identity);
        scene_destroy(scene);
    }
}

/* --- without some parts, and ended by the clock ------------------------------------- */

/* Mean over b of a run without parts 2 and 5 of 8. Each integrator's picture has the mean
 * of b but for the difference of two estimates of it, whose relative standard deviation
 * over seeds is below 2 % at these lengths; the limit is five of those. A picture that
 * lacked the light of the missing quarter would be 25 % too dark. */
static void test_lost_parts(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    const size_t tried[] = {0, 3, 5, 7, 11};
    for (int i = 0; i < 5; i++) {
        struct job job = design_job(scene, tried[i]);
        char *files[PARTS_TESTED];
        job.settings.chains = 96;
        job.settings.mutations_per_pixel = 120.0;
        job.count = 8;
        run_parts(&job, files);
        struct run_result all = merge(&job, files, 0);
        struct run_result some = merge(&job, files, 1 << 1 | 1 << 4);
        double share = some.statistics.paths / all.statistics.paths;
        assert_true(share > 0.7 && share < 0.8);
        assert_true(fabs(test_mean_over_b(&some) / test_mean_over_b(&all) - 1.0) < 0.1);
        assert_true(some.statistics.chains == (tried[i] < 10 ? 72 : 0));
        /* The error bars grow, by about sqrt(4/3), and not by what is missing. */
        double ratio = some.verdict.relmse / all.verdict.relmse;
        assert_true(ratio > 0.7 && ratio < 2.5);
        run_result_deinit(&some);
        run_result_deinit(&all);
        remove_parts(&job, files);
        identity_deinit(&job.identity);
    }
    scene_destroy(scene);
}

/* Parts that made different numbers of mutations, as under a time budget: from a common
 * start they have other budgets. The same limits. */
static void test_unequal_parts(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    const size_t tried[] = {0, 3, 5, 7, 11};
    for (int i = 0; i < 5; i++) {
        struct job job = design_job(scene, tried[i]);
        char *files[PARTS_TESTED];
        job.settings.chains = 96;
        job.settings.mutations_per_pixel = 160.0;
        job.count = 4;
        run_parts(&job, files);
        struct run_result all = merge(&job, files, 0);
        char *start = i < 4 ? file_name("start", 0) : NULL;
        if (start)
            save_start(&job, start);
        for (int j = 0; j < 4; j++) {
            job.settings.mutations_per_pixel = 40.0 * (j + 1);
            run_part(&job, j, start, files[j], 0.0);
        }
        struct run_result some = merge(&job, files, 0);
        if (start)
            remove(start);
        mem_free(start);
        double share = some.statistics.paths / all.statistics.paths;
        assert_true(share > 0.6 && share < 0.66);
        assert_true(fabs(test_mean_over_b(&some) / test_mean_over_b(&all) - 1.0) < 0.1);
        double ratio = some.verdict.relmse / all.verdict.relmse;
        assert_true(ratio > 1.2 && ratio < 8.0);
        run_result_deinit(&some);
        run_result_deinit(&all);
        remove_parts(&job, files);
        identity_deinit(&job.identity);
    }
    scene_destroy(scene);
}

/* --- what is refused -------------------------------------------------------------- */

static void assert_refused(const struct job *job, const char *path, struct run_part part,
                           const char *words)
{
    struct err err = {0};
    struct checkpoint checkpoint;
    assert_false(
        checkpoint_open(&checkpoint, path, &job->identity, &job->settings, part, &err));
    if (strstr(err.message, words) == NULL)
        fail_msg("'%s' is not in '%s'", words, err.message);
}

/* A start of another seed under the identity of this one; another part; a whole run's. */
static void test_refused(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    struct job job = design_job(scene, 0);
    char *files[PARTS_TESTED];
    struct checkpoint parts[2];
    struct run_result r = {0};
    struct err err = {0};
    job.count = 2;
    run_parts(&job, files);
    assert_refused(&job, files[0], (struct run_part){1, 2}, "1/2, this run has 2/2");
    assert_refused(&job, files[0], (struct run_part){0, 3}, "1/2, this run has 1/3");
    assert_refused(&job, files[0], (struct run_part){0}, "1/2, this run has none");
    job.settings.seed = 2;
    run_part(&job, 1, NULL, files[1], 0.0);
    for (int i = 0; i < 2; i++)
        assert_true(checkpoint_open(&parts[i], files[i], &job.identity, &job.settings,
                                    (struct run_part){i, 2}, &err));
    struct run_options options = {.scene = scene, .settings = &job.settings};
    assert_false(run_merge(&options, parts, 2, &r, &err));
    assert_non_null(strstr(err.message, "its measured start is not that of the other"));
    for (int i = 0; i < 2; i++)
        pack_destroy(parts[i].pack);
    remove_parts(&job, files);
    identity_deinit(&job.identity);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bits),
        cmocka_unit_test(test_shared_films),
        cmocka_unit_test(test_dark_and_nonfinite),
        cmocka_unit_test(test_lost_parts),
        cmocka_unit_test(test_unequal_parts),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
