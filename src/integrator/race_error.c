#include "integrator/race_error.h"

#include "base/mem.h"
#include "integrator/guess.h"

#include <math.h>

#define BLOCKS 600.0 /* at least */
/* Blurs the guess over 5 x 5 pixels (guess.c) however many samples it has: over 3 x 3 of
 * them rare bright samples would still decide their own weight. */
#define GUESS_SAMPLES 0.64

static bool guesses(const struct race_halves *halves)
{
    return halves->independent && halves->samples > 0.0;
}

static double sum_of(const float *picture, long pixels)
{
    double sum = 0.0;
    for (long j = 0; j < pixels; j++)
        sum += (double)picture[j];
    return sum;
}

void race_level(const struct race_halves *halves, int count, long pixels)
{
    double sum = 0.0, pictures = 0.0;
    for (int i = 0; i < 2 * count; i++)
        if (guesses(&halves[i / 2])) {
            sum += sum_of(halves[i / 2].picture[i % 2], pixels);
            pictures += 1.0;
        }
    for (int i = 0; i < 2 * count; i++) {
        float *picture = halves[i / 2].picture[i % 2];
        double own = sum_of(picture, pixels);
        if (halves[i / 2].independent || !(own > 0.0) || !(sum > 0.0))
            continue;
        for (long j = 0; j < pixels; j++)
            picture[j] = (float)((double)picture[j] * (sum / (pictures * own)));
    }
}

/* Mean of the independent halves, and its mean over the pixels. */
static double *mean_picture(const struct race_halves *halves, int count, long pixels,
                            double *mean)
{
    double pictures = 0.0;
    double *picture = mem_alloc((size_t)pixels, sizeof *picture);
    for (int i = 0; i < 2 * count; i++)
        pictures += guesses(&halves[i / 2]);
    for (int i = 0; i < 2 * count; i++)
        for (long j = 0; guesses(&halves[i / 2]) && j < pixels; j++)
            picture[j] += (double)halves[i / 2].picture[i % 2][j] / pictures;
    *mean = 0.0;
    for (long j = 0; j < pixels; j++)
        *mean += picture[j] / (double)pixels;
    return picture;
}

void race_weigh(const struct race_halves *halves, int count, int width, int height,
                double floor, float *scale)
{
    long pixels = (long)width * height;
    double mean, *picture = mean_picture(halves, count, pixels, &mean);
    guess_weigh(picture, width, height, GUESS_SAMPLES * (double)pixels,
                mean > 0.0 ? fmin(floor, mean * mean) : floor, scale);
    mem_free(picture);
}

double race_draws_error(const struct race_halves *halves, int count, long pixels,
                        const float *scale)
{
    double mean, sum = 0.0, *picture = mean_picture(halves, count, pixels, &mean);
    for (long j = 0; j < pixels; j++)
        sum += mean * picture[j] * (double)scale[j] * (double)scale[j];
    mem_free(picture);
    return sum / ((double)pixels * (double)pixels);
}

/* Rows and columns beyond the last whole block are left out. */
static double block_error(const struct race_halves *halves, int width, int height,
                          const float *scale)
{
    int side = (int)fmax(sqrt((double)width * height / BLOCKS), 1.0);
    side = side < width && side < height ? side : 1;
    int across = width / side, count = across * (height / side);
    double sum = 0.0, pixels = (double)width * height;
    for (int i = 0; i < count; i++) {
        double d = 0.0;
        for (int k = 0; k < side * side; k++) {
            int x = i % across * side + k % side, y = i / across * side + k / side;
            long j = (long)y * width + x;
            d += (double)scale[j] *
                 ((double)halves->picture[0][j] - (double)halves->picture[1][j]);
        }
        sum += 0.25 * d * d / (pixels * side * side);
    }
    return sum / count;
}

void race_errors(const struct race_halves *halves, int count, int width, int height,
                 const float *scale, double *errors)
{
    for (int k = 0; k < count; k++)
        errors[k] = halves[k].samples > 0.0
                        ? block_error(&halves[k], width, height, scale)
                        : (double)NAN;
}
