/* The split of error into bias and variance on made-up pictures: known bias and variance
 * by pixel, a reference with noise of its own, which is known or told by its halves.
 * False-alarm rate of this file: 1e-3. Power: weights of the reference's own pixels are
 * seen, and so is the noise if it is left in, both at p < 1e-9. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "image/noise.h"
#include "analysis/analysis_split.h"
#include "support/results_make.h"
#include "support/stat_test.h"

#include <stdlib.h>

#define LEVEL  stat_sidak(1e-3, 16)
#define SEEN   1e-9 /* what the p-value of a wrong way must lie below */
#define WIDTH  12
#define HEIGHT 10
#define VALUES ((size_t)(3 * WIDTH * HEIGHT))
#define SEEDS  6

struct world {
    double truth[VALUES], mean[VALUES], deviation[VALUES]; /* the latter of a picture */
    struct image *reference, *pictures[SEEDS];
    double bias2, variance; /* as the split should find them */
    struct noise noise;
};

/* The truths of the split, with the weights of the reference as it came out. */
static void weigh(struct world *world)
{
    for (int i = 0; i < (int)VALUES; i++) {
        int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        double r = (double)world->reference->pixels[i], to_truth = world->truth[i] - r;
        double weight = noise_weight(world->reference, x, y, i % 3) / (double)VALUES;
        world->noise.relmse += weight * to_truth * to_truth;
        world->bias2 += weight * (world->mean[i] - r) * (world->mean[i] - r);
        world->variance += weight * world->deviation[i] * world->deviation[i];
    }
    world->bias2 -= world->noise.relmse;
}

/* bias: share of the pixel's brightness that a picture is off by, one way or the other.
 */
static void world_init(struct world *world, double bias)
{
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    *world = (struct world){.reference = image_create(WIDTH, HEIGHT)};
    for (int s = 0; s < SEEDS; s++)
        world->pictures[s] = image_create(WIDTH, HEIGHT);
    for (size_t i = 0; i < VALUES; i++) {
        double truth = 2.0 * rng_double(&rng) * rng_double(&rng);
        world->reference->pixels[i] = (float)(truth + 0.05 * results_normal(&rng) *
                                                          (truth + 0.1));
        world->truth[i] = truth;
        world->mean[i] = truth + (i % 2 ? bias : -bias) * (truth + 0.1);
        world->deviation[i] = 0.3 * truth + 0.02;
    }
    weigh(world);
}

static void world_deinit(struct world *world)
{
    image_destroy(world->reference);
    for (int s = 0; s < SEEDS; s++)
        image_destroy(world->pictures[s]);
}

/* All pixels of a picture share some of their luck, as those of a Markov chain do. */
static struct analysis_split draw(struct rng *rng, const struct world *world)
{
    struct analysis_split split;
    struct err err = {0};
    for (int s = 0; s < SEEDS; s++) {
        double common = results_normal(rng);
        for (size_t i = 0; i < VALUES; i++) {
            double z = 0.3 * common + sqrt(1.0 - 0.09) * results_normal(rng);
            world->pictures[s]->pixels[i] = (float)(world->mean[i] +
                                                    world->deviation[i] * z);
        }
    }
    assert_true(analysis_split_pictures((const struct image *const *)world->pictures,
                                        SEEDS, world->reference, &world->noise, &split,
                                        &err));
    return split;
}

struct outcomes {
    int n;
    double *bias2, *variance, *uncorrected;
    long bias2_covered, variance_covered, significant;
};

static void run(const struct world *world, uint64_t index, struct outcomes *o)
{
    struct rng rng;
    double t = gsl_cdf_tdist_Pinv(0.975, SEEDS - 1);
    *o = (struct outcomes){.n = getenv("ETALON_LONG") ? 10000 : 500};
    o->bias2 = mem_alloc((size_t)o->n, sizeof(double));
    o->variance = mem_alloc((size_t)o->n, sizeof(double));
    o->uncorrected = mem_alloc((size_t)o->n, sizeof(double));
    rng_init(&rng, 2, RNG_TEST, index);
    for (int i = 0; i < o->n; i++) {
        struct analysis_split s = draw(&rng, world);
        o->bias2[i] = s.bias2;
        o->variance[i] = s.variance;
        o->uncorrected[i] = s.bias2 + s.variance / SEEDS;
        o->bias2_covered += fabs(s.bias2 - world->bias2) <= t * s.bias2_se;
        o->variance_covered += fabs(s.variance - world->variance) <= t * s.variance_se;
        o->significant += s.bias_is_significant;
        /* The parts make up the whole. */
        assert_true(fabs(s.bias2 + s.variance + s.noise - s.total) < 1e-12 * s.total);
    }
    print_message("bias^2 %.5f: covered %ld of %d, significant %ld; variance: %ld\n",
                  world->bias2, o->bias2_covered, o->n, o->significant,
                  o->variance_covered);
}

static void outcomes_deinit(struct outcomes *o)
{
    mem_free(o->bias2);
    mem_free(o->variance);
    mem_free(o->uncorrected);
}

/* At least q of all. */
static bool often(const char *what, long k, int n, double q)
{
    return stat_ok(what, gsl_cdf_binomial_P((unsigned)k, q, (unsigned)n), LEVEL);
}

static void planted_bias_is_found(void **state)
{
    (void)state;
    struct world world;
    struct outcomes o;
    world_init(&world, 0.2);
    run(&world, 1, &o);
    assert_true(stat_ok("bias^2", stat_mean_p(o.bias2, o.n, world.bias2), LEVEL));
    assert_true(stat_ok("variance", stat_mean_p(o.variance, o.n, world.variance), LEVEL));
    assert_true(stat_mean_p(o.uncorrected, o.n, world.bias2) < SEEN);
    assert_true(often("bias^2 covered", o.bias2_covered, o.n, 0.9));
    assert_true(often("variance covered", o.variance_covered, o.n, 0.9));
    assert_true(often("bias is seen", o.significant, o.n, 0.95));
    outcomes_deinit(&o);
    world_deinit(&world);
}

static void no_bias_is_none(void **state)
{
    (void)state;
    struct world world;
    struct outcomes o;
    world_init(&world, 0.0);
    assert_true(fabs(world.bias2) < 1e-12);
    run(&world, 2, &o);
    assert_true(stat_ok("no bias^2", stat_mean_p(o.bias2, o.n, world.bias2), LEVEL));
    assert_true(stat_ok("variance", stat_mean_p(o.variance, o.n, world.variance), LEVEL));
    assert_true(stat_mean_p(o.uncorrected, o.n, world.bias2) < SEEN);
    assert_true(often("no bias is seen", o.n - o.significant, o.n, 0.95));
    assert_true(often("no bias^2 covered", o.bias2_covered, o.n, 0.9));
    outcomes_deinit(&o);
    world_deinit(&world);
}

/* --- noise that the halves tell ---------------------------------------------------- */

enum { SIDE = 40, CASES = 200 };

/* A gamma deviate with mean 1 and variance 1/shape. */
static double skewed(struct rng *rng, int shape)
{
    double sum = 0.0;
    for (int i = 0; i < shape; i++)
        sum -= log(1.0 - rng_double(rng));
    return sum / shape;
}

static struct image *draw_skewed(struct rng *rng, int shape)
{
    struct image *image = image_create(SIDE, SIDE);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        image->pixels[i] = (float)((0.5 + 0.02 * (i / 3 % SIDE)) * skewed(rng, shape));
    return image;
}

/* bias^2 with the weights of the reference's own pixels, as it was measured once. */
static double by_own_weights(const struct image *const *pictures, size_t n,
                             const struct image *half, const struct image *mean)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        double r = (double)mean->pixels[i], d = (double)half->pixels[i] - r;
        double m = 0.0, squares = 0.0;
        for (size_t k = 0; k < n; k++)
            m += (double)pictures[k]->pixels[i] / (double)n;
        for (size_t k = 0; k < n; k++)
            squares += ((double)pictures[k]->pixels[i] - m) *
                       ((double)pictures[k]->pixels[i] - m);
        double s2_of_mean = squares / ((double)n - 1.0) / (double)n;
        sum += ((m - r) * (m - r) - s2_of_mean - d * d) / (r * r + 0.01);
    }
    return sum / (3.0 * SIDE * SIDE);
}

struct cases {
    double bias2[CASES], own[CASES], with_noise[CASES];
    long covered, significant;
};

/* Pictures without bias, of n seeds, against a reference of two halves: all are skewed.
 */
static void run_cases(size_t n, uint64_t stream, struct cases *c)
{
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, stream);
    *c = (struct cases){0};
    for (int i = 0; i < CASES; i++) {
        struct image *pictures[SEEDS], *a = draw_skewed(&rng, 8),
                                       *b = draw_skewed(&rng, 8);
        struct image *mean = image_mean(a, b);
        const struct image *const *all = (const struct image *const *)pictures;
        struct noise noise;
        struct analysis_split s;
        for (size_t k = 0; k < n; k++)
            pictures[k] = draw_skewed(&rng, 20);
        assert_true(noise_of_mean(a, mean, &noise, NULL));
        assert_true(analysis_split_pictures(all, n, mean, &noise, &s, NULL));
        double t = n < ANALYSIS_SPLIT_SEEDS ? 1.96
                                            : gsl_cdf_tdist_Pinv(0.975, (double)n - 1.0);
        c->bias2[i] = s.bias2;
        c->with_noise[i] = s.bias2 + s.noise;
        c->own[i] = by_own_weights(all, n, a, mean);
        c->covered += fabs(s.bias2) <= t * s.bias2_se;
        c->significant += s.bias_is_significant;
        for (size_t k = 0; k < n; k++)
            image_destroy(pictures[k]);
        image_destroy(a);
        image_destroy(b);
        image_destroy(mean);
    }
    print_message(
        "%zu seeds: bias^2 covered %ld of %d, significant %ld; p with own weights "
        "%.2g\n",
        n, c->covered, CASES, c->significant, stat_mean_p(c->own, CASES, 0.0));
}

static void noise_passes_for_no_bias(void **state)
{
    (void)state;
    struct cases c;
    run_cases(SEEDS, 3, &c);
    assert_true(stat_ok("bias^2", stat_mean_p(c.bias2, CASES, 0.0), LEVEL));
    assert_true(stat_mean_p(c.with_noise, CASES, 0.0) < SEEN);
    assert_true(stat_mean_p(c.own, CASES, 0.0) < SEEN);
    assert_true(often("no bias^2 covered", c.covered, CASES, 0.9));
    assert_true(often("no bias is seen", CASES - c.significant, CASES, 0.95));
}

/* Two seeds: errors from blocks of pixels, whose errors are independent here. */
static void two_seeds_have_errors(void **state)
{
    (void)state;
    struct cases c;
    run_cases(2, 4, &c);
    assert_true(stat_ok("bias^2", stat_mean_p(c.bias2, CASES, 0.0), LEVEL));
    assert_true(often("no bias^2 covered", c.covered, CASES, 0.9));
    assert_int_equal(c.significant, 0);
}

/* Against the truth itself, so that the blocks alone make the error. */
static void blocks_cover(void **state)
{
    (void)state;
    struct image *truth = image_create(SIDE, SIDE), *pictures[2];
    const struct image *const *all = (const struct image *const *)pictures;
    const struct noise none = {0};
    double variance = 0.0;
    long bias_covered = 0, variance_covered = 0;
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 5);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        truth->pixels[i] = (float)(0.5 + 0.02 * (i / 3 % SIDE));
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        double t = (double)truth->pixels[i];
        variance += noise_weight(truth, i / 3 % SIDE, i / 3 / SIDE, i % 3) * t * t /
                    20.0 / (3.0 * SIDE * SIDE);
    }
    for (int i = 0; i < CASES; i++) {
        struct analysis_split s;
        for (int k = 0; k < 2; k++)
            pictures[k] = draw_skewed(&rng, 20);
        assert_true(analysis_split_pictures(all, 2, truth, &none, &s, NULL));
        bias_covered += fabs(s.bias2) <= 1.96 * s.bias2_se;
        variance_covered += fabs(s.variance - variance) <= 1.96 * s.variance_se;
        image_destroy(pictures[0]);
        image_destroy(pictures[1]);
    }
    print_message("blocks: bias^2 covered %ld, variance %ld of %d\n", bias_covered,
                  variance_covered, CASES);
    assert_true(often("bias^2 by blocks", bias_covered, CASES, 0.9));
    assert_true(often("variance by blocks", variance_covered, CASES, 0.9));
    image_destroy(truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planted_bias_is_found),
        cmocka_unit_test(no_bias_is_none),
        cmocka_unit_test(noise_passes_for_no_bias),
        cmocka_unit_test(two_seeds_have_errors),
        cmocka_unit_test(blocks_cover),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
