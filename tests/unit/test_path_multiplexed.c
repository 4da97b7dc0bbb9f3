/* Multiplexed paths, exactly: the techniques that a scene can use, the numbers that each
 * of them asks for and no others, and why a path carries nothing. */

#include <string.h>

#include "path/estimate.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

/* --- which techniques ------------------------------------------------------------- */

static void check_techniques(const struct needs *needs, int length, const int *t,
                             int count)
{
    struct techniques techniques;
    techniques_init(&techniques, needs, length);
    assert_int_equal(techniques.length, length);
    assert_int_equal(techniques.count, count);
    for (int i = 0; i < count; i++)
        assert_int_equal(techniques.t[i], t[i]);
}

static void test_which(void **state)
{
    (void)state;
    const struct needs all = {
        .light_hits = true, .camera_connections = true, .light_connections = true};
    const struct needs point = {.camera_connections = true, .light_connections = true};
    const struct needs mirrors = {.light_hits = true}, nothing = {0};
    check_techniques(&all, 1, (int[]){2}, 1); /* (1,1) is left to (0,2) */
    check_techniques(&all, 2, (int[]){1, 2, 3}, 3);
    check_techniques(&all, 5, (int[]){1, 2, 3, 4, 5, 6}, 6);
    check_techniques(&point, 1, NULL, 0); /* a point is hit by nothing */
    check_techniques(&point, 2, (int[]){1, 2}, 2);
    check_techniques(&point, 3, (int[]){1, 2, 3}, 3);
    for (int length = 1; length <= DIMS_MAX_DEPTH; length++) {
        check_techniques(&mirrors, length, (int[]){length + 1}, 1);
        check_techniques(&nothing, length, NULL, 0);
    }
    struct techniques longest;
    techniques_init(&longest, &all, DIMS_MAX_DEPTH);
    assert_int_equal(longest.count, DIMS_MAX_DEPTH + 1);
}

/* Of scenes as they are built; keep_all keeps every technique in. */
static void test_of_scenes(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        struct techniques techniques;
        techniques_init(&techniques, &scene->needs, 3);
        assert_int_equal(techniques.count, 4);
        scene_destroy(scene);
    }
    /* A mirror before a lamp: the lamp is hit by chance, or not at all. */
    for (int keep_all = 0; keep_all < 2; keep_all++) {
        struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 34.0, 4);
        int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0);
        int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
        test_quad(desc, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0), mirror, rgb_grey(0));
        test_quad(desc, vec3(0, 0, 6), vec3(0, 2, 0), vec3(2, 0, 0), black, rgb_grey(1));
        struct scene *scene = test_build(desc, keep_all);
        if (keep_all)
            check_techniques(&scene->needs, 2, (int[]){1, 2, 3}, 3);
        else
            check_techniques(&scene->needs, 2, (int[]){3}, 1);
        scene_destroy(scene);
    }
}

/* --- which numbers ---------------------------------------------------------------- */

#define PLACES 32

/* Numbers that remember which places were asked for. The first of the connect stream is
 * `technique`, if that is not negative. */
struct recorded {
    struct ustream_random inner; /* must be first */
    double technique;
    bool taken[PLACES];
};

static const double *recorded_take(struct ustream *stream, int place, int count)
{
    struct recorded *r = (struct recorded *)stream;
    assert_true(place >= 0 && place + count <= PLACES);
    for (int i = 0; i < count; i++) {
        assert_false(r->taken[place + i]);
        r->taken[place + i] = true;
        r->inner.values[i] = rng_double(r->inner.rng);
    }
    if (r->technique >= 0.0 && place == DIMS_TECHNIQUE)
        r->inner.values[0] = r->technique;
    return r->inner.values;
}

/* One scene, one length, and streams that are looked at after each path. */
struct sample {
    struct scene *scene;
    struct subpaths paths;
    struct techniques techniques;
    struct contrib out;
    struct rng rng;
    struct recorded streams[3];
};

static void sample_init(struct sample *s, struct scene *scene, int length)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    techniques_init(&s->techniques, &scene->needs, length);
    subpaths_init(&s->paths, scene, length);
    contrib_init(&s->out, 1);
    rng_init(&s->rng, 21, RNG_TEST, (uint64_t)length);
    for (int i = 0; i < 3; i++) {
        ustream_random_init(&s->streams[i].inner, &s->rng);
        s->streams[i].inner.stream.take = recorded_take;
        s->streams[i].technique = -1.0;
    }
}

static void sample_deinit(struct sample *s)
{
    subpaths_deinit(&s->paths);
    contrib_deinit(&s->out);
    scene_destroy(s->scene);
}

/* A path by the technique with t camera vertices. */
static void sample_path(struct sample *s, int t)
{
    const struct numbers numbers = {&s->streams[0].inner.stream,
                                    &s->streams[1].inner.stream,
                                    &s->streams[2].inner.stream};
    int index = 0;
    while (s->techniques.t[index] != t)
        index++;
    s->streams[2].technique = (index + 0.5) / s->techniques.count;
    for (int i = 0; i < 3; i++)
        memset(s->streams[i].taken, 0, sizeof s->streams[i].taken);
    estimate_mmlt(&s->paths, &s->techniques, &numbers, &s->out);
    assert_true((s->out.target > 0.0) == (s->out.failure == FAILURE_NONE));
    if (s->out.count > 0) {
        assert_int_equal(s->out.splats[0].t, t);
        assert_int_equal(s->out.splats[0].s, s->techniques.length + 1 - t);
    }
}

static int count_taken(const struct recorded *r)
{
    int count = 0;
    for (int i = 0; i < PLACES; i++)
        count += r->taken[i];
    return count;
}

/* A diffuse floor and wall under one lamp, or two; no lens, no lobes. */
static struct scene *floor_scene(bool two_lamps)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4), vec3(0, 0, 0), 90.0, 4);
    int white = test_diffuse(desc, 0.5, 0.5, 0.5);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 4), vec3(4, 0, 0), white, rgb_grey(0.0));
    test_quad(desc, vec3(0, 0, -2), vec3(4, 0, 0), vec3(0, 4, 0), white, rgb_grey(0.0));
    test_lamp(desc, 0.5, rgb_grey(1.0));
    if (two_lamps)
        test_quad(desc, vec3(2, 1, 0), vec3(0, 0, 0.5f), vec3(0, 0.5f, 0), white,
                  rgb_grey(1.0));
    return test_build(desc, false);
}

/* Numbers of a path that reaches its end, by what happens on it. */
static void check_numbers(bool two_lamps)
{
    for (int length = 1; length <= 3; length++) {
        struct sample s;
        int seen = 0;
        sample_init(&s, floor_scene(two_lamps), length);
        for (int i = 0; i < s.techniques.count * 4000; i++) {
            int t = s.techniques.t[i % s.techniques.count], light = length + 1 - t;
            sample_path(&s, t);
            bool choice = s.techniques.count > 1;
            assert_int_equal(s.streams[2].taken[DIMS_TECHNIQUE], choice);
            assert_int_equal(count_taken(&s.streams[2]), choice);
            const struct recorded *camera = &s.streams[0], *lamp = &s.streams[1];
            /* No film for t = 1: the light's end finds its pixel. No lens at all. */
            assert_int_equal(camera->taken[DIMS_FILM], t > 1);
            assert_int_equal(camera->taken[DIMS_FILM + 1], t > 1);
            assert_false(camera->taken[DIMS_LENS]);
            if (light == 0)
                assert_int_equal(count_taken(lamp), 0);
            if (s.out.failure != FAILURE_NONE)
                continue;
            seen |= 1 << t;
            /* Directions: at every inner vertex of a sub-path, and at the lamp. */
            assert_int_equal(count_taken(camera), t > 1 ? 2 + 2 * (t - 2) : 0);
            assert_int_equal(lamp->taken[DIMS_LIGHT_PICK], two_lamps && light > 0);
            int own = light == 0   ? 0
                      : light == 1 ? 2 + two_lamps
                                   : 4 + two_lamps + 2 * (light - 2);
            assert_int_equal(count_taken(lamp), own);
        }
        for (int i = 0; i < s.techniques.count; i++)
            assert_true(seen & 1 << s.techniques.t[i]);
        sample_deinit(&s);
    }
}

static void test_numbers(void **state)
{
    (void)state;
    check_numbers(false);
    check_numbers(true);
}

/* --- failures --------------------------------------------------------------------- */

/* How often each cause was met, by one technique of paths of one length. */
static void count_causes(struct scene *scene, int length, int t, long counts[FAILURES])
{
    struct sample s;
    sample_init(&s, scene, length);
    memset(counts, 0, FAILURES * sizeof *counts);
    for (int i = 0; i < 2000; i++) {
        sample_path(&s, t);
        counts[s.out.failure]++;
    }
    sample_deinit(&s);
}

static void only(const long counts[FAILURES], enum failure cause)
{
    for (int i = 0; i < FAILURES; i++) {
        if ((counts[i] > 0) != (i == (int)cause))
            fprintf(stderr, "cause %d: %ld times\n", i, counts[i]);
        assert_true((counts[i] > 0) == (i == (int)cause));
    }
}

enum tiny {
    TINY_BEHIND, /* all that there is lies behind the camera */
    TINY_AWAY,   /* a floor in view, a lamp that shines away from it, out into space */
    TINY_SHADE,  /* a floor in view, and a black plate between it and the lamp */
    TINY_BACK,   /* a floor in view whose lamp lies beneath it */
    TINY_MIRROR, /* a mirror in view and a rough floor out of it */
    TINY_OPEN    /* a floor in view, under its lamp */
};

static struct scene *tiny_scene(enum tiny which)
{
    float z = which == TINY_BEHIND ? 10.0f : 0.0f;
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 30.0, 4);
    int white = test_diffuse(desc, 0.5, 0.5, 0.5);
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0);
    struct vec3 x = {3, 0, 0}, y = {0, 3, 0}, up = {0, 0.5f, 0}, right = {0.5f, 0, 0};
    struct rgb dark = rgb_grey(0.0), light = rgb_grey(1.0);
    test_quad(desc, vec3(0, 0, z), x, y, which == TINY_MIRROR ? mirror : white, dark);
    switch (which) {
    case TINY_BACK:
        test_quad(desc, vec3(0, 0, -2), right, up, black, light);
        break;
    case TINY_AWAY:
        test_quad(desc, vec3(0, 3, 2), right, up, black, light);
        break;
    case TINY_SHADE:
        test_quad(desc, vec3(9, 0, 2.5f), up, right, black, light);
        test_quad(desc, vec3(6, 0, 1.5f), vec3(2.5f, 0, 0), vec3(0, 9, 0), black, dark);
        break;
    default:
        test_quad(desc, vec3(0, 3, z + 2), up, right, black, light);
    }
    if (which == TINY_MIRROR)
        test_quad(desc, vec3(0, 0, 20), x, y, white, dark);
    return test_build(desc, false);
}

static void test_causes(void **state)
{
    (void)state;
    long counts[FAILURES];
    /* Length 2: (2,1), (1,2), (0,3). */
    count_causes(tiny_scene(TINY_BEHIND), 2, 2, counts);
    only(counts, FAILURE_CAMERA_PATH);
    count_causes(tiny_scene(TINY_BEHIND), 2, 3, counts);
    only(counts, FAILURE_CAMERA_PATH);
    count_causes(tiny_scene(TINY_AWAY), 2, 1, counts);
    only(counts, FAILURE_LIGHT_PATH);
    count_causes(tiny_scene(TINY_SHADE), 2, 2, counts);
    only(counts, FAILURE_BLOCKED);
    count_causes(tiny_scene(TINY_BACK), 2, 2, counts);
    only(counts, FAILURE_ZERO); /* no light from beneath: no ray is needed */
    count_causes(tiny_scene(TINY_MIRROR), 2, 2, counts);
    only(counts, FAILURE_ZERO); /* a mirror is no aim of a connection */
    count_causes(tiny_scene(TINY_OPEN), 2, 2, counts);
    only(counts, FAILURE_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_which),
        cmocka_unit_test(test_of_scenes),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_causes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
