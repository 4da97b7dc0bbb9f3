/* A run in parts is the run in one piece, bit for bit: picture, error bars, every layer,
 * verdict and statistics but times, for any number of parts and threads, wherever a part
 * was cut and resumed, with the measured start repeated or read from a file. No random
 * event, no false alarm. What a part that is lost leaves: tests/stat/test_run_parts.c. */

#include <string.h>

#include "lab/statistics.h"
#include "path/passage.h"
#include "support/test_parts.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

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
        fail_msg("'%.30s' instead of '%.30s'", found->data + line, expected->data + line);
    assert_int_equal(found->length, expected->length);
    assert_memory_equal(found->data, expected->data, expected->length);
    mem_free(found->data);
}

/* --- bits ------------------------------------------------------------------------- */

static const char *const designs[][5] = {
    {"integrator=pssmlt",
     "layers=acceptance,failures,work,visits,lengths,techniques,features"},
    {"integrator=pssmlt", "builder=pt", "estimator=plain", "kernel=gaussian"},
    {"integrator=pssmlt", "rule=tours"},
    {"integrator=mmlt", "direct=separate", "layers=acceptance,work,visits,techniques"},
    {"integrator=mmlt", "direct=separate", "rule=tours", "per=length"},
    {"integrator=mmlt", "direct=joint", "estimator=plain", "allocation=brightness"},
    {"integrator=mmlt", "direct=joint", "bootstrap=18", "estimator=plain"},
    {"integrator=pfmlt", "direct=joint"},
    {"integrator=pfmlt", "direct=separate", "large_step_probability=.3"},
    {"integrator=pfmlt", "mode=paper", "direct=joint"},
    {"integrator=pt"},
    {"integrator=bdpt", "layers=failures,work,lengths,unweighted"},
    {"integrator=auto"},
};

static struct job design_job(const struct scene *scene, size_t design)
{
    const char *words[16] = {"mutations_per_pixel=40", "chains=20", "bootstrap=500",
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
        /* All counts where nothing else has been tried of an integrator; eight parts of
         * one with chains and one without. */
        bool first = i == 0 || i == 3 || i == 7 || i >= 10;
        for (int j = 0; j < 4; j++) {
            if (!first || (j == 3 && i != 3 && i != 10))
                continue;
            job.count = counts[j];
            job.stop_at = first && j == 1 ? 0.4 : 0.0;
            job.team = (i == 3 || i == 11) && j == 2 ? 2 : 0;
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
                                 "mutations_per_pixel=50",
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

/* Edges that pass too many surfaces, before half of the view: they are counted once by
 * parts, with a start of their own or that of all, and by runs that go on; and they stand
 * in the verdict. */
static void test_edges_cut(void **state)
{
    (void)state;
    static const char *const tried[][2] = {
        {"integrator=bdpt", "mutations_per_pixel=132"},
        {"integrator=mmlt", "mutations_per_pixel=40"},
        {"integrator=pssmlt", "mutations_per_pixel=40"},
    };
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 4);
    int null = test_material(desc, "null", NULL, rgb_grey(0.0), NULL, 0.0);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    for (int i = 0; i <= PASSAGE_MOST; i++)
        test_quad(desc, vec3(1, 1, 1.5f + 0.002f * (float)i), vec3(1, 0, 0),
                  vec3(0, 1, 0), null, rgb_grey(0.0));
    struct scene *scene = test_build(desc, false);
    for (int i = 0; i < 3; i++) {
        const char *const words[] = {tried[i][0],   tried[i][1], "bootstrap=200",
                                     "max_depth=3", "chains=8",  NULL};
        struct job job = job_of(scene, words);
        struct run_result whole = test_run(scene, &job.settings);
        assert_true(whole.statistics.edges_cut > 0.0);
        assert_true(i > 0 || strstr(whole.verdict.words, "edges pass too many panes"));
        struct text expected = outcome(&whole, &job.settings, scene);
        job.count = 3;
        job.stop_at = 0.4;
        same_in_parts(&job, &expected);
        job.stop_at = 0.0;
        if (i > 0) {
            char *start = file_name("start", 0);
            save_start(&job, start);
            job.start = start;
            same_in_parts(&job, &expected);
            remove(start);
            mem_free(start);
        }
        mem_free(expected.data);
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
        cmocka_unit_test(test_edges_cut),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
