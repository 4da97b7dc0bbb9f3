/* integrator/sample_map: the division of samples among pixels, where the right one is
 * known, and that no pixel's own error, nor any of its colour, decides about it. */

#include "integrator/sample_map.h"
#include "math/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 22, PIXELS = WIDTH * HEIGHT };

/* Of errors from so many samples of a pixel, a tenth of the run's. */
static double make(const float *errors, const float *work, int width, int height,
                   double samples, uint32_t *each)
{
    struct sample_start start = {width, height, errors, work, samples, 0.1};
    return sample_map_make(&start, each);
}

static const float *equal_work(void)
{
    static float work[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        work[i] = 7.0f;
    return work;
}

static long sum_of(const uint32_t *each)
{
    long sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += each[i];
    return sum;
}

static void equal_errors_get_equal_samples(void **state)
{
    (void)state;
    const float values[] = {0.0f, 1e-20f, 3.0f, 1e20f};
    float errors[PIXELS];
    uint32_t each[PIXELS];
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < PIXELS; i++)
            errors[i] = values[k];
        assert_true(fabs(make(errors, equal_work(), WIDTH, HEIGHT, 8, each) - 1.0) <
                    1e-12);
        for (int i = 0; i < PIXELS; i++)
            assert_int_equal(each[i], SAMPLE_MAP_MEAN);
    }
}

/* Errors 1 and 25, work 1 and 4 in two halves, h and 1 - h of the film: roots 1 and 2.5,
 * of mean m, so 1 / m and 2.5 / m of the samples, of which the start has a tenth of the
 * mean; away from the seam, and with all samples in the budget. */
static void samples_follow_the_root(void **state)
{
    (void)state;
    float errors[PIXELS], work[PIXELS];
    uint32_t each[PIXELS];
    double left = 0.0, right = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        errors[i] = i % WIDTH < WIDTH / 2 ? 1.0f : 25.0f;
        work[i] = i % WIDTH < WIDTH / 2 ? 1.0f : 4.0f;
    }
    double predicted = make(errors, work, WIDTH, HEIGHT, 512, each);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH / 2 - 2; x++)
            left += each[y * WIDTH + x] / (HEIGHT * (WIDTH / 2 - 2.0));
        for (int x = WIDTH / 2 + 2; x < WIDTH; x++)
            right += each[y * WIDTH + x] / (HEIGHT * (WIDTH - WIDTH / 2 - 2.0));
    }
    double h = WIDTH / 2 / (double)WIDTH, mean = h + 2.5 * (1.0 - h);
    double low = (1.0 / mean - 0.1) / 0.9, high = (2.5 / mean - 0.1) / 0.9;
    double error = (h * mean + (1.0 - h) * mean * 10.0) / (h + (1.0 - h) * 25.0);
    double cost = (h / mean + (1.0 - h) * 10.0 / mean) / (h + (1.0 - h) * 4.0);
    print_message("%.3f and %.3f samples, exact %.3f and %.3f; predicted %.3f, exact "
                  "%.3f\n",
                  left, right, SAMPLE_MAP_MEAN * low, SAMPLE_MAP_MEAN * high, predicted,
                  error * cost);
    /* The seam moves the mean root by less than a fiftieth. */
    assert_true(fabs(left / (SAMPLE_MAP_MEAN * low) - 1.0) < 0.02);
    assert_true(fabs(right / (SAMPLE_MAP_MEAN * high) - 1.0) < 0.02);
    assert_true(fabs(predicted - error * cost) < 0.02);
    assert_in_range(sum_of(each), SAMPLE_MAP_MEAN * PIXELS - 2,
                    SAMPLE_MAP_MEAN * PIXELS + 2);
}

static void random_start(float *errors, float *work, struct rng *rng)
{
    for (int i = 0; i < PIXELS; i++) {
        double slope = 0.1 + i % WIDTH / (double)WIDTH, u = rng_double(rng);
        errors[i] = (float)(slope * slope / (0.1 + u));
        work[i] = (float)(1.0 + rng_double(rng));
    }
}

/* Nothing to adapt to. */
static void fill_with_noise(float *errors, int colour, struct rng *rng)
{
    for (int i = 0; i < PIXELS; i++)
        if (sample_map_colour(i % WIDTH, i / WIDTH) == colour)
            errors[i] = (float)(1e-4 / pow(1e-6 + rng_double(rng), 1.5));
}

static void no_pixel_decides_about_its_colour(void **state)
{
    (void)state;
    float errors[PIXELS], others[PIXELS], work[PIXELS], other_work[PIXELS];
    uint32_t each[PIXELS], again[PIXELS];
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 3);
    int adapted = 0;
    for (int round = 0; round < 200; round++) {
        random_start(errors, work, &rng);
        random_start(others, other_work, &rng);
        int colour = round % 2;
        if (round % 4 >= 2) { /* the other colour is noise, its own once */
            fill_with_noise(errors, 1 - colour, &rng);
            fill_with_noise(others, colour, &rng);
        }
        make(errors, work, WIDTH, HEIGHT, 8 + round, each);
        for (int i = 0; i < PIXELS; i++)
            if (sample_map_colour(i % WIDTH, i / WIDTH) == colour) {
                errors[i] = others[i];
                work[i] = other_work[i];
            }
        make(errors, work, WIDTH, HEIGHT, 8 + round, again);
        for (int i = 0; i < PIXELS; i++) {
            if (sample_map_colour(i % WIDTH, i / WIDTH) == colour)
                assert_int_equal(each[i], again[i]);
            adapted += each[i] != SAMPLE_MAP_MEAN;
        }
    }
    assert_true(adapted > 60 * PIXELS);
}

/* Heavy-tailed noise without any structure is no reason to adapt. */
static void noise_is_left_alone(void **state)
{
    (void)state;
    float errors[PIXELS];
    uint32_t each[PIXELS];
    struct rng rng;
    int left = 0;
    rng_init(&rng, 1, RNG_TEST, 4);
    for (int round = 0; round < 50; round++) {
        for (int i = 0; i < PIXELS; i++)
            errors[i] = (float)(1e-4 / pow(1e-6 + rng_double(&rng), 1.5));
        double predicted = make(errors, equal_work(), WIDTH, HEIGHT, 16, each);
        assert_true(predicted <= 1.0);
        left += predicted == 1.0;
    }
    print_message("%d of 50 left alone\n", left);
    assert_true(left >= 45);
}

static void films_of_any_size(void **state)
{
    (void)state;
    const int sizes[][2] = {{1, 1}, {1, 7}, {9, 1}, {2, 2}, {3, 2}};
    float errors[16];
    uint32_t each[16];
    for (int k = 0; k < 5; k++) {
        int pixels = sizes[k][0] * sizes[k][1];
        for (int i = 0; i < pixels; i++)
            errors[i] = (float)(1 + i % 3);
        double predicted = make(errors, equal_work(), sizes[k][0], sizes[k][1], 8, each);
        assert_true(predicted > 0.0 && predicted <= 1.0);
        for (int i = 0; i < pixels; i++)
            assert_true(each[i] >= 1 &&
                        each[i] <= SAMPLE_MAP_MEAN * (SAMPLE_MAP_MOST + 1.0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_errors_get_equal_samples),
        cmocka_unit_test(samples_follow_the_root),
        cmocka_unit_test(no_pixel_decides_about_its_colour),
        cmocka_unit_test(noise_is_left_alone),
        cmocka_unit_test(films_of_any_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
