#include "math/dist.h"

#include "base/mem.h"
#include "math/accum.h"
#include "math/warp.h"

/* Sums the weights divided by the power of two above the largest (exact, and no overflow
 * on the way) into cdf[]; returns that power's exponent in *exponent. False if the
 * weights do not make a distribution. */
static bool accumulate(const double *weights, int count, double *cdf, int *exponent)
{
    double max = 0.0;
    for (int i = 0; i < count; i++) {
        if (!(weights[i] >= 0.0) || isinf(weights[i]))
            return false;
        max = fmax(max, weights[i]);
    }
    frexp(max, exponent);
    struct accum sum = {0};
    cdf[0] = 0.0;
    for (int i = 0; i < count; i++) {
        accum_add(&sum, ldexp(weights[i], -*exponent));
        cdf[i + 1] = fmax(cdf[i], accum_value(&sum));
    }
    return max > 0.0;
}

static void build_guide(struct dist *dist)
{
    dist->buckets = 1;
    while (dist->buckets < dist->count && dist->buckets < 1 << 24)
        dist->buckets *= 2;
    dist->guide = mem_alloc((size_t)dist->buckets + 1, sizeof(int32_t));
    int i = 0;
    for (int k = 0; k < dist->buckets; k++) {
        while (dist->cdf[i + 1] <= (double)k / dist->buckets)
            i++;
        dist->guide[k] = i;
    }
    dist->guide[dist->buckets] = dist->count - 1;
}

bool dist_build(struct dist *dist, const double *weights, int count)
{
    *dist = (struct dist){0};
    if (count < 1)
        return false;
    double *cdf = mem_alloc((size_t)count + 1, sizeof(double));
    int exponent = 0;
    bool good = accumulate(weights, count, cdf, &exponent);
    double total = cdf[count], sum = ldexp(total, exponent);
    if (!good || isinf(sum)) {
        mem_free(cdf);
        return false;
    }
    for (int i = 1; i <= count; i++)
        cdf[i] /= total; /* exactly 1 from the last positive weight on */
    *dist = (struct dist){.count = count, .sum = sum, .cdf = cdf};
    build_guide(dist);
    return true;
}

void dist_deinit(struct dist *dist)
{
    mem_free(dist->cdf);
    mem_free(dist->guide);
    *dist = (struct dist){0};
}

double dist_pdf(const struct dist *dist, int index)
{
    return dist->cdf[index + 1] - dist->cdf[index];
}

int dist_sample(const struct dist *dist, double u, double *probability, double *rest)
{
    const double *cdf = dist->cdf;
    int bucket = (int)(u * dist->buckets); /* exact: a power of two */
    int lo = dist->guide[bucket], hi = dist->guide[bucket + 1] + 1;
    while (hi - lo > 1) { /* cdf[lo] <= u, and u < cdf[hi] */
        int mid = lo + (hi - lo) / 2;
        if (cdf[mid] <= u)
            lo = mid;
        else
            hi = mid;
    }
    *probability = cdf[lo + 1] - cdf[lo];
    if (rest) {
        double x = (u - cdf[lo]) / *probability;
        *rest = x < WARP_BELOW_ONE ? x : WARP_BELOW_ONE;
    }
    return lo;
}

bool dist_invert(const struct dist *dist, int index, double rest, double *u)
{
    double lo = dist->cdf[index], hi = dist->cdf[index + 1];
    *u = warp_within(lo, hi, rest);
    return lo < hi && rest >= 0.0 && rest < 1.0;
}

bool dist2_build(struct dist2 *dist, const double *weights, int width, int height)
{
    *dist = (struct dist2){0};
    if (width < 1 || height < 1)
        return false;
    dist->width = width;
    dist->height = height;
    dist->columns = mem_alloc((size_t)height, sizeof(struct dist));
    double *sums = mem_alloc((size_t)height, sizeof(double));
    bool good = true;
    for (int y = 0; y < height && good; y++) {
        const double *row = weights + (size_t)y * (size_t)width;
        bool black = true;
        for (int x = 0; x < width; x++)
            black = black && row[x] == 0.0;
        good = black || dist_build(&dist->columns[y], row, width);
        sums[y] = dist->columns[y].sum;
    }
    good = good && dist_build(&dist->rows, sums, height);
    mem_free(sums);
    if (!good)
        dist2_deinit(dist);
    return good;
}

void dist2_deinit(struct dist2 *dist)
{
    for (int y = 0; dist->columns && y < dist->height; y++)
        dist_deinit(&dist->columns[y]);
    mem_free(dist->columns);
    dist_deinit(&dist->rows);
    *dist = (struct dist2){0};
}

/* (cell + rest) / count, kept inside the cell that dist2_pdf will find again. */
static double cell_point(int cell, double rest, int count)
{
    double p = fmin((cell + rest) / count, WARP_BELOW_ONE);
    while ((int)(p * count) > cell)
        p = nextafter(p, 0.0);
    while ((int)(p * count) < cell)
        p = nextafter(p, 1.0);
    return p;
}

void dist2_sample(const struct dist2 *dist, const double u[2], double point[2],
                  double *pdf)
{
    double p_row, p_column, rest_row, rest_column;
    int y = dist_sample(&dist->rows, u[1], &p_row, &rest_row);
    int x = dist_sample(&dist->columns[y], u[0], &p_column, &rest_column);
    point[0] = cell_point(x, rest_column, dist->width);
    point[1] = cell_point(y, rest_row, dist->height);
    *pdf = p_row * p_column * dist->width * dist->height;
}

double dist2_pdf(const struct dist2 *dist, const double point[2])
{
    int x = (int)(point[0] * dist->width), y = (int)(point[1] * dist->height);
    if (x < 0 || y < 0 || x >= dist->width || y >= dist->height)
        return 0.0;
    double p_row = dist_pdf(&dist->rows, y);
    if (p_row == 0.0)
        return 0.0;
    return p_row * dist_pdf(&dist->columns[y], x) * dist->width * dist->height;
}

bool dist2_invert(const struct dist2 *dist, const double point[2], double u[2])
{
    double x = point[0] * dist->width, y = point[1] * dist->height;
    int column = (int)floor(x), row = (int)floor(y);
    if (!warp_in_square(point) || dist_pdf(&dist->rows, row) == 0.0)
        return false;
    return dist_invert(&dist->rows, row, y - row, &u[1]) &&
           dist_invert(&dist->columns[row], column, x - column, &u[0]);
}

size_t dist_bytes(const struct dist *dist)
{
    if (!dist->cdf)
        return 0;
    return ((size_t)dist->count + 1) * sizeof *dist->cdf +
           ((size_t)dist->buckets + 1) * sizeof *dist->guide;
}

size_t dist2_bytes(const struct dist2 *dist)
{
    size_t sum = dist_bytes(&dist->rows);
    for (int y = 0; dist->columns && y < dist->height; y++)
        sum += sizeof *dist->columns + dist_bytes(&dist->columns[y]);
    return sum;
}
