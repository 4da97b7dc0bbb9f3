#include "integrator/race_error.h"

#include "base/mem.h"
#include "integrator/guess.h"
#include "math/accum.h"

#include <math.h>

#define TILES  8     /* of the film, each way */
#define SURE   3.0   /* standard errors */
#define BLOCKS 600.0 /* at least */
/* Blurs the guess over 5 x 5 pixels (guess.c) however many samples it has: over 3 x 3 of
 * them rare bright samples would still decide their own weight. */
#define GUESS_SAMPLES 0.64

static void add_light(const struct race_halves *halves, int count, long pixels,
                      struct race_light *light)
{
    for (int k = 0; k < count; k++) {
        if (!halves[k].independent || !(halves[k].samples > 0.0))
            continue;
        for (long j = 0; j < pixels; j++)
            light->sum[j] += (double)halves[k].picture[0][j] +
                             (double)halves[k].picture[1][j];
        light->halves += 2.0;
    }
}

/* The weights of relMSE. */
static void weigh_pixels(const struct race_light *light, int width, int height,
                         double floor, float *scale)
{
    long pixels = (long)width * height;
    double mean = 0.0, *picture = mem_alloc((size_t)pixels, sizeof *picture);
    for (long j = 0; j < pixels; j++) {
        picture[j] = light->sum[j] / light->halves;
        mean += picture[j] / (double)pixels;
    }
    guess_weigh(picture, width, height, GUESS_SAMPLES * (double)pixels,
                mean > 0.0 ? fmin(floor, mean * mean) : floor, scale);
    mem_free(picture);
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

static bool is_black(const struct race_halves *halves, long pixels)
{
    for (int half = 0; half < 2; half++)
        for (long j = 0; j < pixels; j++)
            if (halves->picture[half][j] > 0.0f)
                return false;
    return true;
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

/* Holds one method against the mean of the other independent samples. A black picture
 * lacks everything. */
static double missing_of(const struct race_halves *halves, int count, int which,
                         int width, int height, double floor)
{
    double tile = (double)width * height / (TILES * TILES), sum = 0.0;
    struct tiles own = {0}, others = {0};
    if (is_black(&halves[which], (long)width * height))
        return 1.0;
    for (int i = 0; i < count; i++)
        sum += i != which && halves[i].independent ? halves[i].samples : 0.0;
    if (!(sum > 0.0))
        return 0.0;
    add_tiles(&halves[which], width, height, 1.0, &own);
    for (int i = 0; i < count; i++)
        if (i != which && halves[i].independent && halves[i].samples > 0.0)
            add_tiles(&halves[i], width, height, halves[i].samples / sum, &others);
    return missing(&own, &others, floor * tile * tile);
}

/* --- all of them ------------------------------------------------------------------- */

void race_errors(const struct race_halves *halves, int count, int width, int height,
                 double floor, struct race_light *light, struct race_error *out)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *scale = mem_alloc(pixels, sizeof *scale);
    add_light(halves, count, (long)pixels, light);
    if (light->halves > 0.0)
        weigh_pixels(light, width, height, floor, scale);
    for (int k = 0; k < count; k++)
        if (halves[k].samples > 0.0)
            out[k] = (struct race_error){
                .relmse = block_error(&halves[k], width, height, scale),
                .missing = missing_of(halves, count, k, width, height, floor)};
    mem_free(scale);
}
