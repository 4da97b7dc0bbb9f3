/* The tree of grids: its density against the weights, cell by cell, where it divides, and
 * at the ends of u. */
#include "math/dist_tree.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

#define SIZE   128
#define LAST_U (1.0 - 0x1p-53)

static double weights[1024 * 1024];

static double pdf_at(const struct dist_tree *tree, int size, int x, int y)
{
    return dist_tree_pdf(tree, (const double[2]){(x + 0.5) / size, (y + 0.5) / size});
}

/* Uneven everywhere, with black rows and black patches: all is divided. */
static void fill_rough(int size, uint64_t seed)
{
    struct rng rng;
    rng_init(&rng, seed, RNG_TEST, 0);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            weights[y * size + x] = y % 16 == 3 || (x / 8 + y / 8) % 5 == 0
                                        ? 0.0
                                        : pow(rng_double(&rng), 4.0);
}

static double sum_of(int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += weights[i];
    return sum;
}

static void divided_cells_have_the_density_of_their_weights(void **state)
{
    (void)state;
    struct dist_tree tree;
    fill_rough(SIZE, 1);
    double sum = sum_of(SIZE * SIZE);
    assert_true(dist_tree_build(&tree, weights, SIZE, NULL));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double expected = weights[y * SIZE + x] / sum * SIZE * SIZE;
            assert_true(fabs(pdf_at(&tree, SIZE, x, y) - expected) < 1e-12 * SIZE * SIZE);
        }
    dist_tree_deinit(&tree);
    assert_int_equal(dist_tree_bytes(&tree), 0);
}

/* One bright cell of a million in a dim square: three levels down, and only there. */
static void a_bright_cell_is_found(void **state)
{
    (void)state;
    enum { BIG = 1024 };
    struct dist_tree tree;
    for (int i = 0; i < BIG * BIG; i++)
        weights[i] = 1.0;
    weights[700 * BIG + 300] = BIG * BIG;
    assert_true(dist_tree_build(&tree, weights, BIG, NULL));
    assert_int_equal(tree.node_count, 2);
    double sum = 2.0 * BIG * BIG - 1.0;
    assert_true(fabs(pdf_at(&tree, BIG, 300, 700) / (1.0 / sum * BIG * BIG * BIG * BIG) -
                     1.0) < 1e-12);
    assert_true(fabs(pdf_at(&tree, BIG, 301, 700) / (1.0 / sum * BIG * BIG) - 1.0) <
                1e-9);
    double point[2];
    dist_tree_sample(&tree, (const double[2]){0.5, 0.68}, point);
    assert_true((int)(point[0] * BIG) == 300 && (int)(point[1] * BIG) == 700);
    dist_tree_deinit(&tree);
}

/* Noise wants more nodes than there may be; a gentle slope wants few. In both cases the
 * integral is 1, each positive weight has a density, and of the slope the second moment
 * is within a twentieth of the best. */
static void coarse_cells_have_the_mean(void **state)
{
    (void)state;
    enum { BIG = 1024 };
    for (int slope = 0; slope < 2; slope++) {
        struct dist_tree tree;
        if (slope)
            for (int i = 0; i < BIG * BIG; i++)
                weights[i] = 2.0 + sin(6.0 * (i % BIG) / BIG) * (i / BIG) / BIG;
        else
            fill_rough(BIG, 2);
        assert_true(dist_tree_build(&tree, weights, BIG, NULL));
        assert_true(tree.node_count <= DIST_TREE_NODES);
        assert_true(!slope || tree.node_count < 64);
        double sum = sum_of(BIG * BIG), integral = 0.0, second = 0.0;
        for (int y = 0; y < BIG; y++)
            for (int x = 0; x < BIG; x++) {
                double w = weights[y * BIG + x], pdf = pdf_at(&tree, BIG, x, y);
                assert_true(pdf > 0.0 || w == 0.0);
                integral += pdf / BIG / BIG;
                second += w > 0.0 ? w / sum * (w / sum) / pdf * BIG * BIG : 0.0;
            }
        assert_true(fabs(integral - 1.0) < 1e-10);
        assert_true(!slope || (second >= 1.0 - 1e-9 && second < 1.05));
        dist_tree_deinit(&tree);
    }
}

struct counted_detail {
    struct dist_tree_detail detail; /* must be first */
    int *asked;
};

/* Parts of 0, 1, .. 63. */
static void fill_ramp(const struct dist_tree_detail *self, int x, int y,
                      double parts[DIST_TREE_SIDE * DIST_TREE_SIDE])
{
    assert_true(x == 40 && y == 70);
    for (int k = 0; k < DIST_TREE_SIDE * DIST_TREE_SIDE; k++)
        parts[k] = k;
    ++*((const struct counted_detail *)self)->asked;
}

/* Only the bright cell is asked about, and what it holds in all stays as it was. */
static void bright_cells_have_the_density_of_their_parts(void **state)
{
    (void)state;
    enum { FINE = SIZE * DIST_TREE_SIDE, BRIGHT = 1000 };
    int asked = 0;
    const struct counted_detail detail = {{fill_ramp}, &asked};
    struct dist_tree tree;
    for (int i = 0; i < SIZE * SIZE; i++)
        weights[i] = 1.0;
    weights[70 * SIZE + 40] = BRIGHT;
    assert_true(dist_tree_build(&tree, weights, SIZE, &detail.detail));
    assert_int_equal(asked, 1);
    assert_int_equal(tree.node_count, 2);
    double sum = SIZE * SIZE - 1.0 + BRIGHT;
    for (int k = 0; k < 64; k++) {
        double expected = BRIGHT / sum * (k / 2016.0) * FINE * FINE;
        double pdf = pdf_at(&tree, FINE, 320 + k % 8, 560 + k / 8);
        assert_true(fabs(pdf - expected) < 1e-9 * FINE * FINE);
    }
    double beside = pdf_at(&tree, FINE, 328, 560);
    assert_true(fabs(beside - SIZE * SIZE / sum) < 1e-9);
    for (int k = 0; k < 10000; k++) {
        double u[2] = {(k % 100 + 0.5) / 100, (k / 100 + 0.5) / 100}, point[2], back[2];
        dist_tree_sample(&tree, u, point);
        assert_true(dist_tree_pdf(&tree, point) > 0.0);
        assert_true(dist_tree_invert(&tree, point, back));
        assert_true(fabs(back[0] - u[0]) < 1e-9 && fabs(back[1] - u[1]) < 1e-9);
    }
    dist_tree_deinit(&tree);
}

static void samples_lie_where_there_is_a_density(void **state)
{
    (void)state;
    const double edges[] = {0.0, 0x1p-53, 0.5, LAST_U};
    struct dist_tree tree;
    struct rng rng;
    fill_rough(SIZE, 3);
    rng_init(&rng, 4, RNG_TEST, 0);
    assert_true(dist_tree_build(&tree, weights, SIZE, NULL));
    for (int k = 0; k < 300000; k++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)}, point[2];
        u[0] = k < 16 ? edges[k % 4] : u[0];
        u[1] = k < 16 ? edges[k / 4] : u[1];
        dist_tree_sample(&tree, u, point);
        assert_true(point[0] >= 0.0 && point[0] < 1.0);
        assert_true(point[1] >= 0.0 && point[1] < 1.0);
        assert_true(weights[(int)(point[1] * SIZE) * SIZE + (int)(point[0] * SIZE)] >
                    0.0);
        assert_true(dist_tree_pdf(&tree, point) > 0.0);
    }
    dist_tree_deinit(&tree);
}

static void rows_grow_with_u(void **state)
{
    (void)state;
    struct dist_tree tree;
    fill_rough(SIZE, 5);
    assert_true(dist_tree_build(&tree, weights, SIZE, NULL));
    double last = 0.0;
    for (int k = 0; k < 10000; k++) {
        double point[2];
        dist_tree_sample(&tree, (const double[2]){0.3, k / 10000.0}, point);
        assert_true((int)(point[1] * DIST_TREE_ROOT) >= (int)(last * DIST_TREE_ROOT));
        last = point[1];
    }
    dist_tree_deinit(&tree);
}

static void bad_weights_are_refused(void **state)
{
    (void)state;
    const double bad[] = {-1e-300, (double)NAN, (double)INFINITY};
    struct dist_tree tree;
    for (int i = 0; i < SIZE * SIZE; i++)
        weights[i] = 0.0;
    assert_false(dist_tree_build(&tree, weights, SIZE, NULL));
    for (int k = 0; k < 3; k++) {
        weights[0] = 1.0;
        weights[77] = bad[k];
        assert_false(dist_tree_build(&tree, weights, SIZE, NULL));
        assert_null(tree.tables);
    }
    weights[77] = 0x1p-1074;
    weights[0] = 1e308;
    assert_true(dist_tree_build(&tree, weights, SIZE, NULL));
    dist_tree_deinit(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(divided_cells_have_the_density_of_their_weights),
        cmocka_unit_test(a_bright_cell_is_found),
        cmocka_unit_test(coarse_cells_have_the_mean),
        cmocka_unit_test(bright_cells_have_the_density_of_their_parts),
        cmocka_unit_test(samples_lie_where_there_is_a_density),
        cmocka_unit_test(rows_grow_with_u),
        cmocka_unit_test(bad_weights_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
