/* A path as a list of vertices (path/full_path.h): its f / p against what bidirectional
 * path tracing says of the same path: weight times contribution over the probability of
 * its technique, in all kinds of scenes, for 100,000 paths. The two share BSDFs and the
 * walks that made the path; the one is a recurrence of ratios while the path grows, the
 * other a product over the finished list with the densities of all techniques summed.
 *
 * No path may differ by more than ERROR, so one wrong factor in a single path is seen. */

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "path/connect.h"
#include "path/full_path.h"
#include "support/water_scene.h"

#define DEPTH 7
#define PATHS 50000 /* drawn in each scene; about a fifth carry light */
#define LEAST 100000

/* Directions and places are floats: relative errors of 1e-6 in each, times the steepness
 * of a density (up to 1e2). 1.3e-5 is the worst seen. */
#define ERROR 2e-4

struct tried {
    long paths, with_delta;
    double worst;
};

/* Any number of [0,1), again and again, for the technique; others from the generator. */
struct fixed {
    struct ustream stream; /* must be first */
    double u;
};

static const double *take(struct ustream *self, int place, int count)
{
    (void)place, (void)count;
    return &((struct fixed *)self)->u;
}

/* The length and technique that full_path_sample picks by u. */
static double technique_of(const struct path_space *space, double u, int *k, int *t)
{
    const struct techniques *techniques;
    double below = 0.0;
    for (*k = 1; *k < DEPTH && u >= below + space->length_pdf[*k]; ++*k)
        below += space->length_pdf[*k];
    techniques = &space->techniques[*k];
    u = (u - below) / space->length_pdf[*k];
    *t = techniques->t[(int)(u * techniques->count)];
    return space->length_pdf[*k] / techniques->count;
}

static bool has_delta(const struct full_path *path)
{
    for (int i = 1; i < path->edges; i++)
        if (path->x[i].delta)
            return true;
    return false;
}

/* One path, and the same numbers again through the technique alone. */
static void compare(struct path_space *space, uint64_t index, struct contrib *out,
                    struct tried *tried)
{
    struct rng rng;
    struct ustream_random random;
    struct connection x;
    struct vertex point;
    int k, t;
    rng_init(&rng, 7, RNG_TEST, index);
    ustream_random_init(&random, &rng);
    struct fixed fixed = {{take}, rng_double(&rng)};
    struct rng begin = rng;
    struct numbers numbers = {&random.stream, &random.stream, &fixed.stream};
    full_path_sample(space, &numbers, out);
    rng = begin;
    double probability = technique_of(space, fixed.u, &k, &t), bdpt = 0.0;
    if (estimate_technique(&space->paths, &numbers, k + 1 - t, t, &x, &point) ==
        FAILURE_NONE)
        bdpt = rgb_luminance(x.value) * x.weight / probability;
    assert_true((bdpt > 0.0) == (out->target > 0.0));
    if (!(bdpt > 0.0))
        return;
    tried->paths++;
    tried->with_delta += has_delta(&space->sampled);
    tried->worst = fmax(tried->worst, fabs(out->target / bdpt - 1.0));
    assert_int_equal(out->splats[0].pixel, x.pixel);
}

static void lists_are_paths_of_bdpt(void **state)
{
    (void)state;
    long all = 0;
    for (int c = 0; c <= TEST_CONTENTS; c++) {
        bool water = c == TEST_CONTENTS;
        struct scene *scene = water ? water_scene(false)
                                    : test_scene((enum test_contents)c, false);
        struct path_space space;
        struct contrib out;
        struct tried tried = {0};
        path_space_init(&space, scene, 1, DEPTH);
        contrib_init(&out, 1);
        for (int i = 0; i < PATHS; i++)
            compare(&space, (uint64_t)c << 32 | (uint64_t)i, &out, &tried);
        printf("%s: %ld paths, %ld with delta events, worst difference %.1e\n",
               water ? "water" : test_contents_name[c], tried.paths, tried.with_delta,
               tried.worst);
        assert_true(tried.worst < ERROR);
        assert_int_equal(out.nonfinite, 0);
        if (c == TEST_GLASS || c == TEST_SKYGLASS || c == TEST_PANES || water)
            assert_true(tried.with_delta > 300);
        all += tried.paths;
        contrib_deinit(&out);
        path_space_deinit(&space);
        scene_destroy(scene);
    }
    printf("%ld paths\n", all);
    assert_true(all >= LEAST);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lists_are_paths_of_bdpt)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
