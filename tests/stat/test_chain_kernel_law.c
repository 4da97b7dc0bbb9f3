/* Laws of the kernels' displacements. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/kernel.h"
#include "support/stat_test.h"

#include <stdlib.h>
#include <string.h>

#define LEVEL stat_sidak(1e-3, 16)
#define N     (KERNEL_BATCH * 16000)
#define CELLS 64

static double steps[N];

static void draw_all(const struct kernel_type *type, uint64_t seed, struct kernel *k)
{
    struct rng rng;
    rng_init(&rng, seed, RNG_TEST, 0);
    kernel_init(k, type, 0.0, 0.0, 0.0);
    for (int i = 0; i < N; i += KERNEL_BATCH)
        k->type->draw(k, &rng, steps + i);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* P(D <= d) of one step. */
static double law(const struct kernel *k, double d)
{
    if (k->type == &kernel_gaussian)
        return gsl_cdf_gaussian_P(d, k->sigma);
    double inside = fmin(1.0, fmax(0.0, log(fabs(d) / k->s1) / k->log_ratio));
    return d < 0.0 ? 0.5 - 0.5 * inside : 0.5 + 0.5 * inside;
}

/* By Kolmogorov-Smirnov, and by chi-squared in cells of equal probability. */
static void check_density(const struct kernel_type *type)
{
    struct kernel k;
    draw_all(type, 11, &k);
    double observed[CELLS] = {0}, expected[CELLS];
    for (int i = 0; i < N; i++) {
        steps[i] = law(&k, steps[i]);
        observed[(int)fmin(CELLS - 1, CELLS * steps[i])]++;
    }
    for (int i = 0; i < CELLS; i++)
        expected[i] = (double)N / CELLS;
    assert_true(stat_ok(type->name, stat_chi2_p(observed, expected, CELLS), LEVEL));
    qsort(steps, N, sizeof *steps, compare);
    assert_true(stat_ok(type->name, stat_uniform_p(steps, N), LEVEL));
}

/* The mean square, sharper on the width than a comparison of whole laws. */
static void check_width(const struct kernel_type *type)
{
    struct kernel k;
    draw_all(type, 16, &k);
    double square = k.sigma * k.sigma, fourth = 3.0 * square * square, sum = 0.0;
    if (type == &kernel_exponential) {
        square = (pow(k.s2, 2) - pow(k.s1, 2)) / (2.0 * k.log_ratio);
        fourth = (pow(k.s2, 4) - pow(k.s1, 4)) / (4.0 * k.log_ratio);
    }
    for (int i = 0; i < N; i++)
        sum += steps[i] * steps[i];
    double z = (sum - N * square) / sqrt(N * (fourth - square * square));
    assert_true(stat_ok(type->name, stat_z_p(z), LEVEL));
}

/* From x uniform to y: the counts of (cell of x, cell of y) and of the swapped pair have
 * one law, the border of [0,1) included. Cells are as wide as a step. */
static void check_symmetry(const struct kernel_type *type)
{
    enum { GRID = 64 };
    static double forward[GRID * GRID], backward[GRID * GRID];
    memset(forward, 0, sizeof forward);
    memset(backward, 0, sizeof backward);
    struct kernel k;
    draw_all(type, 12, &k);
    struct rng rng;
    rng_init(&rng, 13, RNG_TEST, 0);
    for (int i = 0; i < N; i++) {
        double x = rng_double(&rng), y = kernel_wrap(x + steps[i]);
        assert_true(y >= 0.0 && y < 1.0);
        int a = (int)(GRID * x), b = (int)(GRID * y);
        /* Two halves of the sample, so that the two tables are independent. */
        if (i % 2)
            forward[a * GRID + b]++;
        else
            backward[b * GRID + a]++;
    }
    double p = stat_chi2_two_p(forward, backward, GRID * GRID);
    assert_true(stat_ok(type->name, p, LEVEL));
}

/* Displacements of one batch, near and far, are uncorrelated, and so are their squares.
 */
static void check_independence(const struct kernel_type *type)
{
    struct kernel k;
    draw_all(type, 14, &k);
    const int lags[] = {1, 2, KERNEL_BATCH / 2};
    for (int j = 0; j < 3; j++) {
        double observed[16] = {0}, expected[16];
        long pairs = 0;
        for (int i = 0; i + lags[j] < N; i++) {
            if (i % KERNEL_BATCH + lags[j] >= KERNEL_BATCH)
                continue;
            if (i / lags[j] % 2)
                continue; /* pairs that share no displacement */
            int a = (int)fmin(3, 4.0 * law(&k, steps[i]));
            int b = (int)fmin(3, 4.0 * law(&k, steps[i + lags[j]]));
            observed[4 * a + b]++;
            pairs++;
        }
        for (int i = 0; i < 16; i++)
            expected[i] = (double)pairs / 16;
        double p = stat_chi2_p(observed, expected, 16);
        assert_true(stat_ok(type->name, p, LEVEL));
    }
}

/* A kernel that calls itself stable: the sum of n steps has the law of sqrt(n) times one.
 */
static void stable_means_stable(void **state)
{
    (void)state;
    for (int t = 0; kernel_types[t]; t++) {
        struct kernel k;
        if (!kernel_types[t]->stable)
            continue;
        draw_all(kernel_types[t], 15, &k);
        enum { SUMMED = 5 };
        int n = N / SUMMED;
        for (int i = 0; i < n; i++) {
            double sum = 0.0;
            for (int j = 0; j < SUMMED; j++)
                sum += steps[i * SUMMED + j];
            steps[i] = sum;
        }
        for (int i = 0; i < n; i++)
            steps[i] = law(&k, steps[i] / sqrt((double)SUMMED));
        qsort(steps, (size_t)n, sizeof *steps, compare);
        assert_true(stat_ok(kernel_types[t]->name, stat_uniform_p(steps, n), LEVEL));
    }
}

static void for_each(void (*check)(const struct kernel_type *type))
{
    for (int t = 0; kernel_types[t]; t++)
        check(kernel_types[t]);
}

static void density(void **state)
{
    (void)state;
    for_each(check_density);
}

static void width(void **state)
{
    (void)state;
    for_each(check_width);
}

static void symmetry(void **state)
{
    (void)state;
    for_each(check_symmetry);
}

static void independence(void **state)
{
    (void)state;
    for_each(check_independence);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density),
        cmocka_unit_test(width),
        cmocka_unit_test(symmetry),
        cmocka_unit_test(independence),
        cmocka_unit_test(stable_means_stable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
