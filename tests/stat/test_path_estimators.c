/* Estimators against each other: every technique (s,t) by itself estimates the same
 * integral over paths of its length; bdpt's sum equals pt's; multiplexed paths of a
 * length equal bdpt's of that length; leaving out what a scene does not need changes
 * nothing. */

#include "math/accum.h"
#include "path/connect.h"
#include "path/estimate.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>

#define FALSE_ALARM 1e-4 /* of each test function as a whole */

/* Figures gathered in batches, whose means are close to normal. */
#define BATCHES 50
#define CELLS   64

struct cells {
    struct welford batch[CELLS]; /* over batches */
    double sum[CELLS];           /* of the running batch */
};

static void close_batch(struct cells *c, double samples)
{
    for (int i = 0; i < CELLS; i++)
        welford_add(&c->batch[i], c->sum[i] / samples);
    memset(c->sum, 0, sizeof c->sum);
}

/* --- every technique by itself ---------------------------------------------------- */

#define TECHNIQUE_DEPTH 4

static int technique_cell(int s, int t)
{
    return s * 8 + t;
}

static void add_technique(struct cells *c, const struct connection *x, int s, int t)
{
    c->sum[technique_cell(s, t)] += rgb_luminance(x->value);
}

static void add_all_techniques(struct cells *c, struct subpaths *p, struct rng *rng)
{
    struct connection x;
    for (int t = 2; t <= p->camera_count; t++) {
        const struct vertex *z = &p->camera[t - 1];
        double u[3] = {rng_double(rng), rng_double(rng), rng_double(rng)};
        if (connect_hit(p, z, t - 1, MIS_BIDIRECTIONAL, &x) == FAILURE_NONE)
            add_technique(c, &x, 0, t);
        if (z->connectible &&
            connect_light(p, u, z, MIS_BIDIRECTIONAL, &x, NULL) == FAILURE_NONE)
            add_technique(c, &x, 1, t);
        for (int s = 2; s <= p->light_count && s + t - 1 <= TECHNIQUE_DEPTH; s++)
            if (z->connectible && p->light[s - 1].connectible &&
                connect_surfaces(p, &p->light[s - 1], z, &x) == FAILURE_NONE)
                add_technique(c, &x, s, t);
    }
    for (int s = 2; s <= p->light_count; s++)
        if (p->light[s - 1].connectible &&
            connect_camera(p, &p->light[s - 1], &x) == FAILURE_NONE)
            add_technique(c, &x, s, 1);
}

static void gather_techniques(const struct scene *scene, struct cells *c, long paths)
{
    struct subpaths p;
    struct rng rng;
    struct ustream_random numbers;
    rng_init(&rng, 11, RNG_TEST, 0);
    ustream_random_init(&numbers, &rng);
    subpaths_init(&p, scene, TECHNIQUE_DEPTH);
    for (int batch = 0; batch < BATCHES; batch++) {
        for (long i = 0; i < paths / BATCHES; i++) {
            walk_camera(&p, &numbers.stream, TECHNIQUE_DEPTH + 1, HIT_ANY);
            walk_light(&p, &numbers.stream, TECHNIQUE_DEPTH, HIT_ANY);
            add_all_techniques(c, &p, &rng);
        }
        close_batch(c, (double)(paths / BATCHES));
    }
    subpaths_deinit(&p);
}

/* Each technique of length k against next-event estimation (1,k). */
static void compare_techniques(const char *name, const struct cells *c)
{
    int tests = 0;
    for (int k = 2; k <= TECHNIQUE_DEPTH; k++)
        tests += k;
    double level = stat_sidak(FALSE_ALARM, tests);
    for (int k = 2; k <= TECHNIQUE_DEPTH; k++) {
        const struct welford *ref = &c->batch[technique_cell(1, k)];
        for (int s = 0; s <= k; s++) {
            const struct welford *w = &c->batch[technique_cell(s, k + 1 - s)];
            double se = hypot(welford_se(w), welford_se(ref));
            double z = s == 1 ? 0.0 : (w->mean - ref->mean) / se;
            printf("%s k %d (%d,%d): %.6f +- %.6f, z %.2f\n", name, k, s, k + 1 - s,
                   w->mean, welford_se(w), z);
            assert_true(w->mean > 0.0);
            assert_true(stat_ok(name, stat_t_p(z, BATCHES - 1), level));
        }
    }
}

static void test_techniques(void **state)
{
    (void)state;
    /* Delta scenes lack techniques; these have them all. */
    static const enum test_contents with_all[] = {TEST_DIFFUSE,  TEST_ROUGH,
                                                  TEST_SMOOTH,   TEST_SKY,
                                                  TEST_PARALLEL, TEST_PARALLEL_LENS};
    long paths = getenv("ETALON_LONG") ? 4000000 : 400000;
    for (int i = 0; i < (int)(sizeof with_all / sizeof with_all[0]); i++) {
        struct scene *scene = test_scene(with_all[i], false);
        struct cells *c = calloc(1, sizeof *c);
        gather_techniques(scene, c, paths);
        compare_techniques(test_contents_name[with_all[i]], c);
        free(c);
        scene_destroy(scene);
    }
}

/* --- whole estimators ------------------------------------------------------------- */

typedef void (*estimate_function)(struct subpaths *paths, const struct numbers *numbers,
                                  struct contrib *out);

/* 4 x 4 blocks of the 16 x 16 film, three channels, and the luminance of all. */
static void gather_blocks(const struct scene *scene, estimate_function estimate,
                          int stream, int depth, long paths, struct cells *c)
{
    struct subpaths p;
    struct rng rng;
    struct ustream_random u;
    struct contrib out;
    rng_init(&rng, 12, RNG_TEST, (uint64_t)stream);
    ustream_random_init(&u, &rng);
    subpaths_init(&p, scene, depth);
    contrib_init(&out, estimate_splats(depth));
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    for (int batch = 0; batch < BATCHES; batch++) {
        for (long i = 0; i < paths / BATCHES; i++) {
            estimate(&p, &numbers, &out);
            for (int j = 0; j < out.count; j++) {
                int pixel = out.splats[j].pixel;
                double *sum = &c->sum[3 * (pixel / 64 * 4 + pixel % 16 / 4)];
                sum[0] += out.splats[j].value.r;
                sum[1] += out.splats[j].value.g;
                sum[2] += out.splats[j].value.b;
            }
            c->sum[48] += out.target;
        }
        close_batch(c, (double)(paths / BATCHES));
    }
    assert_int_equal(out.nonfinite, 0);
    contrib_deinit(&out);
    subpaths_deinit(&p);
}

static void compare_blocks(const char *name, const struct cells *a, const struct cells *b,
                           int comparisons)
{
    double level = stat_sidak(FALSE_ALARM, 49 * comparisons);
    double worst = 0.0;
    for (int i = 0; i < 49; i++) {
        double se = hypot(welford_se(&a->batch[i]), welford_se(&b->batch[i]));
        double difference = a->batch[i].mean - b->batch[i].mean;
        double z = se > 0.0 ? difference / se : 0.0;
        if (fabs(z) > fabs(worst))
            worst = z;
        char line[120];
        snprintf(line, sizeof line, "%s cell %d, %g against %g, t %.2f", name, i,
                 a->batch[i].mean, b->batch[i].mean, z);
        assert_true(stat_ok(line, stat_t_p(z, BATCHES - 1), level));
    }
    printf("%s: %.6f +- %.6f against %.6f +- %.6f; worst z of 49: %.2f\n", name,
           a->batch[48].mean, welford_se(&a->batch[48]), b->batch[48].mean,
           welford_se(&b->batch[48]), worst);
}

static void test_bdpt_equals_pt(void **state)
{
    (void)state;
    long paths = getenv("ETALON_LONG") ? 2000000 : 200000;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        /* pt cannot find the caustic of a point light, which begins at 3 edges. */
        const int depths[] = {1, 2, i == TEST_POINT ? 2 : 5};
        struct scene *scene = test_scene((enum test_contents)i, false);
        for (int j = 0; j < 3; j++) {
            struct cells *pt = calloc(1, sizeof *pt), *bdpt = calloc(1, sizeof *bdpt);
            gather_blocks(scene, estimate_pt, 2 * i, depths[j], paths, pt);
            gather_blocks(scene, estimate_bdpt, 2 * i + 1, depths[j], paths / 2, bdpt);
            printf("depth %d ", depths[j]);
            compare_blocks(test_contents_name[i], pt, bdpt, 3 * TEST_CONTENTS);
            free(pt);
            free(bdpt);
        }
        scene_destroy(scene);
    }
}

/* --- multiplexed paths ------------------------------------------------------------ */

#define MULTIPLEX_DEPTH 5

/* 4 x 4 blocks of the film for one length, luminance; by bdpt's own techniques. */
static void add_splats(struct cells *c, const struct contrib *out, int length)
{
    for (int i = 0; i < out->count; i++) {
        const struct splat *splat = &out->splats[i];
        if (splat->s + splat->t - 1 == length)
            c->sum[splat->pixel / 64 * 4 + splat->pixel % 16 / 4] += rgb_luminance(
                splat->value);
    }
}

static void gather_length(const struct scene *scene, int length, bool multiplexed,
                          int stream, long paths, struct cells *c)
{
    struct subpaths p;
    struct rng rng;
    struct ustream_random u;
    struct contrib out;
    struct techniques techniques;
    techniques_init(&techniques, &scene->needs, length);
    rng_init(&rng, 13, RNG_TEST, (uint64_t)stream);
    ustream_random_init(&u, &rng);
    subpaths_init(&p, scene, length);
    contrib_init(&out, estimate_splats_techniques(length));
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    for (int batch = 0; batch < BATCHES; batch++) {
        for (long i = 0; i < paths / BATCHES; i++) {
            if (multiplexed)
                estimate_mmlt(&p, &techniques, &numbers, &out);
            else
                estimate_bdpt_techniques(&p, &numbers, &out);
            assert_true((out.target > 0.0) == (out.failure == FAILURE_NONE));
            add_splats(c, &out, length);
        }
        close_batch(c, (double)(paths / BATCHES));
    }
    contrib_deinit(&out);
    subpaths_deinit(&p);
}

static void test_multiplexed_lengths(void **state)
{
    (void)state;
    long paths = getenv("ETALON_LONG") ? 2000000 : 200000;
    double level = stat_sidak(FALSE_ALARM, 16 * MULTIPLEX_DEPTH * TEST_CONTENTS);
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        for (int length = 1; length <= MULTIPLEX_DEPTH; length++) {
            struct cells *a = calloc(1, sizeof *a), *b = calloc(1, sizeof *b);
            double worst = 0.0, sum = 0.0;
            gather_length(scene, length, true, 2 * length, paths, a);
            gather_length(scene, length, false, 2 * length + 1, paths / 4, b);
            for (int j = 0; j < 16; j++) {
                double se = hypot(welford_se(&a->batch[j]), welford_se(&b->batch[j]));
                double d = a->batch[j].mean - b->batch[j].mean,
                       z = d == 0.0 ? 0.0 : d / se;
                worst = fabs(z) > fabs(worst) ? z : worst;
                sum += a->batch[j].mean;
            }
            printf("%s length %d: %.6f, worst z of 16: %.2f\n", test_contents_name[i],
                   length, sum, worst);
            assert_true(stat_ok("multiplexed", stat_t_p(worst, BATCHES - 1), level));
            free(a);
            free(b);
        }
        scene_destroy(scene);
    }
}

static void test_keep_all(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *lean = test_scene((enum test_contents)i, false);
        struct scene *full = test_scene((enum test_contents)i, true);
        struct cells *a = calloc(1, sizeof *a), *b = calloc(1, sizeof *b);
        gather_blocks(lean, estimate_bdpt, 40 + i, 5, 100000, a);
        gather_blocks(full, estimate_bdpt, 60 + i, 5, 100000, b);
        compare_blocks(test_contents_name[i], a, b, TEST_CONTENTS);
        free(a);
        free(b);
        scene_destroy(lean);
        scene_destroy(full);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_techniques),
        cmocka_unit_test(test_bdpt_equals_pt),
        cmocka_unit_test(test_multiplexed_lengths),
        cmocka_unit_test(test_keep_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
