#include "analysis/analysis_spectrum.h"

#include "base/mem.h"
#include "image/metric.h"
#include "image/noise.h"
#include "lab/reference.h"
#include "math/accum.h"
#include "math/order.h"

#include <math.h>

#define LOW  (1.0 / 16.0)
#define HIGH (1.0 / 4.0)

/* What weights are taken from, grey: the reference, or the mean. */
static struct image *truth_of(const struct image *const *pictures, size_t n,
                              const struct image *reference)
{
    const struct image *const *from = reference ? &reference : pictures;
    size_t count = reference ? 1 : n;
    struct image *truth = image_create_like(pictures[0]);
    long pixels = (long)truth->width * truth->height;
    for (long i = 0; i < pixels; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < count; k++)
            sum += rgb_luminance(image_pixel(from[k], i)) / (double)count;
        for (int c = 0; c < 3; c++)
            truth->pixels[3 * i + c] = (float)sum;
    }
    return truth;
}

/* Sets the highest errors to 0. scratch: as large as the field. */
static void trim(double *field, double *scratch, size_t pixels)
{
    size_t left_out = pixels / METRIC_TRIM;
    for (size_t i = 0; i < pixels; i++)
        scratch[i] = fabs(field[i]);
    sort_ascending(scratch, pixels);
    if (left_out == 0)
        return;
    double most = scratch[pixels - left_out];
    for (size_t i = 0; i < pixels; i++)
        if (fabs(field[i]) >= most)
            field[i] = 0.0;
}

/* Of luminance, picture less other, with the weights of the truth. */
static void relative_error(const struct image *picture, const struct image *other,
                           const struct image *truth, double *field)
{
    for (int y = 0, i = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++, i++) {
            double d = rgb_luminance(image_pixel(picture, i)) -
                       rgb_luminance(image_pixel(other, i));
            double e = d * sqrt(noise_weight(truth, x, y, 0));
            field[i] = isfinite(e) ? e : 0.0;
        }
}

static void run_field(const struct image *const *pictures, size_t i, size_t n,
                      const struct image *truth, double *field)
{
    size_t pixels = (size_t)truth->width * (size_t)truth->height;
    if (n == 1) {
        relative_error(pictures[0], truth, truth, field);
        return;
    }
    relative_error(pictures[i], pictures[(i + 1) % n], truth, field);
    for (size_t k = 0; k < pixels; k++)
        field[k] *= sqrt(0.5);
    trim(field, field + pixels, pixels);
}

static void add_run(struct analysis_spectrum *s, const struct power_spectrum *run,
                    size_t n)
{
    bool first = s->mean.count == 0;
    for (int b = 0; b < run->count; b++) {
        s->least[b] = first ? run->power[b] : fmin(s->least[b], run->power[b]);
        s->greatest[b] = first ? run->power[b] : fmax(s->greatest[b], run->power[b]);
        s->mean.frequency[b] = run->frequency[b];
        s->mean.power[b] += run->power[b] / (double)n;
    }
    s->mean.count = run->count;
}

static double low_over_high(const struct power_spectrum *spectrum)
{
    struct welford low = {0}, high = {0};
    for (int b = 0; b < spectrum->count; b++) {
        if (spectrum->frequency[b] < LOW)
            welford_add(&low, spectrum->power[b]);
        if (spectrum->frequency[b] > HIGH)
            welford_add(&high, spectrum->power[b]);
    }
    return spectrum->frequency[0] < LOW ? low.mean / high.mean : (double)NAN;
}

bool analysis_spectrum_pictures(const struct image *const *pictures, size_t n,
                                const struct image *reference,
                                struct analysis_spectrum *s, struct err *err)
{
    *s = (struct analysis_spectrum){.seeds = n, .cost = (double)NAN};
    if (n < 1 || (n < 2 && reference == NULL))
        return err_set(err, ERR_VALUE, NULL, "one seed, and no reference");
    for (size_t i = 0; i < n; i++)
        if (!metric_check_sizes(pictures[i], reference ? reference : pictures[0], err))
            return false;
    if (power_spectrum_side(pictures[0]->width, pictures[0]->height) == 0)
        return err_set(err, ERR_VALUE, NULL, "the pictures are too small for a spectrum");
    struct image *truth = truth_of(pictures, n, reference);
    size_t pixels = (size_t)truth->width * (size_t)truth->height;
    double *field = mem_alloc(2 * pixels, sizeof *field);
    for (size_t i = 0; i < n; i++) {
        struct power_spectrum run;
        run_field(pictures, i, n, truth, field);
        power_spectrum_make(field, truth->width, truth->height, &run);
        add_run(s, &run, n);
    }
    s->low_over_high = low_over_high(&s->mean);
    mem_free(field);
    image_destroy(truth);
    return true;
}

static bool read_reference(const struct results *results, const struct results_cell *cell,
                           struct reference *reference, struct err *err)
{
    if (cell->reference[0] == '\0')
        return err_set(err, ERR_VALUE, NULL, "one seed, and no reference");
    char *path = text_join(results->folder, cell->reference);
    bool ok = reference_read(path, NULL, reference, err);
    mem_free(path);
    return ok;
}

bool analysis_spectrum_cell(const struct results *results,
                            const struct results_cell *cell, struct analysis_spectrum *s,
                            struct err *err)
{
    struct reference reference = {0};
    *s = (struct analysis_spectrum){0};
    if (cell->run_count < 2 && !read_reference(results, cell, &reference, err))
        return false;
    struct image **pictures = mem_alloc(cell->run_count, sizeof(struct image *));
    bool ok = results_read_pictures(results, cell, pictures, err) &&
              analysis_spectrum_pictures((const struct image *const *)pictures,
                                         cell->run_count, reference.picture, s, err);
    s->cost = results_mean(results, cell, "seconds_cpu");
    for (size_t i = 0; i < cell->run_count; i++)
        image_destroy(pictures[i]);
    mem_free(pictures);
    reference_deinit(&reference);
    return ok;
}
