/* The rule `tours` on chains whose asymptotic variance is known from their transition
 * matrices (support/matrix_toy.h): 11 targets, two widths of local steps, two estimators.
 *
 * exact: where the target is flat on its support, landings are independent and nothing is
 * approximated, with or without second stages. The prediction must be the variance, by a
 * t-test over 8 blocks of chains at p_l = .3, .5 and .8; smaller p_l, where weights are
 * great, are not tested here. False-alarm rate by design: 1e-3; of 26 runs with seeds
 * (TOURS_SEED) none failed, 9 of them with second stages. Of the 24 tests without second
 * stages these planted faults fail: pairs not divided by s0 23, visits not weighed by e
 * 24, (1 - p) / (1 - p0) left out 16.
 *
 * regret: over 44 cases (22 of target and width, by two estimators) p_l has at most 1.01
 * times the least error in the geometric mean and 1.10 at worst. Five runs with seeds had
 * means of 1.0047 to 1.0062 and worst cases of 1.037 to 1.071. It fails without the lower
 * bound at small p_l. zsolnai2013 has 1.21. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "math/accum.h"
#include "math/student.h"
#include "support/matrix_toy.h"
#include "support/stat_test.h"

#include <stdio.h>
#include <stdlib.h>

#define CHAINS    256
#define MUTATIONS 512
#define LONG      4096 /* so that the end of the tapes takes 1 % at most */
#define BLOCKS    8
#define P0        0.5
#define CASES     11

static struct tours_sums sums[CHAINS];
static struct matrix_toy toy;

static double bump(double x, double at, double width)
{
    double d = (x - at) / width;
    return exp(-0.5 * d * d);
}

/* Targets from flat to peaked, on islands, and rough. */
static const char *target_at(int which, double x, double normal, double *f)
{
    switch (which) {
    case 0:
        return *f = 1.0, "flat";
    case 1:
        return *f = x < 0.5, "flat on a half";
    case 2:
        return *f = fmod(5.0 * x, 1.0) < 0.2, "flat on five islands";
    case 3:
        return *f = fmod(3.0 * x, 1.0) < 0.03, "flat on three small islands";
    case 4:
        return *f = 1.0 + 0.9 * cos(6.2831853 * x), "cosine";
    case 5:
        return *f = 1.0 + 50.0 * bump(x, 0.4, 0.02), "peak";
    case 6:
        return *f = 1.0 + 1000.0 * bump(x, 0.4, 0.01), "high peak";
    case 7:
        return *f = 1.0 + 1000.0 * (bump(x, 0.2, 0.01) + bump(x, 0.7, 0.01)),
               "two high peaks";
    case 8:
        return *f = 0.01 + 1000.0 * (bump(x, 0.2, 0.01) + 0.5 * bump(x, 0.7, 0.01)),
               "two peaks on little";
    case 9:
        return *f = exp(normal), "lognormal 1";
    default:
        return *f = exp(2.0 * normal), "lognormal 2";
    }
}

static const char *make(int which, double sigma, enum estimator estimator)
{
    double f[MATRIX_STATES];
    const char *name = "";
    struct rng rng;
    rng_init(&rng, 7, RNG_TEST, (uint64_t)which);
    for (int i = 0; i < MATRIX_STATES; i++) {
        double u = rng_double(&rng), v = rng_double(&rng);
        double normal = sqrt(-2.0 * log(1.0 - u)) * cos(6.2831853 * v);
        name = target_at(which, (i + 0.5) / MATRIX_STATES, normal, &f[i]);
    }
    matrix_toy_init(&toy, f, sigma, estimator);
    return name;
}

static uint64_t first_seed(void)
{
    const char *seed = getenv("TOURS_SEED");
    return seed ? (uint64_t)atol(seed) : 1;
}

/* Two states without local steps between them: the chain has the eigenvalue 1 - 2 p / N,
 * and pixels 1/4 (1 + l) / (1 - l) [Geyer92, section 2]. */
static void two_states(void **state)
{
    double f[MATRIX_STATES] = {0.0};
    (void)state;
    f[0] = f[MATRIX_STATES / 2] = 3.0;
    matrix_toy_init(&toy, f, 0.001, ESTIMATOR_PLAIN);
    for (double p = 0.1; p < 1.05; p += 0.3) {
        double l = 1.0 - 2.0 * p / MATRIX_STATES, relative = 0.5 * MATRIX_PIXELS;
        double expected = 2.0 * MATRIX_PIXELS * 0.25 * (1.0 + l) / (1.0 - l) /
                          (relative * relative + MATRIX_FLOOR);
        double found = matrix_toy_variance(&toy, p);
        assert_true(fabs(found / expected - 1.0) < 1e-9);
    }
}

/* The variance as predicted by a block of chains, or by all (-1), with nothing corrected
 * or clipped. */
static double predict(int block, int point)
{
    double n = 0.0, mean = 0.0, rejected = 0.0, terms[3] = {0.0};
    for (int c = 0; c < CHAINS; c++) {
        if (block >= 0 && c * BLOCKS / CHAINS != block)
            continue;
        n += sums[c].mutations;
        mean += sums[c].mean[point];
        rejected += sums[c].rejected[point];
        for (int k = 0; k < 3; k++)
            terms[k] += sums[c].self[k][point] + sums[c].pair[0][k][point];
    }
    double theta = mean / n, square = sums[0].square * rejected / n * rejected / n;
    return (terms[0] + theta * (terms[1] + theta * terms[2])) / n - square;
}

static void exact(void **state)
{
    static const int points[] = {8, 10, 13}; /* p = .3, .5, .8 */
    double level = stat_sidak(1e-3, 36);
    int failed = 0;
    (void)state;
    for (int k = 0; k < 12; k++) {
        enum estimator estimator = k & 1 ? ESTIMATOR_PLAIN : ESTIMATOR_KELEMEN;
        const char *name = make(k / 4 > 0, k & 2 ? 0.05 : 0.02, estimator);
        toy.second = k >= 8;
        matrix_toy_sum(&toy, P0, CHAINS, LONG, first_seed(), sums);
        for (int i = 0; i < 3; i++) {
            struct welford blocks = {0};
            for (int b = 0; b < BLOCKS; b++)
                welford_add(&blocks, predict(b, points[i]));
            double truth = matrix_toy_variance(&toy, tours_p[points[i]]);
            double t = (blocks.mean - truth) / welford_se(&blocks);
            double p = 2.0 * student_tail(fabs(t), BLOCKS - 1.0);
            printf("%-16s%s %s p_l %.2f predicted %.5g true %.5g (%.1f sigmas)\n", name,
                   k >= 8 ? ", stages" : "", k & 1 ? "plain  " : "kelemen",
                   tours_p[points[i]], blocks.mean, truth, fabs(t));
            failed += p < level;
        }
    }
    assert_int_equal(failed, 0);
}

static double zsolnai(void)
{
    double r = toy.eta_l / toy.eta_0, s = toy.eta_s, l = toy.eta_l;
    return r < 0.1 ? 0.25 : s <= l ? 1.0 : fmin(1.0, s / (2.0 * (s - l)));
}

/* 1 / a of the brightest state. */
static double longest_stay(void)
{
    double most = 0.0;
    for (int i = 0; i < toy.count; i++)
        most = fmax(most, toy.f[i] / toy.b);
    return most;
}

static void regret(void **state)
{
    double sum[2] = {0.0}, worst[2] = {1.0, 1.0};
    int cases = 0;
    (void)state;
    for (int k = 0; k < 4 * CASES; k++, cases++) {
        const char *name = make(k / 4, k & 2 ? 0.05 : 0.02,
                                k & 1 ? ESTIMATOR_PLAIN : ESTIMATOR_KELEMEN);
        struct tours_part part = {.chains = sums,
                                  .count = CHAINS,
                                  .share = 1.0,
                                  .work = {1.0, 1.0},
                                  .stay = longest_stay(),
                                  .recorded = MUTATIONS,
                                  .planned = 1e5};
        struct tours_run run = {1e5 * CHAINS, 0.0, zsolnai()};
        struct tours_choice choice;
        matrix_toy_sum(&toy, P0, CHAINS, MUTATIONS, first_seed(), sums);
        tours_choose(&part, 1, &run, &choice);
        assert_true(choice.found);
        double least = HUGE_VAL, best = 0.0;
        for (int i = 0; i < TOURS_POINTS; i++) {
            double v = matrix_toy_variance(&toy, tours_p[i]);
            best = v < least ? tours_p[i] : best;
            least = fmin(least, v);
        }
        double ps[2] = {choice.plarge.p_l, zsolnai()}, regrets[2];
        for (int i = 0; i < 2; i++) {
            regrets[i] = fmax(matrix_toy_variance(&toy, ps[i]) / least, 1.0);
            sum[i] += log(regrets[i]);
            worst[i] = fmax(worst[i], regrets[i]);
        }
        printf("%-28s best %.2f tours %.3f regret %.3f zsolnai2013 %.2f regret %.3f\n",
               name, best, ps[0], regrets[0], ps[1], regrets[1]);
    }
    printf("geometric mean %.4f worst %.3f; zsolnai2013 %.3f, %.2f\n",
           exp(sum[0] / cases), worst[0], exp(sum[1] / cases), worst[1]);
    assert_true(exp(sum[0] / cases) <= 1.01);
    assert_true(worst[0] <= 1.10);
    assert_true(exp(sum[1] / cases) > 1.2 && exp(sum[1] / cases) < 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_states),
        cmocka_unit_test(exact),
        cmocka_unit_test(regret),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
