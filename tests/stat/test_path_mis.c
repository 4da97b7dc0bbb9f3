/* The recurrence of path/mis.h against the definition (path/mis_ref.h) on random paths of
 * all kinds; the weights of all techniques of a path sum to 1 by that definition. The
 * value of every path without delta events against its definition too: that of all
 * techniques alike, so that adjoints and both kinds of transport are held to one truth.
 */

#include "path/connect.h"
#include "path/mis_ref.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define DEPTH 7
#define PATHS 3000

/* Directions are recomputed from float positions by the oracle: relative errors of 1e-6
 * per direction, times the steepness of a density (up to 1e2 at alpha .2 and grazing),
 * over at most 8 factors. A wrong term is wrong by its whole size. */
#define WEIGHT_ERROR 2e-3

/* Relative, of a value: the cosines of grazing directions are its steep factors. Where a
 * direction grazes a pane the transmittance is all rounding: less than VALUE_LEAST. */
#define VALUE_ERROR 1e-2
#define VALUE_LEAST 1e-9

/* Most of a scene's paths that are not compared, as rounding decides about them
 * (mis_ref_sure): 0.1 to 0.4 % are seen. */
#define MOST_LEFT_OUT 0.01

struct tried {
    long hit, light, camera, surfaces, with_delta, values, left_out;
    double worst, worst_value;
};

static bool any_delta(const struct vertex *v, int count)
{
    for (int i = 0; i + 1 < count; i++)
        if (v[i].delta_event)
            return true;
    return false;
}

static void check_value(struct tried *tried, const struct subpaths *p,
                        const struct connection *x, const struct vertex *light, int s,
                        int t)
{
    struct rgb definition = mis_ref_value(p->scene, light, s, p->camera, t);
    double expected = rgb_luminance(definition), got = rgb_luminance(x->value);
    double error = fabs(got - expected) / fmax(expected, VALUE_LEAST);
    if (!(error < VALUE_ERROR))
        fprintf(stderr, "s %d t %d: value %.8g, by definition %.8g\n", s, t, got,
                expected);
    assert_true(error < VALUE_ERROR);
    tried->worst_value = fmax(tried->worst_value, error);
    tried->values++;
}

static void check(struct tried *tried, long *kind, const struct subpaths *p,
                  const struct connection *x, const struct vertex *light, int s, int t)
{
    ++*kind;
    if (!mis_ref_sure(p->scene, light, s, p->camera, t)) {
        tried->left_out++;
        return;
    }
    double definition = mis_ref_weight(p->scene, light, s, p->camera, t);
    double error = fabs(x->weight - definition);
    if (!(error < WEIGHT_ERROR))
        fprintf(stderr, "s %d t %d: weight %.8g, by definition %.8g\n", s, t, x->weight,
                definition);
    assert_true(error < WEIGHT_ERROR);
    tried->worst = fmax(tried->worst, error);
    bool delta = any_delta(light, s) || any_delta(p->camera, t);
    if (!delta)
        check_value(tried, p, x, light, s, t);
    tried->with_delta += delta;
}

static void check_vertex(struct tried *tried, const struct subpaths *p, int t,
                         struct rng *rng)
{
    const struct vertex *z = &p->camera[t - 1];
    struct connection x;
    struct vertex point;
    double u[3] = {rng_double(rng), rng_double(rng), rng_double(rng)};
    if (connect_hit(p, z, t - 1, MIS_BIDIRECTIONAL, &x) == FAILURE_NONE)
        check(tried, &tried->hit, p, &x, NULL, 0, t);
    if (z->connectible && t <= p->max_depth &&
        connect_light(p, u, z, MIS_BIDIRECTIONAL, &x, &point) == FAILURE_NONE)
        check(tried, &tried->light, p, &x, &point, 1, t);
    for (int s = 2; s <= p->light_count && s <= p->max_depth + 1 - t; s++)
        if (z->connectible && p->light[s - 1].connectible &&
            connect_surfaces(p, &p->light[s - 1], z, &x) == FAILURE_NONE)
            check(tried, &tried->surfaces, p, &x, p->light, s, t);
}

static void check_scene(enum test_contents contents, struct tried *tried)
{
    struct scene *scene = test_scene(contents, false);
    struct subpaths p;
    struct rng rng;
    struct ustream_random numbers;
    struct connection x;
    rng_init(&rng, 7, RNG_TEST, contents);
    ustream_random_init(&numbers, &rng);
    subpaths_init(&p, scene, DEPTH);
    for (int i = 0; i < PATHS; i++) {
        walk_camera(&p, &numbers.stream, DEPTH + 1, HIT_ANY);
        walk_light(&p, &numbers.stream, DEPTH, HIT_ANY);
        for (int t = 2; t <= p.camera_count; t++)
            check_vertex(tried, &p, t, &rng);
        for (int s = 2; s <= p.light_count; s++)
            if (p.light[s - 1].connectible &&
                connect_camera(&p, &p.light[s - 1], &x) == FAILURE_NONE)
                check(tried, &tried->camera, &p, &x, p.light, s, 1);
    }
    subpaths_deinit(&p);
    scene_destroy(scene);
}

static void test_weights(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct tried tried = {0};
        check_scene((enum test_contents)i, &tried);
        printf("%-10s hit %ld, light %ld, camera %ld, surfaces %ld, with delta %ld; "
               "worst difference %.1e; %ld values, worst %.1e, left out %ld\n",
               test_contents_name[i], tried.hit, tried.light, tried.camera,
               tried.surfaces, tried.with_delta, tried.worst, tried.values,
               tried.worst_value, tried.left_out);
        long all = tried.hit + tried.light + tried.camera + tried.surfaces;
        assert_true((double)tried.left_out <= MOST_LEFT_OUT * (double)all);
        assert_true(tried.values > 2000);
        assert_true(tried.hit > 50 && tried.light > 500 && tried.camera > 500 &&
                    tried.surfaces > 500);
        if (i == TEST_GLASS || i == TEST_POINT || i == TEST_SKYGLASS || i == TEST_MIXED ||
            i == TEST_PANES)
            assert_true(tried.with_delta > 500);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_weights)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
