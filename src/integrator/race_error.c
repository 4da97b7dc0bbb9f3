#include "integrator/race_error.h"

#include "base/mem.h"
#include "integrator/guess.h"
#include "image/metric.h"
#include "math/accum.h"

#include <math.h>

#define TILES 12  /* of the film, each way */
#define SURE  3.0 /* standard errors */

struct scratch {
    double *picture, *errors; /* [pixels] */
    float *scale;             /* [pixels] */
};

static double all_samples(const struct race_halves *halves, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++)
        sum += halves[k].samples;
    return sum;
}

/* Mean of the pictures, weighted by samples, blurred; the weights of relMSE. */
static void weigh_pixels(const struct race_halves *halves, int count, double samples,
                         int width, int height, double floor, struct scratch *s)
{
    long pixels = (long)width * height;
    double mean = 0.0;
    for (long j = 0; j < pixels; j++) {
        s->picture[j] = 0.0;
        for (int k = 0; k < count; k++)
            if (halves[k].samples > 0.0)
                s->picture[j] += 0.5 * halves[k].samples / samples *
                                 ((double)halves[k].picture[0][j] +
                                  (double)halves[k].picture[1][j]);
        mean += s->picture[j] / (double)pixels;
    }
    guess_weigh(s->picture, width, height, samples, fmin(floor, mean * mean), s->scale);
}

static struct race_error error_of(const struct race_halves *halves, long pixels,
                                  struct scratch *s)
{
    struct race_error error = {0};
    for (long j = 0; j < pixels; j++) {
        double d = 0.5 * (double)s->scale[j] / sqrt((double)pixels) *
                   ((double)halves->picture[0][j] - (double)halves->picture[1][j]);
        s->errors[j] = d * d;
    }
    metric_means(s->errors, pixels, &error.full, &error.trimmed);
    return error;
}

/* --- missing light ----------------------------------------------------------------- */

/* Sums over tiles of the two halves of a picture. */
struct tiles {
    double sum[2][TILES * TILES];
};

static void add_tiles(const struct race_halves *halves, int width, int height,
                      double weight, struct tiles *tiles)
{
    for (int half = 0; half < 2; half++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                tiles->sum[half][y * TILES / height * TILES + x * TILES / width] +=
                    weight * (double)halves->picture[half][(long)y * width + x];
}

/* Mean over the tiles where A is darker than R of (A - R)^2, less half of the variances
 * of A and R, which their halves give, relative to R^2 + e^2. Without missing light half
 * of the tiles are darker by chance, and the mean is 0. */
static double missing(const struct tiles *a, const struct tiles *r, double dark)
{
    struct welford sum = {0};
    for (int i = 0; i < TILES * TILES; i++) {
        double d = 0.5 * (a->sum[0][i] + a->sum[1][i] - r->sum[0][i] - r->sum[1][i]);
        double da = 0.5 * (a->sum[0][i] - a->sum[1][i]);
        double dr = 0.5 * (r->sum[0][i] - r->sum[1][i]);
        double mean = 0.5 * (r->sum[0][i] + r->sum[1][i]);
        double square = d < 0.0 ? d * d : 0.0;
        welford_add(&sum, (square - 0.5 * (da * da + dr * dr)) / (mean * mean + dark));
    }
    return sum.mean > SURE * welford_se(&sum) ? sum.mean : 0.0;
}

/* Holds each method against the mean of the others, weighted by samples. */
static void find_missing(const struct race_halves *halves, int count, int width,
                         int height, double floor, struct race_error *out)
{
    double tile = (double)width * height / (TILES * TILES);
    for (int k = 0; k < count; k++) {
        struct tiles own = {0}, others = {0};
        double sum = 0.0;
        for (int i = 0; i < count; i++)
            sum += i != k ? halves[i].samples : 0.0;
        if (!(halves[k].samples > 0.0) || !(sum > 0.0))
            continue;
        add_tiles(&halves[k], width, height, 1.0, &own);
        for (int i = 0; i < count; i++)
            if (i != k && halves[i].samples > 0.0)
                add_tiles(&halves[i], width, height, halves[i].samples / sum, &others);
        out[k].missing = missing(&own, &others, floor * tile * tile);
    }
}

/* --- all of them ------------------------------------------------------------------- */

void race_errors(const struct race_halves *halves, int count, int width, int height,
                 double floor, struct race_error *out)
{
    size_t pixels = (size_t)width * (size_t)height;
    double samples = all_samples(halves, count);
    struct scratch s = {mem_alloc(pixels, sizeof(double)),
                        mem_alloc(pixels, sizeof(double)),
                        mem_alloc(pixels, sizeof(float))};
    if (samples > 0.0) {
        weigh_pixels(halves, count, samples, width, height, floor, &s);
        for (int k = 0; k < count; k++)
            if (halves[k].samples > 0.0)
                out[k] = error_of(&halves[k], (long)pixels, &s);
    }
    find_missing(halves, count, width, height, floor, out);
    mem_free(s.picture);
    mem_free(s.errors);
    mem_free(s.scale);
}
