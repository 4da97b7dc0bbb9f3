#include "image/flip_filter.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

double flip_gaussian(struct flip_filter *filter, int radius, double sd)
{
    double sum = 0.0;
    filter->radius = radius;
    for (int x = -radius; x <= radius; x++)
        sum += exp(-0.5 * x * x / (sd * sd));
    for (int x = -radius; x <= radius; x++)
        filter->weights[x + radius] = (float)(exp(-0.5 * x * x / (sd * sd)) / sum);
    return sum;
}

void flip_derivative(struct flip_filter *filter, int radius, double sd, int order)
{
    double sums[2] = {0.0, 0.0}, w[2 * FLIP_RADIUS_MOST + 1] = {0.0};
    filter->radius = radius;
    for (int x = -radius; x <= radius; x++) {
        double g = exp(-0.5 * x * x / (sd * sd));
        double v = order == 1 ? -x * g : (x * x / (sd * sd) - 1.0) * g;
        sums[v < 0.0] += fabs(v);
        w[x + radius] = v;
    }
    for (int i = 0; i <= 2 * radius; i++)
        filter->weights[i] = (float)(w[i] / sums[w[i] < 0.0]);
}

static int clamped(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

/* Values that are summed at once, in registers. */
#define BLOCK 32

/* out[x] = sum over i of weights[i] * taps[i][x], for x below n, in the order of i. */
static void weigh(const struct flip_filter *filter,
                  const float *const taps[2 * FLIP_RADIUS_MOST + 1], int n, float *out)
{
    int x = 0;
    for (; x + BLOCK <= n; x += BLOCK) {
        float sums[BLOCK] = {0.0f};
        for (int i = 0; i <= 2 * filter->radius; i++)
            for (int b = 0; b < BLOCK; b++)
                /* NOLINTNEXTLINE(clang-analyzer-core.*): all taps are set */
                sums[b] += filter->weights[i] * taps[i][x + b];
        memcpy(out + x, sums, sizeof sums);
    }
    for (; x < n; x++) {
        out[x] = 0.0f;
        for (int i = 0; i <= 2 * filter->radius; i++)
            /* NOLINTNEXTLINE(clang-analyzer-core.*): all taps are set */
            out[x] += filter->weights[i] * taps[i][x];
    }
}

/* Rows; the border repeats. */
static void filter_rows(const struct flip_filter *filter, const float *in, int width,
                        int height, float *out)
{
    const float *taps[2 * FLIP_RADIUS_MOST + 1];
    float *row = mem_alloc((size_t)width + 2 * (size_t)filter->radius, sizeof *row);
    for (int i = 0; i <= 2 * filter->radius; i++)
        taps[i] = row + i;
    for (int y = 0; y < height; y++, in += width, out += width) {
        for (int x = -filter->radius; x < width + filter->radius; x++)
            row[x + filter->radius] = in[clamped(x, width)];
        weigh(filter, taps, width, out);
    }
    mem_free(row);
}

static void filter_columns(const struct flip_filter *filter, const float *in, int width,
                           int height, float *out)
{
    const float *taps[2 * FLIP_RADIUS_MOST + 1];
    for (int y = 0; y < height; y++, out += width) {
        for (int i = -filter->radius; i <= filter->radius; i++)
            taps[i + filter->radius] = in +
                                       (size_t)clamped(y + i, height) * (size_t)width;
        weigh(filter, taps, width, out);
    }
}

void flip_filter(const struct flip_filter *rows, const struct flip_filter *columns,
                 int width, int height, const float *in, float *scratch, float *out)
{
    filter_rows(rows, in, width, height, scratch);
    filter_columns(columns, scratch, width, height, out);
}
