#include "analysis/analysis_split.h"

#include "analysis/pixel_blocks.h"
#include "base/mem.h"
#include "image/metric.h"
#include "image/noise.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>

/* Weighted sums over pixels and channels, of all pictures and without each of them. */
struct sums {
    const struct image *const *pictures;
    const struct image *reference;
    size_t n;
    struct accum variance, offset;                     /* <s^2>, <(m-r)^2> */
    struct accum *variances_without, *offsets_without; /* [n] */
    struct accum *errors;                              /* [n], <(x-r)^2> of each */
    struct pixel_blocks variance_blocks, bias_blocks;
    long pixels, nonfinite;
};

/* Of one pixel in one channel, weighted. */
struct terms {
    double variance, offset;
};

/* d: the differences of all pictures from the reference there. */
static struct terms add_channel(struct sums *sums, double weight, const double *d)
{
    double n = (double)sums->n, mean = 0.0, squares = 0.0;
    for (size_t i = 0; i < sums->n; i++) {
        mean += d[i] / n;
        accum_add(&sums->errors[i], weight * d[i] * d[i]);
    }
    for (size_t i = 0; i < sums->n; i++)
        squares += (d[i] - mean) * (d[i] - mean);
    struct terms terms = {weight * squares / (n - 1.0), weight * mean * mean};
    accum_add(&sums->variance, terms.variance);
    accum_add(&sums->offset, terms.offset);
    for (size_t i = 0; sums->n >= 3 && i < sums->n; i++) {
        double away = d[i] - mean, without = mean - away / (n - 1.0);
        double rest = squares - away * away * n / (n - 1.0);
        accum_add(&sums->variances_without[i], weight * rest / (n - 2.0));
        accum_add(&sums->offsets_without[i], weight * without * without);
    }
    return terms;
}

static bool pixel_is_finite(const struct sums *sums, int x, int y)
{
    for (size_t c = 0; c < 3; c++) {
        if (!isfinite(image_at(sums->reference, x, y)[c]))
            return false;
        for (size_t i = 0; i < sums->n; i++)
            if (!isfinite(image_at(sums->pictures[i], x, y)[c]))
                return false;
    }
    return true;
}

static void add_pixel(struct sums *sums, int x, int y, double *d)
{
    double n = (double)sums->n;
    for (int c = 0; c < 3; c++) {
        double r = (double)image_at(sums->reference, x, y)[c];
        for (size_t i = 0; i < sums->n; i++)
            d[i] = (double)image_at(sums->pictures[i], x, y)[c] - r;
        struct terms terms = add_channel(sums, noise_weight(sums->reference, x, y, c), d);
        pixel_blocks_add(&sums->variance_blocks, x, y, terms.variance);
        pixel_blocks_add(&sums->bias_blocks, x, y, terms.offset - terms.variance / n);
    }
}

static void add_pixels(struct sums *sums)
{
    double *d = mem_alloc(sums->n, sizeof *d);
    for (int y = 0; y < sums->reference->height; y++)
        for (int x = 0; x < sums->reference->width; x++) {
            bool finite = pixel_is_finite(sums, x, y);
            sums->pixels += finite;
            sums->nonfinite += !finite;
            if (finite)
                add_pixel(sums, x, y, d);
        }
    mem_free(d);
}

/* --- from sums to figures -------------------------------------------------------- */

static double mean_of(const struct sums *sums, const struct accum *sum)
{
    return accum_value(sum) / (3.0 * (double)sums->pixels);
}

/* Standard error from the values that are left without each seed in turn. */
static double jackknife(const double *without, size_t n)
{
    struct welford w = {0};
    for (size_t i = 0; i < n; i++)
        welford_add(&w, without[i]);
    double count = (double)n;
    return sqrt(w.m2 * (count - 1.0) / count);
}

static void take_total(const struct sums *sums, struct analysis_split *split)
{
    struct welford errors = {0};
    for (size_t i = 0; i < sums->n; i++)
        welford_add(&errors, mean_of(sums, &sums->errors[i]));
    split->total = errors.mean;
    split->total_se = welford_se(&errors);
}

static void take_errors_from_seeds(const struct sums *sums, struct analysis_split *split)
{
    double n = (double)sums->n;
    double *bias = mem_alloc(sums->n, sizeof *bias);
    double *variance = mem_alloc(sums->n, sizeof *variance);
    for (size_t i = 0; i < sums->n; i++) {
        variance[i] = mean_of(sums, &sums->variances_without[i]);
        bias[i] = mean_of(sums, &sums->offsets_without[i]) - variance[i] / (n - 1.0);
    }
    split->variance_se = jackknife(variance, sums->n);
    split->bias2_se = jackknife(bias, sums->n);
    mem_free(bias);
    mem_free(variance);
}

static void take_errors_from_blocks(const struct sums *sums, struct analysis_split *split)
{
    double values = 3.0 * (double)sums->pixels;
    split->variance_se = pixel_blocks_se(&sums->variance_blocks) / values;
    split->bias2_se = pixel_blocks_se(&sums->bias_blocks) / values;
    split->errors_from_blocks = true;
}

/* The noise that the reference really has and the one that its halves tell are
 * independent (m - t and d are uncorrelated) and have about the same spread. With two
 * seeds the blocks have seen the former. */
static void add_error_of_noise(struct analysis_split *split, double noise_se)
{
    double times = split->errors_from_blocks ? 1.0 : 2.0;
    if (isfinite(noise_se))
        split->bias2_se = sqrt(split->bias2_se * split->bias2_se +
                               times * noise_se * noise_se);
}

static void finish(const struct sums *sums, double noise_se, struct analysis_split *split)
{
    double n = (double)sums->n, freedom = n - 1.0;
    split->variance = mean_of(sums, &sums->variance);
    split->bias2 = mean_of(sums, &sums->offset) - split->variance / n - split->noise;
    take_total(sums, split);
    if (sums->n < ANALYSIS_SPLIT_SEEDS)
        take_errors_from_blocks(sums, split);
    else
        take_errors_from_seeds(sums, split);
    add_error_of_noise(split, noise_se);
    if (split->errors_from_blocks)
        return; /* what all pixels share is not in the error: no test */
    split->bias2_hi = split->bias2 + student_quantile(0.975, freedom) * split->bias2_se;
    split->bias_is_significant = split->bias2 >
                                 student_quantile(0.95, freedom) * split->bias2_se;
}

static bool check_sizes(const struct image *const *pictures, size_t n,
                        const struct image *reference, struct err *err)
{
    for (size_t i = 0; i < n; i++)
        if (!metric_check_sizes(pictures[i], reference, err))
            return false;
    return true;
}

static void sums_init(struct sums *sums, const struct image *const *pictures, size_t n,
                      const struct image *reference)
{
    *sums = (struct sums){.pictures = pictures, .reference = reference, .n = n};
    sums->variances_without = mem_alloc(n, sizeof(struct accum));
    sums->offsets_without = mem_alloc(n, sizeof(struct accum));
    sums->errors = mem_alloc(n, sizeof(struct accum));
    pixel_blocks_init(&sums->variance_blocks, reference->width, reference->height);
    pixel_blocks_init(&sums->bias_blocks, reference->width, reference->height);
}

static void sums_deinit(struct sums *sums)
{
    mem_free(sums->variances_without);
    mem_free(sums->offsets_without);
    mem_free(sums->errors);
    pixel_blocks_deinit(&sums->variance_blocks);
    pixel_blocks_deinit(&sums->bias_blocks);
}

bool analysis_split_pictures(const struct image *const *pictures, size_t n,
                             const struct image *reference, const struct noise *noise,
                             struct analysis_split *split, struct err *err)
{
    const double nan = (double)NAN;
    struct sums sums;
    bool known = noise && isfinite(noise->relmse);
    *split = (struct analysis_split){nan, nan, nan, nan, nan, nan, .bias2_hi = nan};
    split->noise_is_known = known;
    split->noise = known ? noise->relmse : 0.0;
    split->seeds = n;
    if (n < 2)
        return err_set(err, ERR_VALUE, NULL, "not enough seeds: two are needed");
    if (!check_sizes(pictures, n, reference, err))
        return false;
    sums_init(&sums, pictures, n, reference);
    add_pixels(&sums);
    split->nonfinite = sums.nonfinite;
    bool ok = sums.pixels > 0;
    if (ok)
        finish(&sums, known ? noise->relmse_se : (double)NAN, split);
    else
        err_set(err, ERR_VALUE, NULL, "no pixel is finite in all pictures");
    sums_deinit(&sums);
    return ok;
}

/* --- from the folder ------------------------------------------------------------- */

static bool read_reference(const struct results *results, const struct results_cell *cell,
                           struct reference *reference, struct err *err)
{
    if (cell->reference[0] == '\0') {
        err_set(err, ERR_VALUE, NULL, "the table does not name the reference picture");
        return false;
    }
    char *path = text_join(results->folder, cell->reference);
    bool ok = reference_read(path, NULL, reference, err);
    mem_free(path);
    return ok;
}

bool analysis_split_cell(const struct results *results, const struct results_cell *cell,
                         const struct reference *reference, struct analysis_split *split,
                         struct err *err)
{
    struct reference own = {0};
    *split = (struct analysis_split){0};
    if (reference == NULL && !read_reference(results, cell, &own, err))
        return false;
    reference = reference ? reference : &own;
    struct image **pictures = mem_alloc(cell->run_count, sizeof(struct image *));
    bool ok = results_read_pictures(results, cell, pictures, err) &&
              analysis_split_pictures((const struct image *const *)pictures,
                                      cell->run_count, reference->picture,
                                      &reference->noise, split, err);
    for (size_t i = 0; i < cell->run_count; i++)
        image_destroy(pictures[i]);
    mem_free(pictures);
    reference_deinit(&own);
    return ok;
}
