/* Warps against their densities: chi-squared over cells whose share is known in closed
 * form. False-alarm rate 1e-3 for the whole file (Sidak over its tests); fixed seed. */
#include "math/dist.h"
#include "math/dist_tree.h"
#include "math/rng.h"
#include "math/warp.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

enum { SAMPLES = 2000000, CELLS = 32, TESTS = 6 };

/* Places a point of the warp into one of CELLS x CELLS cells, as a point of the square
 * that is uniform if the density is right. */
typedef void (*flatten)(const double u[2], double flat[2]);

static void flatten_disk(const double u[2], double flat[2])
{
    struct vec2 p = warp_disk(u);
    flat[0] = p.x * p.x + p.y * p.y;
    flat[1] = (atan2(p.y, p.x) + MATH_PI) / (2.0 * MATH_PI);
}

static double azimuth(struct vec3 w)
{
    return (atan2((double)w.y, (double)w.x) + MATH_PI) / (2.0 * MATH_PI);
}

static void flatten_cosine(const double u[2], double flat[2])
{
    struct vec3 w = warp_cosine(u);
    flat[0] = (double)w.z; /* cells of cos theta: weighed by warp_cosine_pdf below */
    flat[1] = azimuth(w);
}

static void flatten_sphere(const double u[2], double flat[2])
{
    struct vec3 w = warp_sphere(u);
    flat[0] = 0.5 * ((double)w.z + 1.0); /* Archimedes */
    flat[1] = azimuth(w);
}

static void flatten_triangle(const double u[2], double flat[2])
{
    struct vec2 b = warp_triangle(u);
    flat[0] = (1.0 - b.x) * (1.0 - b.x);
    flat[1] = b.y / (1.0 - b.x);
}

static int cell(double x)
{
    int i = (int)(x * CELLS);
    return i < 0 ? 0 : i >= CELLS ? CELLS - 1 : i;
}

static void check_counts(const double *counts, const double *expected, int cells)
{
    double chi2 = 0.0;
    for (int i = 0; i < cells; i++) {
        assert_true(expected[i] > 5.0);
        chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    }
    double p = gsl_cdf_chisq_Q(chi2, cells - 1);
    assert_true(p > 1.0 - pow(1.0 - 1e-3, 1.0 / TESTS));
}

static void check_warp(flatten warp, uint64_t index, const double row_share[CELLS])
{
    static double counts[CELLS * CELLS], expected[CELLS * CELLS];
    memset(counts, 0, sizeof counts);
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, index);
    for (int k = 0; k < SAMPLES; k++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)}, flat[2];
        warp(u, flat);
        counts[cell(flat[0]) * CELLS + cell(flat[1])] += 1.0;
    }
    for (int i = 0; i < CELLS * CELLS; i++)
        expected[i] = SAMPLES * (row_share ? row_share[i / CELLS] : 1.0 / CELLS) / CELLS;
    check_counts(counts, expected, CELLS * CELLS);
}

static void disk_is_uniform(void **state)
{
    (void)state;
    check_warp(flatten_disk, 0, NULL);
}

static void cosine_follows_its_pdf(void **state)
{
    (void)state;
    double share[CELLS]; /* 2 pi times the integral over a cell; midpoint is exact */
    for (int i = 0; i < CELLS; i++)
        share[i] = 2.0 * MATH_PI * warp_cosine_pdf((float)((i + 0.5) / CELLS)) / CELLS;
    check_warp(flatten_cosine, 1, share);
}

static void sphere_is_uniform(void **state)
{
    (void)state;
    check_warp(flatten_sphere, 2, NULL);
}

static void triangle_is_uniform(void **state)
{
    (void)state;
    check_warp(flatten_triangle, 3, NULL);
}

static void dist_follows_its_weights(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    double weights[COUNT], counts[COUNT] = {0}, expected[COUNT], total = 0.0;
    for (int i = 0; i < COUNT; i++)
        total += weights[i] = 1.0 + 100.0 * (i % 7 == 3) + i % 5;
    struct dist d;
    assert_true(dist_build(&d, weights, COUNT));
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 4);
    for (int k = 0; k < SAMPLES; k++) {
        double p;
        counts[dist_sample(&d, rng_double(&rng), &p, NULL)] += 1.0;
    }
    for (int i = 0; i < COUNT; i++)
        expected[i] = SAMPLES * weights[i] / total;
    check_counts(counts, expected, COUNT);
    dist_deinit(&d);
}

/* Points within cells too: each cell of the first grid is split into 2 x 2. A few of them
 * are uneven, so that the tree divides them. */
static void dist_tree_follows_its_weights(void **state)
{
    (void)state;
    enum { SIZE = 128, SPLIT = 2 * DIST_TREE_ROOT, EACH = SIZE / SPLIT };
    static double weights[SIZE * SIZE];
    double counts[SPLIT * SPLIT] = {0}, expected[SPLIT * SPLIT] = {0}, total = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        int cell = i / SIZE / 8 * DIST_TREE_ROOT + i % SIZE / 8;
        weights[i] = 1.0 + cell % 3;
        if (cell % 11 == 0)
            weights[i] *= i % SIZE % 8 < 3 ? 0.0 : 1.0 + 4.0 * (i / SIZE % 8);
        total += weights[i];
    }
    struct dist_tree tree;
    assert_true(dist_tree_build(&tree, weights, SIZE, NULL));
    assert_int_equal(tree.node_count, 24); /* cells 0, 11, ... 253 */
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 5);
    for (int k = 0; k < SAMPLES; k++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)}, point[2];
        dist_tree_sample(&tree, u, point);
        counts[(int)(point[1] * SPLIT) * SPLIT + (int)(point[0] * SPLIT)] += 1.0;
    }
    for (int i = 0; i < SIZE * SIZE; i++)
        expected[i / SIZE / EACH * SPLIT + i % SIZE / EACH] += SAMPLES * weights[i] /
                                                               total;
    check_counts(counts, expected, SPLIT * SPLIT);
    dist_tree_deinit(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[TESTS] = {
        cmocka_unit_test(disk_is_uniform),
        cmocka_unit_test(cosine_follows_its_pdf),
        cmocka_unit_test(sphere_is_uniform),
        cmocka_unit_test(triangle_is_uniform),
        cmocka_unit_test(dist_follows_its_weights),
        cmocka_unit_test(dist_tree_follows_its_weights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
