#include "image/metric.h"

#include "base/mem.h"
#include "math/accum.h"
#include "math/order.h"
#include "math/rgb.h"

#include <math.h>

/* Sums over the pixels that are finite in both pictures. */
struct sums {
    struct accum a[3], reference[3], squares, symmetric;
    double *errors; /* relative squared error of each pixel */
    long count;
};

/* A picture that says no place, such as that of another renderer, has any. */
static bool says_place(const struct image *image)
{
    return image->width != image->whole_width || image->height != image->whole_height;
}

bool metric_check_sizes(const struct image *a, const struct image *b, struct err *err)
{
    if (a->width != b->width || a->height != b->height)
        return err_set(err, ERR_VALUE, NULL,
                       "the pictures differ in size: %dx%d against %dx%d", a->width,
                       a->height, b->width, b->height);
    if (says_place(a) && says_place(b) && (a->x != b->x || a->y != b->y))
        return err_set(err, ERR_VALUE, NULL,
                       "the pictures are different crops, from (%d, %d) and (%d, %d)",
                       a->x, a->y, b->x, b->y);
    return true;
}

static void add_pixel(struct sums *sums, struct rgb a, struct rgb r)
{
    const double av[3] = {a.r, a.g, a.b}, rv[3] = {r.r, r.g, r.b};
    double error = 0.0;
    for (int c = 0; c < 3; c++) {
        double square = (av[c] - rv[c]) * (av[c] - rv[c]);
        accum_add(&sums->a[c], av[c]);
        accum_add(&sums->reference[c], rv[c]);
        accum_add(&sums->squares, square);
        accum_add(&sums->symmetric, fabs(av[c] - rv[c]) / (fabs(av[c]) + fabs(rv[c]) +
                                                           METRIC_RELATIVE_FLOOR));
        error += square / (rv[c] * rv[c] + METRIC_RELATIVE_FLOOR); /* relMSE, metric.h */
    }
    sums->errors[sums->count++] = error / 3.0;
}

static double mean(const double *x, long count)
{
    struct accum sum = {0};
    for (long i = 0; i < count; i++)
        accum_add(&sum, x[i]);
    return accum_value(&sum) / (double)count;
}

void metric_means(double *errors, long count, double *all, double *trimmed)
{
    sort_ascending(errors, (size_t)count);
    *all = mean(errors, count);
    *trimmed = mean(errors, count - count / METRIC_TRIM);
}

static void finish(struct sums *sums, struct metric *metric)
{
    struct rgb a = rgb(accum_value(&sums->a[0]), accum_value(&sums->a[1]),
                       accum_value(&sums->a[2]));
    struct rgb r = rgb(accum_value(&sums->reference[0]), accum_value(&sums->reference[1]),
                       accum_value(&sums->reference[2]));
    metric->mean_ratio = rgb_luminance(a) / rgb_luminance(r);
    metric->mean_ratio_r = a.r / r.r;
    metric->mean_ratio_g = a.g / r.g;
    metric->mean_ratio_b = a.b / r.b;
    metric->rmse = sqrt(accum_value(&sums->squares) / (3.0 * (double)sums->count));
    metric->smape = accum_value(&sums->symmetric) / (3.0 * (double)sums->count);
    metric_means(sums->errors, sums->count, &metric->relmse, &metric->relmse_trimmed);
}

bool metric_compare(const struct image *a, const struct image *reference,
                    struct metric *metric, struct err *err)
{
    *metric = (struct metric){0};
    if (!metric_check_sizes(a, reference, err))
        return false;
    long pixels = (long)a->width * a->height;
    struct sums sums = {.errors = mem_alloc((size_t)pixels, sizeof(double))};
    for (long i = 0; i < pixels; i++) {
        struct rgb pa = image_pixel(a, i), pr = image_pixel(reference, i);
        if (rgb_is_finite(pa) && rgb_is_finite(pr))
            add_pixel(&sums, pa, pr);
    }
    metric->nonfinite = pixels - sums.count;
    bool ok = sums.count > 0;
    if (ok)
        finish(&sums, metric);
    else
        err_set(err, ERR_VALUE, NULL, "no pixel is finite in both pictures");
    mem_free(sums.errors);
    return ok;
}

static double mean_luminance(const struct image *image)
{
    struct accum sum = {0};
    long pixels = (long)image->width * image->height, count = 0;
    for (long i = 0; i < pixels; i++) {
        double luminance = rgb_luminance(image_pixel(image, i));
        if (!isfinite(luminance))
            continue;
        accum_add(&sum, luminance);
        count++;
    }
    return count ? accum_value(&sum) / (double)count : 0.0;
}

struct image *metric_difference(const struct image *a, const struct image *b,
                                double range, struct err *err)
{
    if (!metric_check_sizes(a, b, err))
        return NULL;
    if (!(range > 0.0)) {
        err_set(err, ERR_VALUE, NULL, "the range of a difference must be positive");
        return NULL;
    }
    struct image *out = image_create_like(a);
    double offset = 0.1 * fabs(mean_luminance(b));
    for (long i = 0; i < (long)a->width * a->height; i++) {
        float *p = out->pixels + 3 * i;
        double la = rgb_luminance(image_pixel(a, i)),
               lb = rgb_luminance(image_pixel(b, i));
        if (!isfinite(la) || !isfinite(lb)) {
            p[1] = 1.0f;
            continue;
        }
        /* 0/0, black against black, is no difference: fmax ignores a NaN. */
        double d = (la - lb) / (fabs(lb) + offset) / range;
        p[0] = (float)fmin(fmax(d, 0.0), 1.0);
        p[2] = (float)fmin(fmax(-d, 0.0), 1.0);
    }
    return out;
}
