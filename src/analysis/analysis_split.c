#include "analysis/analysis_split.h"

#include "base/mem.h"
#include "image/exr.h"
#include "image/metric.h"
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
    struct accum *errors;                              /* [n], relMSE of each */
    long pixels, nonfinite;
};

/* The differences of all pictures from the reference in one channel. */
static void add_channel(struct sums *sums, size_t at, double *d)
{
    double n = (double)sums->n, mean = 0.0, squares = 0.0;
    double r = (double)sums->reference->pixels[at];
    double weight = 1.0 / (r * r + METRIC_RELATIVE_FLOOR);
    for (size_t i = 0; i < sums->n; i++) {
        d[i] = (double)sums->pictures[i]->pixels[at] - r;
        mean += d[i] / n;
        accum_add(&sums->errors[i], weight * d[i] * d[i]);
    }
    for (size_t i = 0; i < sums->n; i++)
        squares += (d[i] - mean) * (d[i] - mean);
    accum_add(&sums->variance, weight * squares / (n - 1.0));
    accum_add(&sums->offset, weight * mean * mean);
    if (sums->n < 3)
        return;
    for (size_t i = 0; i < sums->n; i++) {
        double away = d[i] - mean, without = mean - away / (n - 1.0);
        double rest = squares - away * away * n / (n - 1.0);
        accum_add(&sums->variances_without[i], weight * rest / (n - 2.0));
        accum_add(&sums->offsets_without[i], weight * without * without);
    }
}

static bool pixel_is_finite(const struct sums *sums, size_t at)
{
    for (size_t c = 0; c < 3; c++) {
        if (!isfinite((double)sums->reference->pixels[at + c]))
            return false;
        for (size_t i = 0; i < sums->n; i++)
            if (!isfinite((double)sums->pictures[i]->pixels[at + c]))
                return false;
    }
    return true;
}

static void add_pixels(struct sums *sums)
{
    size_t count = (size_t)sums->reference->width * (size_t)sums->reference->height;
    double *d = mem_alloc(sums->n, sizeof *d);
    for (size_t i = 0; i < count; i++) {
        if (!pixel_is_finite(sums, 3 * i)) {
            sums->nonfinite++;
            continue;
        }
        sums->pixels++;
        for (size_t c = 0; c < 3; c++)
            add_channel(sums, 3 * i + c, d);
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
    return n < 3 ? (double)NAN : sqrt(w.m2 * (count - 1.0) / count);
}

static void take_errors(const struct sums *sums, struct analysis_split *split)
{
    double n = (double)sums->n;
    double *bias = mem_alloc(sums->n, sizeof *bias);
    double *variance = mem_alloc(sums->n, sizeof *variance);
    struct welford errors = {0};
    for (size_t i = 0; i < sums->n; i++) {
        variance[i] = mean_of(sums, &sums->variances_without[i]);
        bias[i] = mean_of(sums, &sums->offsets_without[i]) - variance[i] / (n - 1.0);
        welford_add(&errors, mean_of(sums, &sums->errors[i]));
    }
    split->relmse = errors.mean;
    split->relmse_se = welford_se(&errors);
    split->variance_se = jackknife(variance, sums->n);
    split->bias2_se = jackknife(bias, sums->n);
    mem_free(bias);
    mem_free(variance);
}

static void finish(const struct sums *sums, struct analysis_split *split)
{
    double n = (double)sums->n;
    split->variance = mean_of(sums, &sums->variance);
    split->bias2 = mean_of(sums, &sums->offset) - split->variance / n - split->noise;
    take_errors(sums, split);
    double freedom = n - 1.0;
    split->bias2_hi = split->bias2 + student_quantile(0.975, freedom) * split->bias2_se;
    split->bias_is_significant = split->bias2 >
                                 student_quantile(0.95, freedom) * split->bias2_se;
}

static bool check_sizes(const struct image *const *pictures, size_t n,
                        const struct image *reference, struct err *err)
{
    for (size_t i = 0; i < n; i++)
        if (pictures[i]->width != reference->width ||
            pictures[i]->height != reference->height)
            return err_set(err, ERR_VALUE, NULL,
                           "the pictures differ in size from their reference: %dx%d "
                           "against %dx%d",
                           pictures[i]->width, pictures[i]->height, reference->width,
                           reference->height);
    return true;
}

bool analysis_split_pictures(const struct image *const *pictures, size_t n,
                             const struct image *reference, double noise,
                             struct analysis_split *split, struct err *err)
{
    const double nan = (double)NAN;
    *split = (struct analysis_split){
        nan, nan, nan, nan, nan, nan, .noise = noise, .bias2_hi = nan, .seeds = n};
    if (n < 2)
        return err_set(err, ERR_VALUE, NULL, "not enough seeds: two are needed");
    if (!check_sizes(pictures, n, reference, err))
        return false;
    struct sums sums = {.pictures = pictures, .reference = reference, .n = n};
    sums.variances_without = mem_alloc(n, sizeof(struct accum));
    sums.offsets_without = mem_alloc(n, sizeof(struct accum));
    sums.errors = mem_alloc(n, sizeof(struct accum));
    add_pixels(&sums);
    split->nonfinite = sums.nonfinite;
    bool ok = sums.pixels > 0;
    if (ok)
        finish(&sums, split);
    else
        err_set(err, ERR_VALUE, NULL, "no pixel is finite in all pictures");
    mem_free(sums.variances_without);
    mem_free(sums.offsets_without);
    mem_free(sums.errors);
    return ok;
}

/* --- from the folder ------------------------------------------------------------- */

static struct image *read_reference(const struct results *results,
                                    const struct results_cell *cell, struct err *err)
{
    if (cell->reference[0] == '\0') {
        err_set(err, ERR_VALUE, NULL, "the table does not name the reference picture");
        return NULL;
    }
    char *path = text_join(results->folder, cell->reference);
    struct image *image = exr_read(path, NULL, err);
    mem_free(path);
    return image;
}

static bool read_pictures(const struct results *results, const struct results_cell *cell,
                          struct image **pictures, struct err *err)
{
    bool ok = true;
    for (size_t i = 0; ok && i < cell->run_count; i++) {
        char *path = results_picture(results, &cell->runs[i]);
        pictures[i] = exr_read(path, NULL, err);
        ok = pictures[i] != NULL;
        mem_free(path);
    }
    return ok;
}

bool analysis_split_cell(const struct results *results, const struct results_cell *cell,
                         const struct image *reference, struct analysis_split *split,
                         struct err *err)
{
    *split = (struct analysis_split){0};
    struct image *own = reference ? NULL : read_reference(results, cell, err);
    reference = reference ? reference : own;
    if (reference == NULL)
        return false;
    struct image **pictures = mem_alloc(cell->run_count, sizeof(struct image *));
    bool ok = read_pictures(results, cell, pictures, err) &&
              analysis_split_pictures((const struct image *const *)pictures,
                                      cell->run_count, reference,
                                      cell->noise[RESULTS_RELMSE], split, err);
    split->noise_is_known = cell->noise_is_known[RESULTS_RELMSE];
    for (size_t i = 0; i < cell->run_count; i++)
        image_destroy(pictures[i]);
    mem_free(pictures);
    image_destroy(own);
    return ok;
}
