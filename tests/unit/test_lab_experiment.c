/* lab/experiment and lab/jobs: what a file says, the product and its order, names, ids,
 * and errors with their places. */
#include "lab/experiment.h"

#include "base/mem.h"
#include "base/text.h"
#include "lab/jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* A folder with what the scenes' fingerprints are taken of. */
struct place_of_work {
    char folder[64], file[96];
};

static void write_in(const struct place_of_work *w, const char *name, const char *text)
{
    struct err err = {0};
    char *path = text_format("%s/%s", w->folder, name);
    assert_true(text_write_file(path, text, strlen(text), &err));
    mem_free(path);
}

static int set_up(void **state)
{
    struct place_of_work *w = mem_alloc(1, sizeof *w);
    strcpy(w->folder, "/tmp/etalon_experiment_XXXXXX");
    assert_non_null(mkdtemp(w->folder));
    snprintf(w->file, sizeof w->file, "%s/e.yaml", w->folder);
    write_in(w, "a.yaml", "shapes: [{file: \"a mesh.ply\"}]\n");
    write_in(w, "a mesh.ply", "a mesh");
    write_in(w, "b.pbrt", "Include \"c.pbrt\"\n");
    write_in(w, "c.pbrt", "# nothing\n");
    write_in(w, "r.exr", "a picture");
    *state = w;
    return 0;
}

static int tear_down(void **state)
{
    static const char *const names[] = {"a.yaml", "a mesh.ply", "b.pbrt", "c.pbrt",
                                        "r.exr",  "e.yaml",     NULL};
    struct place_of_work *w = *state;
    for (int i = 0; names[i]; i++) {
        char *path = text_format("%s/%s", w->folder, names[i]);
        unlink(path);
        mem_free(path);
    }
    rmdir(w->folder);
    mem_free(w);
    return 0;
}

static struct experiment *load(const struct place_of_work *w, const char *text,
                               struct err *err)
{
    write_in(w, "e.yaml", text);
    return experiment_load(w->file, err);
}

struct batch {
    struct experiment *experiment;
    struct jobs jobs;
};

static struct batch make(const struct place_of_work *w, const char *text)
{
    struct err err = {0};
    struct batch b = {.experiment = load(w, text, &err)};
    if (b.experiment == NULL || !jobs_make(b.experiment, &b.jobs, &err))
        fail_msg("%d:%d: %s", err.line, err.col, err.message);
    return b;
}

static void release(struct batch *b)
{
    jobs_deinit(&b->jobs);
    experiment_destroy(b->experiment);
}

static void check_names(const struct batch *b, const char *const *names)
{
    for (size_t i = 0; i < b->jobs.count; i++) {
        assert_non_null(names[i]);
        assert_string_equal(b->jobs.items[i].name, names[i]);
    }
    assert_null(names[b->jobs.count]);
}

/* Seed, scene, then settings; variants keep their own; sizes are not torn apart. */
static void product_and_order(void **state)
{
    static const char *const names[] = {
        "a pt size=8x8 seed=1",
        "a chains p_l=auto size=8x8 seed=1",
        "a chains p_l=0.5 size=8x8 seed=1",
        "a pt size=9x9 seed=1",
        "a chains p_l=auto size=9x9 seed=1",
        "a chains p_l=0.5 size=9x9 seed=1",
        "other pt 2.5s seed=1",
        "other pt mpp=64 seed=1",
        "other chains p_l=auto 2.5s seed=1",
        "other chains p_l=auto mpp=64 seed=1",
        "other chains p_l=0.5 2.5s seed=1",
        "other chains p_l=0.5 mpp=64 seed=1",
        "a pt size=8x8 seed=7",
        "a chains p_l=auto size=8x8 seed=7",
        "a chains p_l=0.5 size=8x8 seed=7",
        "a pt size=9x9 seed=7",
        "a chains p_l=auto size=9x9 seed=7",
        "a chains p_l=0.5 size=9x9 seed=7",
        "other pt 2.5s seed=7",
        "other pt mpp=64 seed=7",
        "other chains p_l=auto 2.5s seed=7",
        "other chains p_l=auto mpp=64 seed=7",
        "other chains p_l=0.5 2.5s seed=7",
        "other chains p_l=0.5 mpp=64 seed=7",
        NULL,
    };
    struct batch b = make(
        *state,
        "experiment: e\n"
        "scenes:\n"
        "  - a.yaml\n"
        "  - {scene: b.pbrt, label: other, size: 8x8,\n"
        "     budget: [{seconds: 2.5}, {mutations_per_pixel: 64}]}\n"
        "integrators:\n"
        "  - pt\n"
        "  - {integrator: pssmlt, label: chains, large_step_probability: [auto, 0.5]}\n"
        "size: [8x8, 9x9]\n"
        "seeds: [1, 7]\n");
    check_names(&b, names);
    release(&b);
}

static void nearer_settings_count(void **state)
{
    struct batch b = make(*state, "experiment: e\n"
                                  "scenes: [{scene: a.yaml, chains: 30, max_depth: 5}]\n"
                                  "integrators: [{integrator: pssmlt, chains: 40}]\n"
                                  "chains: 20\n"
                                  "max_depth: 4\n"
                                  "sigma: 0.5\n"
                                  "budget: {mutations_per_pixel: 3}\n"
                                  "seeds: [9]\n");
    struct settings s;
    struct err err = {0};
    settings_init(&s);
    assert_int_equal(b.jobs.count, 1);
    assert_true(job_settings(&b.jobs.items[0], &s, &err));
    assert_string_equal(s.integrator, "pssmlt");
    assert_int_equal(s.chains, 40);
    assert_int_equal(s.max_depth, 5);
    assert_true(s.sigma == 0.5 && s.mutations_per_pixel == 3.0 && s.seconds == 0.0);
    assert_int_equal(s.seed, 9);
    assert_string_equal(b.jobs.items[0].label, "pssmlt chains=40");
    release(&b);
}

static void seeds_are_counted_from_one(void **state)
{
    struct batch b = make(*state, "experiment: e\nscenes: [a.yaml]\nintegrators: [pt]\n"
                                  "seeds: 3\n");
    check_names(&b,
                (const char *const[]){"a pt seed=1", "a pt seed=2", "a pt seed=3", NULL});
    release(&b);
}

static void references(void **state)
{
    const struct place_of_work *w = *state;
    struct batch b = make(w, "experiment: e\n"
                             "scenes: [a.yaml, {scene: b.pbrt, reference: r.exr},\n"
                             "  {scene: b.pbrt, label: c, reference: none}]\n"
                             "integrators: [pt]\n"
                             "reference: {integrator: bdpt, seconds: 60}\n");
    const struct reference_spec *of[3];
    for (int i = 0; i < 3; i++)
        of[i] = b.jobs.items[i].reference;
    assert_int_equal(of[0]->kind, REFERENCE_RENDERED);
    assert_string_equal(axes_find(&of[0]->settings, "budget")->choices[0].value, "60");
    assert_int_equal(of[1]->kind, REFERENCE_FILE);
    char *path = text_format("%s/r.exr", w->folder);
    assert_string_equal(of[1]->file, path);
    assert_int_equal(of[2]->kind, REFERENCE_NONE);
    mem_free(path);
    release(&b);
}

/* --- ids ------------------------------------------------------------------------- */

static void id_of(const struct place_of_work *w, const char *scene, const char *rest,
                  char id[HASH_DIGITS + 1])
{
    char *text = text_format("experiment: e\nscenes: [%s]\nintegrators: [pssmlt]\n%s",
                             scene, rest);
    struct batch b = make(w, text);
    assert_int_equal(b.jobs.count, 1);
    strcpy(id, b.jobs.items[0].id);
    release(&b);
    mem_free(text);
}

static void check_id(const struct place_of_work *w, const char *scene, const char *first,
                     const char *second, bool same)
{
    char a[HASH_DIGITS + 1], b[HASH_DIGITS + 1];
    id_of(w, scene, first, a);
    id_of(w, scene, second, b);
    if (text_equal(a, b) != same)
        fail_msg("'%s' and '%s' make %s id", first, second,
                 same ? "another" : "the same");
}

static void ids_tell_what_matters(void **state)
{
    check_id(*state, "a.yaml", "chains: 8\nsigma: 0.1\n", "sigma: 1e-1\nchains: 8\n",
             true);
    check_id(*state, "a.yaml", "description: x\n", "description: y\n", true);
    check_id(*state, "a.yaml", "chains: 8\n", "chains: 9\n", false);
    check_id(*state, "a.yaml", "seeds: [1]\n", "seeds: [2]\n", false);
    check_id(*state, "a.yaml", "budget: {seconds: 8}\n",
             "budget: {mutations_per_pixel: 8}\n", false);
    check_id(*state, "a.yaml", "", "reference: r.exr\n", false);
    check_id(*state, "a.yaml", "reference: {integrator: pt, seconds: 1}\n",
             "reference: {integrator: bdpt, seconds: 1}\n", false);
}

static void ids_tell_the_content_of_files(void **state)
{
    static const struct {
        const char *scene, *file;
    } cases[] = {
        {"a.yaml", "a.yaml"},
        {"a.yaml", "a mesh.ply"},
        {"b.pbrt", "c.pbrt"},
        {"b.pbrt", "r.exr"}, /* as the reference */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char before[HASH_DIGITS + 1], after[HASH_DIGITS + 1];
        id_of(*state, cases[i].scene, "reference: r.exr\n", before);
        write_in(*state, cases[i].file, "# something else, \"a mesh.ply\"\n");
        id_of(*state, cases[i].scene, "reference: r.exr\n", after);
        assert_string_not_equal(before, after);
    }
}

/* Of both seeds of it. */
static void cell_of(const struct place_of_work *w, const char *scene, const char *rest,
                    char cell[HASH_DIGITS + 1])
{
    char *text = text_format("experiment: e\nscenes: [%s]\nintegrators: [pssmlt]\n"
                             "seeds: 2\n%s",
                             scene, rest);
    struct batch b = make(w, text);
    assert_int_equal(b.jobs.count, 2);
    assert_string_equal(b.jobs.items[0].cell, b.jobs.items[1].cell);
    strcpy(cell, b.jobs.items[0].cell);
    release(&b);
    mem_free(text);
}

static void cells_tell_all_but_seed_and_path(void **state)
{
    char plain[HASH_DIGITS + 1], other[HASH_DIGITS + 1];
    cell_of(*state, "a.yaml", "", plain);
    cell_of(*state, "./a.yaml", "", other);
    assert_string_equal(plain, other);
    cell_of(*state, "a.yaml", "chains: 8\n", other);
    assert_string_not_equal(plain, other);
    cell_of(*state, "a.yaml", "reference: r.exr\n", other);
    assert_string_not_equal(plain, other);
    write_in(*state, "a.yaml", "# something else\n");
    cell_of(*state, "a.yaml", "", other);
    assert_string_not_equal(plain, other);
}

static void patterns(void **state)
{
    struct batch b = make(*state, "experiment: e\nscenes: [a.yaml]\nintegrators: [pt]\n");
    const struct job *job = &b.jobs.items[0]; /* "a pt seed=1" */
    assert_true(job_matches(job, "pt"));
    assert_true(job_matches(job, "a *seed=1"));
    assert_true(job_matches(job, "a [p]t*"));
    assert_false(job_matches(job, "bdpt"));
    assert_false(job_matches(job, "*pt"));
    release(&b);
}

/* --- errors ---------------------------------------------------------------------- */

struct bad {
    int line, col;
    const char *message, *text;
};

#define HEAD "experiment: e\nscenes: [a.yaml]\nintegrators: [pt]\n"

static const struct bad bad[] = {
    {4, 1, "unknown key 'seed' (did you mean 'seeds'?); allowed: experiment,",
     HEAD "seed: 3\n"},
    {4, 1, "unknown key 'integrator' (did you mean 'integrators'?)",
     HEAD "integrator: pt\n"},
    {4, 1, "unknown key 'kernal' (did you mean 'kernel'?)", HEAD "kernal: gaussian\n"},
    {4, 10, "kernel: 'box'", HEAD "kernel: [box]\n"},
    {4, 9, "chains is empty", HEAD "chains: []\n"},
    {4, 9, "expected text, got a map", HEAD "chains: {a: 1}\n"},
    {4, 8, "expected text, got nothing", HEAD "chains:\n"},
    {4, 10, "unknown key 'minutes'", HEAD "budget: {minutes: 3}\n"},
    {4, 19, "seconds: '-3'", HEAD "budget: {seconds: -3}\n"},
    {5, 1, "'seconds' is a second budget", HEAD "budget: {seconds: 3}\nseconds: 4\n"},
    {4, 8, "seeds: 0 is not possible", HEAD "seeds: 0\n"},
    {4, 8, "expected a whole number", HEAD "seeds: two\n"},
    {4, 9, "seed: '-2'", HEAD "seeds: [-2]\n"},
    {4, 12, "needs a budget", HEAD "reference: {integrator: bdpt}\n"},
    {4, 13, "unknown key 'size'", HEAD "reference: {size: 8x8}\n"},
    {4, 12, "a file or is rendered", HEAD "reference: {file: r.exr, seconds: 3}\n"},
    {4, 26, "one value of each setting", HEAD "reference: {seconds: [3, 4]}\n"},
    {1, 1, "'experiment' is missing", "scenes: [a.yaml]\nintegrators: [pt]\n"},
    {1, 13, "'a/b' is to name a folder",
     "experiment: a/b\nscenes: [a.yaml]\nintegrators: [pt]\n"},
    {1, 13, "not 'references'",
     "experiment: references\nscenes: [a.yaml]\nintegrators: [pt]\n"},
    {1, 1, "'scenes' is missing", "experiment: e\nintegrators: [pt]\n"},
    {2, 9, "scenes: expected a list", "experiment: e\nscenes: []\nintegrators: [pt]\n"},
    {2, 11, "unknown key 'scen' (did you mean 'scene'?)",
     "experiment: e\nscenes: [{scen: a.yaml}]\nintegrators: [pt]\n"},
    {2, 10, "'scene' is missing",
     "experiment: e\nscenes: [{label: x}]\nintegrators: [pt]\n"},
    {2, 18, "two scenes are called 'a'",
     "experiment: e\nscenes: [a.yaml, x/a.yaml]\nintegrators: [pt]\n"},
    {3, 15, "integrator: 'ptt'", "experiment: e\nscenes: [a.yaml]\nintegrators: [ptt]\n"},
    {3, 15, "'integrator' is missing",
     "experiment: e\nscenes: [a.yaml]\nintegrators: [{label: x}]\n"},
};

static void errors_name_their_places(void **state)
{
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct err err = {0};
        struct experiment *e = load(*state, bad[i].text, &err);
        if (e != NULL)
            fail_msg("accepted:\n%s", bad[i].text);
        if (strstr(err.message, bad[i].message) == NULL || err.line != bad[i].line ||
            err.col != bad[i].col)
            fail_msg("expected %d:%d: %s\ngot %d:%d: %s", bad[i].line, bad[i].col,
                     bad[i].message, err.line, err.col, err.message);
    }
}

static const struct bad bad_jobs[] = {
    {1, 1, "two jobs are the same: 'a pt seed=1' and 'a pt seed=1'",
     "experiment: e\nscenes: [a.yaml]\nintegrators: [pt, pt]\n"},
    {1, 1, "two jobs are the same", HEAD "seeds: [2, 2]\n"},
    {1, 1, "two jobs are called 'a x seed=1'",
     "experiment: e\nscenes: [a.yaml]\n"
     "integrators: [{integrator: pt, label: x}, {integrator: bdpt, label: x}]\n"},
    {2, 10, "cannot open", "experiment: e\nscenes: [no.yaml]\nintegrators: [pt]\n"},
    {4, 12, "cannot open", HEAD "reference: no.exr\n"},
    {1, 1, "more than 100000 jobs", HEAD "seeds: 100000\nkeep_all: [true, false]\n"},
    {2, 10, "a pt: s1 (0.5) must be less than s2", HEAD "s1: 0.5\n"},
};

static void jobs_that_cannot_be(void **state)
{
    for (size_t i = 0; i < sizeof bad_jobs / sizeof bad_jobs[0]; i++) {
        struct err err = {0};
        struct jobs jobs;
        struct experiment *e = load(*state, bad_jobs[i].text, &err);
        assert_non_null(e);
        assert_false(jobs_make(e, &jobs, &err));
        if (strstr(err.message, bad_jobs[i].message) == NULL ||
            err.line != bad_jobs[i].line || err.col != bad_jobs[i].col)
            fail_msg("expected %d:%d: %s\ngot %d:%d: %s", bad_jobs[i].line,
                     bad_jobs[i].col, bad_jobs[i].message, err.line, err.col,
                     err.message);
        jobs_deinit(&jobs);
        experiment_destroy(e);
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(product_and_order),
        TEST(nearer_settings_count),
        TEST(seeds_are_counted_from_one),
        TEST(references),
        TEST(ids_tell_what_matters),
        TEST(ids_tell_the_content_of_files),
        TEST(cells_tell_all_but_seed_and_path),
        TEST(patterns),
        TEST(errors_name_their_places),
        TEST(jobs_that_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
