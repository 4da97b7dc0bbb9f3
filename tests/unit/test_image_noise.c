/* Noise of the mean of two halves: figures worked out by hand, and simulated pictures
 * whose variance is known, with skewed errors, small and large. False-alarm rate of this
 * file: 1e-3; power: the weights of relMSE itself, which depend on the pixel's own noise,
 * fail at p < 1e-9 in both simulations. */
#include "image/noise.h"
#include "image/metric.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/near.h"
#include "support/stat_test.h"

#include <math.h>
#include <string.h>

#define LEVEL 1e-3
#define SEEN  1e-9

static struct image *filled(int width, int height, float value)
{
    struct image *image = image_create(width, height);
    for (int i = 0; i < 3 * width * height; i++)
        image->pixels[i] = value;
    return image;
}

static double weight_of(double q)
{
    return 1.0 / (q * q + METRIC_RELATIVE_FLOOR);
}

/* --- by hand --------------------------------------------------------------------- */

static void weights_are_of_the_neighbours(void **state)
{
    (void)state;
    struct image *m = filled(3, 3, 1.0f);
    assert_relative(noise_weight(m, 1, 1, 0), weight_of(1.0), 1e-15);
    image_at(m, 1, 1)[0] = 1.9f; /* its own value does not matter */
    assert_relative(noise_weight(m, 1, 1, 0), weight_of(1.0), 1e-15);
    image_at(m, 1, 1)[0] = 0.0f;
    assert_relative(noise_weight(m, 1, 1, 0), weight_of(1.0), 1e-15);
    image_at(m, 1, 1)[0] = 6.0f; /* unless it is far brighter */
    assert_relative(noise_weight(m, 1, 1, 0), weight_of(3.0), 1e-15);
    /* A corner has three neighbours, an edge five. */
    assert_relative(noise_weight(m, 0, 0, 0), weight_of(8.0 / 3.0), 1e-15);
    assert_relative(noise_weight(m, 1, 0, 0), weight_of(2.0), 1e-15);
    assert_relative(noise_weight(m, 1, 0, 1), weight_of(1.0), 1e-15);
    image_at(m, 1, 1)[0] = NAN;
    assert_relative(noise_weight(m, 0, 0, 0), weight_of(1.0), 1e-15);
    image_destroy(m);
    struct image *one = filled(1, 1, 0.5f);
    assert_relative(noise_weight(one, 0, 0, 2), weight_of(0.5), 1e-15);
    image_destroy(one);
}

static void known_pixels(void **state)
{
    (void)state;
    /* 200 pixels: d = .5 in all channels of one, .25 in one channel of two. */
    struct image *mean = filled(20, 10, 1.0f), *half = filled(20, 10, 1.0f);
    struct noise noise;
    struct err err = {0};
    for (int c = 0; c < 3; c++)
        image_at(half, 5, 5)[c] = 1.5f;
    image_at(half, 9, 2)[1] = 0.75f;
    image_at(half, 15, 7)[2] = 1.25f;
    assert_true(noise_of_mean(half, mean, &noise, &err));
    double w = weight_of(1.0), one = w * 0.25, few = w * 0.0625 / 3.0;
    assert_relative(noise.rmse, sqrt((3.0 * 0.25 + 2.0 * 0.0625) / 600.0), 1e-14);
    assert_relative(noise.relmse, (one + 2.0 * few) / 200.0, 1e-13);
    assert_relative(noise.relmse_se, sqrt(one * one + 2.0 * few * few) / 200.0, 1e-13);
    /* Two of 200 pixels are left out. */
    assert_relative(noise.relmse_trimmed, few / 198.0, 1e-13);
    /* What is not finite does not count. */
    image_at(half, 5, 5)[0] = INFINITY;
    assert_true(noise_of_mean(half, mean, &noise, &err));
    assert_relative(noise.relmse, 2.0 * few / 199.0, 1e-13);
    struct image *small = filled(2, 2, NAN);
    assert_false(noise_of_mean(half, small, &noise, &err));
    assert_non_null(strstr(err.message, "20x10 against 2x2"));
    err = (struct err){0};
    assert_false(noise_of_mean(small, small, &noise, &err));
    assert_non_null(strstr(err.message, "no pixel is finite"));
    image_destroy(small);
    image_destroy(mean);
    image_destroy(half);
}

/* --- simulated pictures ---------------------------------------------------------- */

enum { SIDE = 24, PICTURES = 400 };

/* A gamma deviate with mean 1 and variance 1/shape: skewed, never negative. */
static double skewed(struct rng *rng, int shape)
{
    double sum = 0.0;
    for (int i = 0; i < shape; i++)
        sum -= log(1.0 - rng_double(rng));
    return sum / shape;
}

static double truth(int x, int y)
{
    return 0.5 + 0.02 * x + 0.01 * y;
}

/* What halves tell less what the mean's errors are, weighed by `own` as relMSE or as in
 * noise.h, over a picture. */
static double excess(struct rng *rng, int shape, bool own)
{
    struct image *half = image_create(SIDE, SIDE), *other = image_create(SIDE, SIDE);
    double told = 0.0, real = 0.0;
    struct noise noise;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                image_at(half, x, y)[c] = (float)(truth(x, y) * skewed(rng, shape));
                image_at(other, x, y)[c] = (float)(truth(x, y) * skewed(rng, shape));
            }
    struct image *mean = image_mean(half, other);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                double m = (double)image_at(mean, x, y)[c], e = m - truth(x, y);
                double d = (double)image_at(half, x, y)[c] - m;
                double w = own ? weight_of(m) : noise_weight(mean, x, y, c);
                real += w * e * e;
                told += w * d * d;
            }
    assert_true(noise_of_mean(half, mean, &noise, NULL));
    if (!own)
        assert_relative(noise.relmse, told / (3.0 * SIDE * SIDE), 1e-9);
    image_destroy(half);
    image_destroy(other);
    image_destroy(mean);
    return (told - real) / real;
}

struct excesses {
    double ours[PICTURES], own[PICTURES];
};

static void simulate(int shape, uint64_t stream, struct excesses *e)
{
    struct rng rng;
    double ours = 0.0, own = 0.0;
    rng_init(&rng, 3, RNG_TEST, stream);
    for (int i = 0; i < PICTURES; i++) {
        e->ours[i] = excess(&rng, shape, false);
        e->own[i] = excess(&rng, shape, true);
        ours += e->ours[i] / PICTURES;
        own += e->own[i] / PICTURES;
    }
    print_message("told less real, as a share: %.4f; by own weights %.4f (p %.2g)\n",
                  ours, own, stat_mean_p(e->own, PICTURES, 0.0));
}

/* Relative variance of a half .04: no pixel is twice its neighbours, the weights are
 * independent of the noise, and the ratio's mean is 0 to within its own error. */
static void small_noise_is_told_exactly(void **state)
{
    (void)state;
    struct excesses e;
    simulate(25, 1, &e);
    assert_true(stat_ok("small noise", stat_mean_p(e.ours, PICTURES, 0.0), LEVEL));
    assert_true(stat_mean_p(e.own, PICTURES, 0.0) < SEEN);
}

/* Relative variance of a half 1: many pixels are twice their neighbours. What is left of
 * the error is less than a quarter of the own weights' one, either way. */
static void large_noise_is_told_nearly(void **state)
{
    (void)state;
    struct excesses e;
    simulate(1, 2, &e);
    for (int sign = -1; sign <= 1; sign += 2) {
        double rest[PICTURES], mean = 0.0;
        for (int i = 0; i < PICTURES; i++) {
            rest[i] = -e.own[i] / 4.0 - sign * e.ours[i];
            mean += rest[i] / PICTURES;
        }
        assert_true(mean > 0.0 && stat_mean_p(rest, PICTURES, 0.0) < SEEN);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_of_the_neighbours),
        cmocka_unit_test(known_pixels),
        cmocka_unit_test(small_noise_is_told_exactly),
        cmocka_unit_test(large_noise_is_told_nearly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
