/* Depth limits to the edge: bdpt uses every technique of every length from 1 edge to
 * max_depth and none beyond; its streams hold the numbers of the longest path, and no
 * number serves two events. */

#include <string.h>

#include "path/estimate.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define MOST 6

#define PLACES 64

/* Numbers that check where they are asked for. */
struct checked {
    struct ustream_random inner; /* must be first */
    int capacity, highest;
    bool taken[PLACES]; /* by this sample */
};

static const double *checked_take(struct ustream *stream, int place, int count)
{
    struct checked *c = (struct checked *)stream;
    assert_true(place >= 0 && place + count <= c->capacity);
    if (place + count > c->highest)
        c->highest = place + count;
    for (int i = 0; i < count; i++) {
        assert_false(c->taken[place + i]);
        c->taken[place + i] = true;
    }
    for (int i = 0; i < count; i++)
        c->inner.values[i] = rng_double(c->inner.rng);
    return c->inner.values;
}

static void checked_init(struct checked *c, struct rng *rng, int capacity)
{
    ustream_random_init(&c->inner, rng);
    c->inner.stream.take = checked_take;
    c->capacity = capacity;
    c->highest = 0;
    assert_in_range(capacity, 1, PLACES);
}

static void next_sample(struct checked streams[3])
{
    for (int i = 0; i < 3; i++)
        memset(streams[i].taken, 0, sizeof streams[i].taken);
}

/* Three streams, of a path of `depth` edges. */
static struct numbers checked_numbers(struct checked streams[3], struct rng *rng,
                                      int depth)
{
    checked_init(&streams[0], rng, dims_camera_capacity(depth));
    checked_init(&streams[1], rng, dims_light_capacity(depth));
    checked_init(&streams[2], rng, dims_connect_capacity(depth));
    return (struct numbers){&streams[0].inner.stream, &streams[1].inner.stream,
                            &streams[2].inner.stream};
}

static void count_techniques(const struct scene *scene, int depth,
                             long used[MOST + 2][MOST + 2])
{
    struct subpaths paths;
    struct contrib out;
    struct rng rng;
    struct checked streams[3];
    rng_init(&rng, 5, RNG_TEST, (uint64_t)depth);
    struct numbers numbers = checked_numbers(streams, &rng, depth);
    subpaths_init(&paths, scene, depth);
    contrib_init(&out, estimate_splats_techniques(depth));
    for (int i = 0; i < 20000; i++) {
        next_sample(streams);
        estimate_bdpt_techniques(&paths, &numbers, &out);
        for (int j = 0; j < out.count; j++) {
            assert_in_range(out.splats[j].s + out.splats[j].t, 2, depth + 1);
            used[out.splats[j].s][out.splats[j].t]++;
        }
    }
    assert_int_equal(streams[2].highest, depth == 1 ? 0 : DIMS_DIRECT + 3 * (depth - 1));
    contrib_deinit(&out);
    subpaths_deinit(&paths);
}

static void test_techniques(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, true);
    for (int depth = 1; depth <= MOST; depth++) {
        long used[MOST + 2][MOST + 2] = {{0}};
        count_techniques(scene, depth, used);
        for (int s = 0; s <= MOST; s++)
            for (int t = 1; t <= MOST + 1; t++) {
                bool exists = s + t >= 2 && s + t <= depth + 1 && !(s == 1 && t == 1) &&
                              !(s == 0 && t == 1);
                if (exists != (used[s][t] > 0))
                    fprintf(stderr, "depth %d: (%d,%d) was used %ld times\n", depth, s, t,
                            used[s][t]);
                assert_true(exists == (used[s][t] > 0));
            }
    }
    scene_destroy(scene);
}

/* pt at 1 edge sees lamps only; at 2, what they light. */
static void test_pt(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    double sum[4] = {0};
    for (int depth = 1; depth <= 3; depth++) {
        struct subpaths paths;
        struct contrib out;
        struct rng rng;
        struct checked streams[3];
        rng_init(&rng, 6, RNG_TEST, 0);
        struct numbers numbers = checked_numbers(streams, &rng, depth);
        subpaths_init(&paths, scene, depth);
        contrib_init(&out, estimate_splats(depth));
        for (int i = 0; i < 20000; i++) {
            next_sample(streams);
            estimate_pt(&paths, &numbers, &out);
            sum[depth] += out.target;
        }
        assert_int_equal(streams[2].highest,
                         depth == 1 ? 0 : DIMS_DIRECT + 3 * (depth - 1));
        contrib_deinit(&out);
        subpaths_deinit(&paths);
    }
    printf("pt to 1, 2, 3 edges: %g, %g, %g\n", sum[1], sum[2], sum[3]);
    assert_true(sum[1] < 0.7 * sum[2] && sum[2] < 0.95 * sum[3]);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_techniques),
        cmocka_unit_test(test_pt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
