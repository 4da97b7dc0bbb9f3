#include "image/noise.h"

#include "base/mem.h"
#include "image/metric.h"
#include "math/accum.h"
#include "math/rgb.h"

#include <math.h>

/* Mean of the finite neighbours; NaN if there is none. */
static double neighbour_mean(const struct image *image, int x, int y, int channel)
{
    double sum = 0.0;
    int count = 0;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < image->height; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < image->width; u++) {
            double value = (double)image_at(image, u, v)[channel];
            if ((u == x && v == y) || !isfinite(value))
                continue;
            sum += value;
            count++;
        }
    return count > 0 ? sum / count : (double)NAN;
}

double noise_weight(const struct image *mean, int x, int y, int channel)
{
    double own = (double)image_at(mean, x, y)[channel];
    double around = neighbour_mean(mean, x, y, channel);
    double q = isnan(around) ? own : fmax(around, 0.5 * own);
    return 1.0 / (q * q + METRIC_RELATIVE_FLOOR);
}

/* Mean over channels of w d^2; adds the channels' d^2 to *squares. */
static double pixel_noise(const struct image *half, const struct image *mean, int x,
                          int y, struct accum *squares)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        double d = (double)image_at(half, x, y)[c] - (double)image_at(mean, x, y)[c];
        accum_add(squares, d * d);
        sum += noise_weight(mean, x, y, c) * d * d;
    }
    return sum / 3.0;
}

/* Of the mean of independent values, of each of which one was drawn: from their squares,
 * as E[e^2] >= Var e. */
static double se_of_mean(const double *e, long count)
{
    struct accum squares = {0};
    for (long i = 0; i < count; i++)
        accum_add(&squares, e[i] * e[i]);
    return sqrt(accum_value(&squares)) / (double)count;
}

bool noise_of_mean(const struct image *half, const struct image *mean,
                   struct noise *noise, struct err *err)
{
    *noise = (struct noise){0};
    if (!metric_check_sizes(half, mean, err))
        return false;
    double *pixels = mem_alloc((size_t)half->width * (size_t)half->height,
                               sizeof *pixels);
    struct accum squares = {0};
    long count = 0;
    for (int y = 0; y < half->height; y++)
        for (int x = 0; x < half->width; x++) {
            long at = (long)y * half->width + x;
            if (rgb_is_finite(image_pixel(half, at)) &&
                rgb_is_finite(image_pixel(mean, at)))
                pixels[count++] = pixel_noise(half, mean, x, y, &squares);
        }
    if (count > 0) {
        noise->rmse = sqrt(accum_value(&squares) / (3.0 * (double)count));
        noise->relmse_se = se_of_mean(pixels, count);
        metric_means(pixels, count, &noise->relmse, &noise->relmse_trimmed);
    } else {
        err_set(err, ERR_VALUE, NULL, "no pixel is finite in both pictures");
    }
    mem_free(pixels);
    return count > 0;
}
