/* A run that goes on from a checkpoint, with other threads, is the undisturbed run: the
 * picture, the map of failures and every statistic, bit for bit, wherever it was cut. And
 * what does not fit, or is damaged, is refused. */

#include <string.h>

#include "base/clock.h"
#include "base/hash.h"
#include "base/libraries.h"
#include "integrator/registry.h"
#include "lab/identity.h"
#include "lab/statistics.h"
#include "support/test_file.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

/* --- integrators, round by round -------------------------------------------------- */

static bool same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The figures of a line of progress are those of the statistics. */
static void check_counts(const struct integrator_type *type, const void *integrator,
                         const struct run_statistics *s)
{
    struct run_counts counts;
    type->methods->counts(integrator, &counts);
    assert_true(counts.paths == s->paths && same(counts.acceptance, s->acceptance));
    assert_true(same(counts.p_large, s->plarge.p_l));
}

/* Everything that a run gives, as bytes; times, threads and memory apart. */
static struct text outcome(const struct integrator_type *type, void *integrator,
                           const struct scene *scene, const struct settings *settings)
{
    struct text all = {0};
    int width = scene->camera.width, height = scene->camera.height;
    struct run_result r = {.image = image_create(width, height)};
    size_t values = (size_t)width * (size_t)height;
    type->methods->picture(integrator, r.image);
    type->methods->statistics(integrator, &r.statistics);
    check_counts(type, integrator, &r.statistics);
    r.statistics.seconds_startup = 0.0;
    struct statistics_record record;
    statistics_record_init(&record, &r, settings, scene, "");
    record.memory_peak = 0.0;
    char *yaml = statistics_yaml(&record);
    text_append(&all, "%s", yaml);
    all.data = mem_grow(all.data, &all.capacity, all.length + 16 * values, 1);
    memcpy(all.data + all.length, r.image->pixels, 12 * values);
    all.length += 12 * values;
    if (type->methods->layers)
        type->methods->layers(integrator, &r.layers);
    for (int i = 0; i < r.layers.count && i < 1; i++) {
        memcpy(all.data + all.length, r.layers.list[i].values, 4 * values);
        all.length += 4 * values;
    }
    layers_deinit(&r.layers);
    mem_free(yaml);
    image_destroy(r.image);
    return all;
}

/* Rounds until the budget is used up, at most `most`; how many they were. */
static int advance(const struct integrator_type *type, void *integrator, int most)
{
    const struct round_limits limits = {.seconds_used = 0.0};
    int done = 0;
    bool more = true;
    while (more && done < most) {
        more = type->methods->advance(integrator, &limits);
        done++;
    }
    return done;
}

static void *hand_over(const struct integrator_type *type, void *integrator,
                       const struct scene *scene, const struct settings *settings,
                       const char *path)
{
    struct err err = {0};
    struct pack *pack = pack_create(path, CHECKPOINT_LAYOUT, &err);
    assert_non_null(pack);
    type->methods->pack(integrator, pack);
    if (!pack_close(pack, &err))
        test_scene_die(&err);
    type->methods->destroy(integrator);
    integrator = type->methods->create(type, scene, settings);
    pack = pack_open(path, CHECKPOINT_LAYOUT, &err);
    assert_non_null(pack);
    type->methods->pack(integrator, pack);
    if (!pack_close(pack, &err))
        test_scene_die(&err);
    return integrator;
}

/* Rounds are the smaller the more chains there are; a cut after each of the first ones,
 * of which the first is the bootstrap, and then here and there. */
static void same_after_cut_within(const struct scene *scene, const char *const *words,
                                  double memory_limit)
{
    char *path = test_file("state");
    struct settings whole = test_settings(words), before, after;
    whole.memory_limit = memory_limit;
    before = after = whole;
    const struct integrator_type *type = integrator_find(whole.integrator);
    void *integrator = type->methods->create(type, scene, &whole);
    int rounds = advance(type, integrator, 1 << 30);
    struct text expected = outcome(type, integrator, scene, &whole);
    type->methods->destroy(integrator);
    before.threads = 2;
    after.threads = 3;
    assert_true(rounds >= 6);
    for (int cut = 1; cut < rounds; cut = cut < 3 ? cut + 1 : 2 * cut) {
        integrator = type->methods->create(type, scene, &before);
        assert_int_equal(advance(type, integrator, cut), cut);
        integrator = hand_over(type, integrator, scene, &after, path);
        /* With the state as it is, and not only from then on. */
        integrator = hand_over(type, integrator, scene, &before, path);
        assert_int_equal(advance(type, integrator, 1 << 30), rounds - cut);
        struct text found = outcome(type, integrator, scene, &whole);
        assert_int_equal(found.length, expected.length);
        assert_memory_equal(found.data, expected.data, expected.length);
        mem_free(found.data);
        type->methods->destroy(integrator);
    }
    mem_free(expected.data);
    remove(path);
    mem_free(path);
}

static void same_after_cut(const struct scene *scene, const char *const *words)
{
    same_after_cut_within(scene, words, 0.0);
}

static const char *const designs[][5] = {
    {"integrator=pssmlt", "builder=bdpt", "estimator=kelemen", "kernel=exponential"},
    {"integrator=pssmlt", "builder=pt", "estimator=plain", "kernel=gaussian"},
    {"integrator=pssmlt", "builder=bdpt", "estimator=plain", "kernel=gaussian"},
    {"integrator=pssmlt", "builder=pt", "estimator=kelemen", "large_step_probability=.3"},
    {"integrator=mmlt", "direct=separate"},
    {"integrator=mmlt", "direct=joint", "per=length", "kernel=gaussian"},
    {"integrator=mmlt", "direct=joint", "estimator=plain", "allocation=brightness"},
    /* Lengths that the bootstrap does not find, and chains do. */
    {"integrator=mmlt", "direct=joint", "bootstrap=18", "estimator=plain"},
    {"integrator=pfmlt", "mode=exact", "direct=joint", "layers=acceptance,work,lengths"},
    {"integrator=pfmlt", "mode=counted", "direct=separate", "kernel=exponential"},
    {"integrator=pfmlt", "mode=paper", "direct=joint"},
    {"integrator=rjmlt", "jump_probability=0.4", "direct=joint"},
    {"integrator=rjmlt", "mode=exact", "direct=separate"},
    {"integrator=smlt", "share_floor=1", "ceiling=3", "passes_share=.3"},
    {"integrator=smlt", "builder=pt", "share_floor=auto", "layers=visits,techniques"},
    {"integrator=smlt", "metropolis=mmlt", "share_floor=.5", "per=length"},
    {"integrator=mmlt", "direct=joint", "two_stage=true", "ceiling=2"},
    {"integrator=mlt", "direct=joint", "mutation_weights=measured", "weight_numbers=1"},
    {"integrator=mlt", "direct=separate", "deletion=weighted", "estimator=plain"},
    {"integrator=pt", "layers=work,unweighted"},
    {"integrator=bdpt"},
    {"integrator=auto"},
};

static void test_cuts(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
        const char *words[16] = {"mutations_per_pixel=90", "chains=20", "bootstrap=1000",
                                 "max_depth=6", "start_mutations=150"};
        int count = 5;
        for (int j = 0; j < 5 && designs[i][j]; j++)
            words[count++] = designs[i][j];
        same_after_cut(scene, words);
    }
    scene_destroy(scene);
}

/* So long that the measured start is looked at several times. */
static void test_long_start(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {"mutations_per_pixel=20", "chains=1",      "start=0.02",
                                 "start_cap=.5",           "bootstrap=500", NULL};
    same_after_cut(scene, words);
    scene_destroy(scene);
}

/* Nothing is lit: there are no films and no chains to save. */
static void test_dark(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 9), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    const char *const words[] = {"integrator=mmlt", "mutations_per_pixel=64",
                                 "direct=separate", "bootstrap=1000", NULL};
    same_after_cut(scene, words);
    scene_destroy(scene);
}

/* A wall that reflects infinitely much: what is not finite is counted on. */
static void test_nonfinite(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=pt", "integrator=pssmlt",
                                              "integrator=mmlt"};
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(3, 2, 1));
    for (int i = 0; i < 6; i++)
        desc->materials[1].param[i] = HUGE_VAL;
    struct scene *scene = test_build(desc, false);
    for (int i = 0; i < 3; i++) {
        const char *const words[] = {integrators[i], "mutations_per_pixel=99", "chains=8",
                                     "max_depth=4",  "bootstrap=500",          NULL};
        struct settings s = test_settings(words);
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.nonfinite > 0.0);
        run_result_deinit(&r);
        same_after_cut(scene, words);
    }
    scene_destroy(scene);
}

/* No room for films and tables: all lengths but the brightest share a film, those too
 * that the bootstrap has not found; and one tile for all large steps. */
static void test_shared_films(void **state)
{
    (void)state;
    static const char *const bootstraps[] = {"bootstrap=1000", "bootstrap=18"};
    struct scene *scene = test_scene(TEST_POINT, false);
    for (int i = 0; i < 2; i++) {
        const char *const words[] = {
            "integrator=mmlt", "mutations_per_pixel=90", "direct=joint", "chains=20",
            "max_depth=6",     "estimator=plain",        bootstraps[i],  NULL};
        same_after_cut_within(scene, words, 1.0);
    }
    scene_destroy(scene);
}

/* --- whole runs ------------------------------------------------------------------- */

struct stopper {
    volatile sig_atomic_t stop;
    int rows;
    double last_paths;
    bool waits; /* stops only when there are paths: a first round may end before */
};

static void stop_at_once(void *ctx, const struct run_progress *progress)
{
    struct stopper *stopper = ctx;
    if (!stopper->waits || progress->paths > 0.0)
        stopper->stop = 1;
}

static bool count_row(void *ctx, const struct error_row *row)
{
    struct stopper *stopper = ctx;
    assert_true(row->paths > stopper->last_paths || stopper->rows == 0);
    stopper->last_paths = row->paths;
    stopper->rows++;
    return true;
}

struct leg {
    const struct scene *scene;
    struct settings settings;
    const struct image *reference;
    struct identity identity;
    const char *path;
    bool resume, stopped;
    struct stopper stopper;
};

/* From the checkpoint, if there is one, to the first progress or to the end. */
static struct run_result run_leg(struct leg *leg)
{
    struct err err = {0};
    struct run_result result = {0};
    struct checkpoint checkpoint;
    struct checkpoint_options writing = {
        .path = leg->path, .every = 0.0, .identity = &leg->identity};
    leg->stopper = (struct stopper){.last_paths = -1.0};
    struct run_options options = {
        .scene = leg->scene,
        .settings = &leg->settings,
        .reference = leg->reference,
        .stop = &leg->stopper.stop,
        .on_progress = leg->stopped ? stop_at_once : NULL,
        .on_error_row = count_row,
        .hook_ctx = &leg->stopper,
        .checkpoint = &writing,
    };
    if (leg->resume) {
        if (!checkpoint_open(&checkpoint, leg->path, &leg->identity, &leg->settings,
                             (struct run_part){0}, &err))
            test_scene_die(&err);
        options.resume = &checkpoint;
    }
    if (!run_render(&options, &result, &err))
        test_scene_die(&err);
    return result;
}

static struct leg first_leg(const struct scene *scene, const char *const *words,
                            const char *path)
{
    struct leg leg = {.scene = scene, .settings = test_settings(words), .path = path};
    identity_add(&leg.identity, "name", "%s", "value");
    return leg;
}

static void assert_same_picture(const struct image *a, const struct image *b)
{
    assert_memory_equal(a->pixels, b->pixels,
                        sizeof(float) * 3 * (size_t)(a->width * a->height));
}

/* Stopped after its first round, again and again, each time with other threads. A
 * finished run that is resumed has nothing to do, and more rows of the error log than one
 * at its end are rows that were made twice. */
static void test_many_legs(void **state)
{
    (void)state;
    const char *const words[] = {"mutations_per_pixel=90", "chains=20", "bootstrap=1000",
                                 "max_depth=4", NULL};
    struct scene *scene = test_scene(TEST_POINT, false);
    struct settings s = test_settings(words);
    struct run_result whole = test_run(scene, &s), r = {0};
    char *path = test_file("legs");
    struct leg leg = first_leg(scene, words, path);
    leg.reference = whole.image;
    leg.stopped = true;
    int legs = 0;
    double wall = -1.0, paths = -1.0;
    do {
        leg.settings.threads = 1 + legs % 3;
        r = run_leg(&leg);
        assert_true(r.seconds_total > wall && r.statistics.paths > paths);
        assert_true(leg.stopper.rows >= 1 &&
                    leg.stopper.last_paths == r.statistics.paths);
        wall = r.seconds_total;
        paths = r.statistics.paths;
        leg.resume = true;
        legs++;
        if (paths < whole.statistics.paths)
            run_result_deinit(&r);
    } while (paths < whole.statistics.paths);
    assert_true(legs >= 6);
    assert_same_picture(r.image, whole.image);
    assert_true(r.statistics.b_se == whole.statistics.b_se);
    run_result_deinit(&r);
    leg.stopped = false;
    int rows = leg.stopper.rows;
    r = run_leg(&leg);
    assert_same_picture(r.image, whole.image);
    assert_true(r.seconds_total == wall && !r.interrupted);
    assert_int_equal(leg.stopper.rows, rows);
    run_result_deinit(&r);
    run_result_deinit(&whole);
    identity_deinit(&leg.identity);
    scene_destroy(scene);
    remove(path);
    mem_free(path);
}

/* A finished run with a larger budget: of pt the same bits as a run of that budget, of
 * chains a picture of as many paths. */
static void test_larger_budget(void **state)
{
    (void)state;
    static const char *const integrators[] = {"integrator=pt", "integrator=bdpt",
                                              "integrator=mmlt"};
    struct scene *scene = test_scene(TEST_POINT, false);
    char *path = test_file("larger");
    for (int i = 0; i < 3; i++) {
        const char *const words[] = {"mutations_per_pixel=30", "bootstrap=1000",
                                     integrators[i], NULL};
        struct leg leg = first_leg(scene, words, path);
        struct run_result r = run_leg(&leg);
        run_result_deinit(&r);
        leg.resume = true;
        leg.settings.mutations_per_pixel = 50.0;
        r = run_leg(&leg);
        struct run_result whole = test_run(scene, &leg.settings);
        assert_true(r.statistics.paths == whole.statistics.paths);
        if (i < 2)
            assert_same_picture(r.image, whole.image);
        run_result_deinit(&whole);
        run_result_deinit(&r);
        /* And once more, up to what it has: that is not a sample more. */
        leg.settings.mutations_per_pixel = 50.0;
        r = run_leg(&leg);
        assert_true(r.mutations_per_pixel <= 50.0 + 1e-9);
        run_result_deinit(&r);
        identity_deinit(&leg.identity);
    }
    scene_destroy(scene);
    remove(path);
    mem_free(path);
}

/* Seconds go on from those that were used. */
static void test_seconds(void **state)
{
    (void)state;
    const char *const words[] = {"seconds=1000", "integrator=pt", NULL};
    struct scene *scene = test_scene(TEST_POINT, false);
    char *path = test_file("seconds");
    struct leg leg = first_leg(scene, words, path);
    leg.stopped = leg.stopper.waits = true;
    struct run_result r = run_leg(&leg);
    double used = r.seconds_total, paths = r.statistics.paths;
    assert_true(r.interrupted && paths > 0.0);
    run_result_deinit(&r);
    leg.resume = true;
    leg.stopped = false;
    leg.settings.seconds = used + 0.05;
    double begin = clock_wall();
    r = run_leg(&leg);
    assert_true(r.seconds_total >= used + 0.05 && !r.interrupted);
    assert_true(r.seconds_total <= used + (clock_wall() - begin));
    assert_true(r.statistics.paths > paths);
    run_result_deinit(&r);
    identity_deinit(&leg.identity);
    scene_destroy(scene);
    remove(path);
    mem_free(path);
}

/* A checkpoint that cannot be written ends the run, which gives what it has. */
static void test_no_room(void **state)
{
    (void)state;
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=30", NULL};
    struct scene *scene = test_scene(TEST_POINT, false);
    struct settings s = test_settings(words);
    struct identity none = {0};
    struct checkpoint_options writing = {.path = "/nonexistent/x", .identity = &none};
    struct run_options options = {.scene = scene, .settings = &s, .checkpoint = &writing};
    struct run_result r = {0};
    struct err err = {0};
    assert_false(run_render(&options, &r, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_non_null(r.image);
    assert_true(r.statistics.paths == 256.0 && r.statistics.b > 0.0);
    run_result_deinit(&r);
    scene_destroy(scene);
}

/* --- what is refused -------------------------------------------------------------- */

static void assert_refused(const char *path, const struct identity *identity,
                           const struct settings *settings, const char *why)
{
    struct checkpoint checkpoint;
    struct err err = {0};
    assert_false(checkpoint_open(&checkpoint, path, identity, settings,
                                 (struct run_part){0}, &err));
    assert_null(checkpoint.pack);
    assert_string_equal(err.file, path);
    if (strstr(err.message, why) == NULL)
        fail_msg("'%s' lacks '%s'", err.message, why);
}

static void write_head(const char *path, const struct identity *identity,
                       const struct checkpoint_head *head)
{
    struct err err = {0};
    struct checkpoint_options options = {.path = path, .identity = identity};
    struct pack *pack = checkpoint_create(&options, head, &err);
    assert_non_null(pack);
    assert_true(pack_close(pack, &err));
}

static void test_other_identity(void **state)
{
    (void)state;
    char *path = test_file("identity");
    const char *const words[] = {"mutations_per_pixel=30", NULL};
    struct settings s = test_settings(words);
    struct checkpoint_head head = {.budget_mutations = 30.0};
    struct identity a = {0}, b = {0};
    identity_add(&a, "commit", "abc");
    identity_add(&a, "size", "8x8");
    identity_add(&b, "commit", "abd");
    identity_add(&b, "size", "8x9");
    identity_add(&b, "colour", "red");
    write_head(path, &a, &head);
    assert_refused(
        path, &b, &s,
        "commit: the checkpoint was made with abc, this run has abd; size: the "
        "checkpoint was made with 8x8, this run has 8x9; colour: the "
        "checkpoint was made with none, this run has red");
    struct checkpoint checkpoint;
    struct err err = {0};
    assert_true(checkpoint_open(&checkpoint, path, &a, &s, (struct run_part){0}, &err));
    pack_destroy(checkpoint.pack);
    identity_deinit(&a);
    identity_deinit(&b);
    remove(path);
    mem_free(path);
}

static void test_other_budgets(void **state)
{
    (void)state;
    char *path = test_file("budgets");
    const char *const words[] = {"mutations_per_pixel=30", NULL};
    struct settings s = test_settings(words);
    struct identity none = {0};
    struct checkpoint_head head = {
        .budget_mutations = 64.0, .seconds = 8.0, .mutations = 31.0};
    write_head(path, &none, &head);
    assert_refused(path, &none, &s, "made with mutations_per_pixel=64, and its measured");
    head.started = true;
    write_head(path, &none, &head);
    assert_refused(path, &none, &s,
                   "has made 31 mutations per pixel, this run has "
                   "mutations_per_pixel=30: give more");
    s.mutations_per_pixel = 0.0;
    s.seconds = 7.0;
    assert_refused(path, &none, &s, "has taken 8 seconds, this run has seconds=7");
    s.seconds = 9.0;
    struct checkpoint checkpoint;
    struct err err = {0};
    assert_true(
        checkpoint_open(&checkpoint, path, &none, &s, (struct run_part){0}, &err));
    assert_true(checkpoint.other_budget);
    pack_destroy(checkpoint.pack);
    remove(path);
    mem_free(path);
}

/* --- damage ----------------------------------------------------------------------- */

/* With the hash made good again, so that the readers themselves meet what cannot be: they
 * may take it or refuse it, but not stumble. */
static void try_mended(const char *path, char *bytes, size_t size,
                       const struct integrator_type *type, const struct scene *scene,
                       const struct settings *settings)
{
    struct hash hash;
    struct err err = {0};
    hash_init(&hash);
    hash_words(&hash, bytes, size / 8 - 1);
    memcpy(bytes + size - 8, &hash.value, 8);
    assert_true(text_write_file(path, bytes, size, &err));
    struct pack *pack = pack_open(path, CHECKPOINT_LAYOUT, &err);
    if (pack == NULL)
        return;
    void *integrator = type->methods->create(type, scene, settings);
    type->methods->pack(integrator, pack);
    pack_close(pack, &err);
    type->methods->destroy(integrator);
}

static void try_damage(const struct scene *scene, const char *integrator_word)
{
    const char *const words[] = {"mutations_per_pixel=30", "chains=4",
                                 "bootstrap=200",          "max_depth=3",
                                 integrator_word,          NULL};
    struct settings s = test_settings(words);
    const struct integrator_type *type = integrator_find(s.integrator);
    char *path = test_file("damage");
    struct err err = {0};
    size_t size;
    void *integrator = type->methods->create(type, scene, &s);
    advance(type, integrator, 2);
    struct pack *pack = pack_create(path, CHECKPOINT_LAYOUT, &err);
    type->methods->pack(integrator, pack);
    assert_true(pack_close(pack, &err));
    type->methods->destroy(integrator);
    char *bytes = text_read_file(path, &size, NULL, &err);
    for (size_t i = 0; i < 50; i++) {
        assert_true(text_write_file(path, bytes, size * i / 50, &err));
        assert_null(pack_open(path, CHECKPOINT_LAYOUT, NULL));
    }
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int i = 0; i < 300; i++) {
        size_t at = (size_t)(rng_double(&rng) * (double)size);
        char kept = bytes[at], hash[8];
        memcpy(hash, bytes + size - 8, 8);
        bytes[at] = (char)(bytes[at] ^ (1 << rng_u64(&rng) % 8));
        assert_true(text_write_file(path, bytes, size, &err));
        assert_null(pack_open(path, CHECKPOINT_LAYOUT, NULL));
        try_mended(path, bytes, size, type, scene, &s);
        memcpy(bytes + size - 8, hash, 8);
        bytes[at] = kept;
    }
    mem_free(bytes);
    remove(path);
    mem_free(path);
}

static void test_damage(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 3);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    try_damage(scene, "integrator=pssmlt");
    try_damage(scene, "integrator=pfmlt");
    try_damage(scene, "integrator=bdpt");
    scene_destroy(scene);
}

/* State of another integrator, or of as many chains but another size. */
static void test_foreign_state(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    char *path = test_file("foreign");
    static const char *const pairs[][2] = {
        {"integrator=pt", "integrator=pssmlt"},
        {"integrator=mmlt", "integrator=pssmlt"},
        {"chains=20", "chains=21"},
        {"max_depth=3", "max_depth=4"},
        {"integrator=bdpt", "integrator=pt"},
        {"kernel=gaussian", "integrator=mmlt"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        struct err err = {0};
        const char *const a[] = {"bootstrap=200", pairs[i][0], NULL};
        const char *const b[] = {"bootstrap=200", pairs[i][1], NULL};
        struct settings from = test_settings(a), to = test_settings(b);
        const struct integrator_type *type = integrator_find(from.integrator);
        void *integrator = type->methods->create(type, scene, &from);
        advance(type, integrator, 2);
        struct pack *pack = pack_create(path, CHECKPOINT_LAYOUT, &err);
        type->methods->pack(integrator, pack);
        assert_true(pack_close(pack, &err));
        type->methods->destroy(integrator);
        type = integrator_find(to.integrator);
        integrator = type->methods->create(type, scene, &to);
        pack = pack_open(path, CHECKPOINT_LAYOUT, &err);
        type->methods->pack(integrator, pack);
        assert_false(pack_close(pack, &err));
        assert_non_null(strstr(err.message, "no state that a run can be in"));
        type->methods->destroy(integrator);
    }
    scene_destroy(scene);
    remove(path);
    mem_free(path);
}

/* An identity has as many entries as settings have rows; none may be lost. */
static void test_large_identity(void **state)
{
    (void)state;
    struct identity identity = {0};
    char names[100][8];
    for (int i = 0; i < 100; i++) {
        snprintf(names[i], sizeof names[i], "n%d", i);
        identity_add(&identity, names[i], "%d", 3 * i);
    }
    for (int i = 0; i < 100; i++) {
        char value[8];
        snprintf(value, sizeof value, "%d", 3 * i);
        assert_string_equal(identity_find(&identity, names[i]), value);
    }
    identity_deinit(&identity);
}

int main(int argc, char **argv)
{
    (void)argc;
    libraries_prepare(argv); /* small rounds of three threads: else they mostly spin */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts),          cmocka_unit_test(test_long_start),
        cmocka_unit_test(test_dark),          cmocka_unit_test(test_nonfinite),
        cmocka_unit_test(test_shared_films),  cmocka_unit_test(test_many_legs),
        cmocka_unit_test(test_larger_budget), cmocka_unit_test(test_seconds),
        cmocka_unit_test(test_no_room),       cmocka_unit_test(test_other_identity),
        cmocka_unit_test(test_other_budgets), cmocka_unit_test(test_damage),
        cmocka_unit_test(test_foreign_state), cmocka_unit_test(test_large_identity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
