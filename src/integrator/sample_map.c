#include "integrator/sample_map.h"

#include "base/mem.h"
#include "math/box_blur.h"
#include "math/order.h"

#include <math.h>
#include <stdbool.h>

#define WINDOW_SAMPLES 512.0 /* samples in a window, of pixels of both colours */
#define OUTLIERS       20 /* the largest of so many errors above 0 count as the next one */
#define HALVINGS       40 /* of the interval in which the weights' scale lies */

/* Of the pixels of one colour, and 0 at the others: means over windows, and the share of
 * these pixels in the window. */
struct field {
    double *errors, *work, *share;
};

struct maker {
    const struct sample_start *start;
    int radius;
    double *errors; /* of all pixels, outliers limited */
    struct field fields[2];
    double *weights; /* samples of pixels, over the mean */
};

static long index_of(const struct maker *m, int x, int y)
{
    return (long)y * m->start->width + x;
}

/* Pixels of the window around (x, y). */
static double window(const struct maker *m, int x, int y)
{
    int left = x < m->radius ? x : m->radius, up = y < m->radius ? y : m->radius;
    int right = m->start->width - 1 - x, down = m->start->height - 1 - y;
    right = right < m->radius ? right : m->radius;
    down = down < m->radius ? down : m->radius;
    return (double)(left + right + 1) * (up + down + 1);
}

/* sqrt(e / c) from the pixels of a colour around (x, y), itself left out. */
static double root(const struct maker *m, int x, int y, int colour)
{
    long i = index_of(m, x, y);
    const struct field *f = &m->fields[colour];
    double size = window(m, x, y), errors = f->errors[i] * size, work = f->work[i] * size;
    if (colour == sample_map_colour(x, y)) {
        errors -= m->errors[i];
        work -= (double)m->start->work[i];
        if (round(f->share[i] * size) < 2.0)
            return 0.0;
    }
    return work > 0.0 ? sqrt(fmax(errors, 0.0) / work) : 0.0;
}

/* --- the start --------------------------------------------------------------------- */

/* The error that all but one in OUTLIERS pixels of a colour do not exceed, of those that
 * have one: a lamp before a constant background is no outlier. */
static double greatest(const struct maker *m, int colour)
{
    const struct sample_start *s = m->start;
    size_t count = 0;
    double *sorted = mem_alloc((size_t)s->width * (size_t)s->height, sizeof *sorted);
    for (int y = 0; y < s->height; y++)
        for (int x = sample_map_first(colour, y); x < s->width; x += 2)
            if (s->errors[index_of(m, x, y)] > 0.0f)
                sorted[count++] = (double)s->errors[index_of(m, x, y)];
    sort_ascending(sorted, count);
    double most = count > 0 ? sorted[count - 1 - count / OUTLIERS] : 0.0;
    mem_free(sorted);
    return most;
}

static void fill_field(struct maker *m, int colour)
{
    const struct sample_start *s = m->start;
    size_t pixels = (size_t)s->width * (size_t)s->height;
    struct field *f = &m->fields[colour];
    double *planes[3], most = greatest(m, colour);
    for (int k = 0; k < 3; k++)
        planes[k] = mem_alloc(pixels, sizeof *planes[k]);
    *f = (struct field){planes[0], planes[1], planes[2]};
    for (int y = 0; y < s->height; y++)
        for (int x = sample_map_first(colour, y); x < s->width; x += 2) {
            long i = index_of(m, x, y);
            f->errors[i] = m->errors[i] = fmin((double)s->errors[i], most);
            f->work[i] = (double)s->work[i];
            f->share[i] = 1.0;
        }
    for (int k = 0; k < 3; k++)
        box_blur(planes[k], s->width, s->height, m->radius);
}

static void maker_init(struct maker *m, const struct sample_start *start)
{
    size_t pixels = (size_t)start->width * (size_t)start->height;
    double side = sqrt(WINDOW_SAMPLES / start->samples);
    int most = start->width > start->height ? start->width : start->height;
    *m = (struct maker){.start = start};
    m->radius = (int)fmin(fmax(ceil(0.5 * (side - 1.0)), 1.0), most);
    m->errors = mem_alloc(pixels, sizeof *m->errors);
    m->weights = mem_alloc(pixels, sizeof *m->weights);
    for (int colour = 0; colour < 2; colour++)
        fill_field(m, colour);
}

static void maker_deinit(struct maker *m)
{
    mem_free(m->errors);
    mem_free(m->weights);
    for (int colour = 0; colour < 2; colour++) {
        mem_free(m->fields[colour].errors);
        mem_free(m->fields[colour].work);
        mem_free(m->fields[colour].share);
    }
}

/* --- the weights ------------------------------------------------------------------- */

/* Of a pixel whose share of all samples is `total` of the mean, without the start's. */
static double weight(const struct maker *m, double total)
{
    double s = m->start->share, after = (total - s) / (1.0 - s);
    return fmin(fmax(after, SAMPLE_MAP_LEAST), SAMPLE_MAP_MOST);
}

static double mean_weight(const struct maker *m, int colour, double scale)
{
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(colour, y); x < m->start->width; x += 2) {
            sum += weight(m, scale * m->weights[index_of(m, x, y)]);
            count += 1.0;
        }
    return count > 0.0 ? sum / count : 1.0;
}

/* Sets the weights of the pixels of colour `of` by those of colour `by` around them;
 * their mean is 1, or below where so many are at the upper limit. */
static void find_weights(struct maker *m, int of, int by)
{
    double most = 0.0, low = 0.0, high;
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(of, y); x < m->start->width; x += 2) {
            double *w = &m->weights[index_of(m, x, y)];
            *w = root(m, x, y, by);
            most = fmax(most, *w);
        }
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(of, y); x < m->start->width; x += 2) {
            double *w = &m->weights[index_of(m, x, y)];
            *w = most > 0.0 ? *w / most : 1.0;
        }
    for (high = 1.0; mean_weight(m, of, high) < 1.0 && high < 1e6;)
        high *= 2.0;
    for (int k = 0; k < HALVINGS; k++) {
        double middle = 0.5 * (low + high);
        if (mean_weight(m, of, middle) < 1.0)
            low = middle;
        else
            high = middle;
    }
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(of, y); x < m->start->width; x += 2) {
            double *w = &m->weights[index_of(m, x, y)];
            *w = weight(m, high * *w);
        }
}

/* Error times work over that of uniform samples, of the pixels of a colour, if each had
 * its samples by those of the colour around it. */
static double own_gain(struct maker *m, int colour)
{
    double error = 0.0, work = 0.0, adapted_error = 0.0, adapted_work = 0.0;
    double s = m->start->share;
    find_weights(m, colour, colour);
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(colour, y); x < m->start->width; x += 2) {
            long i = index_of(m, x, y);
            double total = s + (1.0 - s) * m->weights[i], c = (double)m->start->work[i];
            error += m->errors[i];
            work += c;
            adapted_error += m->errors[i] / total;
            adapted_work += c * total;
        }
    return error > 0.0 && work > 0.0 ? adapted_error / error * adapted_work / work : 1.0;
}

/* The rest of a division is carried to the next pixel of the colour, so that the sum is
 * right to one sample. */
static void divide(struct maker *m, int colour, bool adapt, uint32_t *each)
{
    double rest = 0.5;
    if (adapt)
        find_weights(m, colour, 1 - colour);
    for (int y = 0; y < m->start->height; y++)
        for (int x = sample_map_first(colour, y); x < m->start->width; x += 2) {
            long i = index_of(m, x, y);
            double wanted = SAMPLE_MAP_MEAN * (adapt ? m->weights[i] : 1.0) + rest;
            double samples = fmax(floor(wanted), 1.0);
            each[i] = (uint32_t)samples;
            rest = wanted - samples;
        }
}

double sample_map_make(const struct sample_start *start, uint32_t *each)
{
    struct maker m;
    double predicted = 0.0;
    maker_init(&m, start);
    for (int colour = 0; colour < 2; colour++) {
        double gain = own_gain(&m, 1 - colour);
        divide(&m, colour, gain < 1.0, each);
        predicted += 0.5 * fmin(gain, 1.0);
    }
    maker_deinit(&m);
    return predicted;
}
