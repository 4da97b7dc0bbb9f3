/* The weights of pixels: a tile with many samples has its own brightness, one without
 * samples that of its surroundings and not black; the mean of the picture is kept; tiles
 * at the edges of sizes that are no multiple of them. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/tours_light.h"
#include "math/rng.h"

#include <math.h>

#define WIDTH  50
#define HEIGHT 31
#define PIXELS (WIDTH * HEIGHT)
#define FLOOR  0.01

static double scale[PIXELS], mean[PIXELS]; /* of the pixels' tiles */

/* The left half has brightness 4, the right one .2; a pixel is drawn with probability
 * `share` and has `samples` then. */
static void draw(double share, int samples)
{
    struct rng rng;
    double sum = 0.0;
    rng_init(&rng, 6, RNG_TEST, 0);
    struct tours_light *light = tours_light_create(WIDTH, HEIGHT);
    for (int j = 0; j < PIXELS; j++) {
        double y = (j % WIDTH < WIDTH / 2 ? 4.0 : 0.2) / share;
        if (rng_double(&rng) >= share)
            continue;
        for (int k = 0; k < samples; k++)
            tours_light_add_pixel(light, j, y / samples);
        sum += y;
    }
    double found = tours_light_weigh(light, FLOOR), square = 0.0;
    struct tours_pixels pixels = tours_light_pixels(light);
    for (int j = 0; j < PIXELS; j++) {
        int tile = tours_tile_of(&pixels, j);
        scale[j] = (double)pixels.scale[tile];
        mean[j] = (double)pixels.mean[tile];
        square += mean[j] * mean[j];
    }
    assert_true(fabs(found / (sum / PIXELS) - 1.0) < 1e-9);
    assert_true(fabs(square / tours_light_square(light) - 1.0) < 1e-5);
    tours_light_destroy(light);
}

/* Brightness that the weights of a pixel tell. */
static double brightness(int j)
{
    return mean[j] / scale[j] * PIXELS;
}

static void many_samples(void **state)
{
    (void)state;
    draw(1.0, 4000);
    for (int j = 0; j < PIXELS; j++) {
        int x = j % WIDTH;
        double y = x < WIDTH / 2 ? 4.0 : 0.2;
        if (x / 2 == WIDTH / 2 / 2)
            continue; /* this tile lies on the edge */
        assert_true(fabs(brightness(j) / y - 1.0) < 0.03);
        double w = scale[j] * scale[j] / PIXELS;
        assert_true(fabs(w * (y * y + FLOOR) - 1.0) < 0.06);
    }
}

/* With a sample in one of 50 pixels the sum of I^2 times the weight, which is 1 a pixel
 * where weights are right, is within a factor of 5 of it (2.0 and 3.6); without smoothing
 * it is 7.9 and hundreds. */
static void few_samples(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        double sum = 0.0;
        draw(k ? 0.02 : 0.1, 1);
        for (int j = 0; j < PIXELS; j++) {
            double y = j % WIDTH < WIDTH / 2 ? 4.0 : 0.2;
            sum += scale[j] * scale[j] / PIXELS * y * y / PIXELS;
        }
        print_message("%g\n", sum);
        assert_true(sum > 0.25 && sum < 5.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_samples),
        cmocka_unit_test(few_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
