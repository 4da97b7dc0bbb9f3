/* FLIP [Andersson20] and HDR-FLIP [Andersson21].
 *
 * Two pipelines. Colour: both pictures in YCxCz are blurred as the eye's contrast
 * sensitivity blurs them, clamped to what a screen shows, and compared in L*a*b* with
 * Hunt-adjusted chroma by the HyAB distance. Features: edges and points of the luminance,
 * found with derivatives of a Gaussian. The difference in features enlarges that of
 * colours: E = Ec^(1 - Ef). All kernels are sums of products of a row and a column. */

#include "image/flip.h"

#include "base/mem.h"
#include "image/flip_colour.h"
#include "image/flip_filter.h"
#include "image/metric.h"
#include "math/accum.h"
#include "math/order.h"
#include "math/warp.h"

#include <stdint.h>
#include <string.h>

#define QC         0.7   /* exponent of colours */
#define QF         0.5   /* exponent of features */
#define PC         0.4   /* distances up to this share of the greatest one */
#define PT         0.95  /* are spread over [0, PT] */
#define EDGE_WIDTH 0.082 /* degrees, peak to trough of the eye's edge detector */
#define LIT        0.85  /* value on screen that exposures aim at */

/* Kernels of the colour pipeline by channel: one Gaussian, or the weighted sum of two. */
struct flip_kernels {
    struct flip_filter achromatic, red_green, blue_yellow[2];
    float share[2];
    struct flip_filter blur, edge, point; /* of features */
    double greatest; /* distance of green and blue, to the power QC */
};

struct planes {
    int width, height;
    float *channel[3]; /* YCxCz, then Hunt-adjusted L*a*b* */
    float *feature[2]; /* norms of edges and points */
};

/* --- kernels ---------------------------------------------------------------------- */

/* Standard deviation in pixels of exp(-pi^2 z^2 / b), z in degrees. */
static double deviation(double b)
{
    return sqrt(0.5 * b) / MATH_PI * FLIP_PIXELS_PER_DEGREE;
}

/* Contrast sensitivity [Andersson20]; a1, b1, a2, b2. */
static void make_kernels(struct flip_kernels *k)
{
    static const double by[2][2] = {{34.1, 0.04}, {13.5, 0.025}};
    const double green[3] = {0.0, 1.0, 0.0}, blue[3] = {0.0, 0.0, 1.0};
    int radius = (int)ceil(3.0 * deviation(by[0][1]));
    double sums[2], all = 0.0, lab[2][3];
    flip_gaussian(&k->achromatic, radius, deviation(0.0047));
    flip_gaussian(&k->red_green, radius, deviation(0.0053));
    for (int i = 0; i < 2; i++) {
        double a = by[i][0], b = by[i][1];
        double sum = flip_gaussian(&k->blue_yellow[i], radius, deviation(b));
        sums[i] = a / sqrt(b) * sum * sum;
        all += sums[i];
    }
    for (int i = 0; i < 2; i++)
        k->share[i] = (float)(sums[i] / all);
    double sd = 0.5 * EDGE_WIDTH * FLIP_PIXELS_PER_DEGREE;
    radius = (int)ceil(3.0 * sd);
    flip_gaussian(&k->blur, radius, sd);
    flip_derivative(&k->edge, radius, sd, 1);
    flip_derivative(&k->point, radius, sd, 2);
    flip_hunt(green, lab[0]);
    flip_hunt(blue, lab[1]);
    k->greatest = pow(flip_distance(lab[0], lab[1]), QC);
}

/* --- one picture ------------------------------------------------------------------ */

static struct planes planes_create(const struct image *image)
{
    struct planes p = {.width = image->width, .height = image->height};
    size_t pixels = (size_t)p.width * (size_t)p.height;
    for (int i = 0; i < 3; i++)
        p.channel[i] = mem_alloc(pixels, sizeof(float));
    for (int i = 0; i < 2; i++)
        p.feature[i] = mem_alloc(pixels, sizeof(float));
    return p;
}

static void planes_destroy(struct planes *p)
{
    for (int i = 0; i < 3; i++)
        mem_free(p->channel[i]);
    for (int i = 0; i < 2; i++)
        mem_free(p->feature[i]);
}

/* Norm of the responses to a derivative along rows and along columns. */
static void find_features(const struct flip_kernels *k,
                          const struct flip_filter *derivative, const struct planes *p,
                          float *const scratch[3], float *out)
{
    size_t pixels = (size_t)p->width * (size_t)p->height;
    flip_filter(derivative, &k->blur, p->width, p->height, p->channel[0], scratch[0],
                scratch[1]);
    flip_filter(&k->blur, derivative, p->width, p->height, p->channel[0], scratch[0],
                scratch[2]);
    /* The kernel is for (Y + 16) / 116; it sums to 0, so the constant does not count. */
    for (size_t i = 0; i < pixels; i++)
        out[i] = hypotf(scratch[1][i], scratch[2][i]) / 116.0f;
}

static void blur_channels(const struct flip_kernels *k, struct planes *p,
                          float *const scratch[3])
{
    size_t pixels = (size_t)p->width * (size_t)p->height;
    flip_filter(&k->achromatic, &k->achromatic, p->width, p->height, p->channel[0],
                scratch[0], p->channel[0]);
    flip_filter(&k->red_green, &k->red_green, p->width, p->height, p->channel[1],
                scratch[0], p->channel[1]);
    for (int j = 0; j < 2; j++)
        flip_filter(&k->blue_yellow[j], &k->blue_yellow[j], p->width, p->height,
                    p->channel[2], scratch[0], scratch[1 + j]);
    for (size_t i = 0; i < pixels; i++)
        p->channel[2][i] = k->share[0] * scratch[1][i] + k->share[1] * scratch[2][i];
}

/* From blurred YCxCz to what a screen shows of it, to Hunt-adjusted L*a*b*. */
static void show(struct planes *p)
{
    struct flip_screen screen;
    double opponent[3], rgb[3], lab[3];
    flip_screen_init(&screen);
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        for (int c = 0; c < 3; c++)
            opponent[c] = (double)p->channel[c][i];
        flip_screen_rgb(&screen, opponent, rgb);
        flip_hunt(rgb, lab);
        for (int c = 0; c < 3; c++)
            p->channel[c][i] = (float)lab[c];
    }
}

/* ACES curve [Narkowicz15] without its own exposure of .6. */
static double aces(double x)
{
    double v = 0.6 * fmax(x, 0.0);
    double y = v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
    return v < 1e150 ? fmin(y, 1.0) : 1.0;
}

/* exposure: in stops, or NAN for LDR. */
static void prepare(const struct flip_kernels *k, const struct image *image,
                    double exposure, float *const scratch[3], struct planes *p)
{
    double factor = exp2(exposure), rgb[3], opponent[3];
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        for (int c = 0; c < 3; c++) {
            double v = (double)image->pixels[3 * i + (size_t)c];
            rgb[c] = isnan(exposure) ? fmin(fmax(v, 0.0), 1.0) : aces(factor * v);
        }
        flip_opponent(rgb, opponent);
        for (int c = 0; c < 3; c++)
            p->channel[c][i] = (float)opponent[c];
    }
    find_features(k, &k->edge, p, scratch, p->feature[0]);
    find_features(k, &k->point, p, scratch, p->feature[1]);
    blur_channels(k, p, scratch);
    show(p);
}

/* --- the difference --------------------------------------------------------------- */

/* [Andersson20]: most differences of pictures are far below the greatest
 * possible one. */
static double spread(double power, double greatest)
{
    double knee = PC * greatest;
    return power < knee ? PT / knee * power
                        : PT + (power - knee) / (greatest - knee) * (1.0 - PT);
}

static double difference(const struct flip_kernels *k, const struct planes *a,
                         const struct planes *b, size_t i)
{
    double lab[2][3], features = 0.0;
    for (int c = 0; c < 3; c++) {
        lab[0][c] = (double)a->channel[c][i];
        lab[1][c] = (double)b->channel[c][i];
    }
    double colour = spread(pow(flip_distance(lab[0], lab[1]), QC), k->greatest);
    for (int f = 0; f < 2; f++)
        features = fmax(features,
                        fabs((double)a->feature[f][i] - (double)b->feature[f][i]));
    return pow(colour, 1.0 - pow(features * sqrt(0.5), QF));
}

struct comparison {
    struct flip_kernels kernels;
    const struct image *images[2];
    struct planes planes[2];
    float *scratch[3];
    double *most; /* [pixels], largest difference so far */
};

static void compare_at(struct comparison *c, double exposure)
{
    const struct planes *a = &c->planes[0], *b = &c->planes[1];
    for (int i = 0; i < 2; i++)
        prepare(&c->kernels, c->images[i], exposure, c->scratch, &c->planes[i]);
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        c->most[i] = fmax(c->most[i], difference(&c->kernels, a, b, i));
}

/* Luminance at which the curve is LIT: the positive root of its quadratic. */
static double luminance_of_lit(void)
{
    double a = 2.51 - LIT * 2.43, b = 0.03 - LIT * 0.59, c = -LIT * 0.14;
    return (sqrt(b * b - 4.0 * a * c) - b) / (2.0 * a) / 0.6;
}

/* [Andersson21]. */
static void choose_exposures(const struct image *reference, struct flip *out)
{
    long pixels = (long)reference->width * reference->height, dark = 0;
    double *values = mem_alloc((size_t)pixels, sizeof *values);
    for (long i = 0; i < pixels; i++)
        values[i] = fmax(rgb_luminance(image_pixel(reference, i)), 0.0);
    sort_ascending(values, (size_t)pixels);
    double most = values[pixels - 1];
    double median = median_of_sorted(values, (size_t)pixels);
    while (dark < pixels && values[dark] <= 0.0)
        dark++;
    if (!(median > 0.0) && dark < pixels)
        median = values[(dark + pixels) / 2];
    out->exposure_first = most > 0.0 ? log2(luminance_of_lit() / most) : 0.0;
    out->exposure_last = most > 0.0 ? log2(luminance_of_lit() / median) : 0.0;
    out->exposures = (int)fmax(2.0, ceil(out->exposure_last - out->exposure_first));
    mem_free(values);
}

static double mean_of(const struct comparison *c, const uint8_t *left_out)
{
    struct accum sum = {0};
    long pixels = (long)c->planes[0].width * c->planes[0].height, count = 0;
    for (long i = 0; i < pixels; i++) {
        if (left_out[i])
            continue;
        accum_add(&sum, c->most[i]);
        count++;
    }
    for (long i = 0; i < pixels; i++)
        c->most[i] = 0.0;
    return accum_value(&sum) / (double)count;
}

static void compare(const struct image *a, const struct image *reference,
                    const uint8_t *left_out, struct flip *out)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;
    struct comparison c = {.images = {a, reference},
                           .planes = {planes_create(a), planes_create(a)},
                           .most = mem_alloc(pixels, sizeof *c.most)};
    for (int i = 0; i < 3; i++)
        c.scratch[i] = mem_alloc(pixels, sizeof(float));
    make_kernels(&c.kernels);
    compare_at(&c, (double)NAN);
    out->ldr = mean_of(&c, left_out);
    choose_exposures(reference, out);
    for (int i = 0; i < out->exposures; i++)
        compare_at(&c, out->exposure_first + (out->exposure_last - out->exposure_first) *
                                                 i / (out->exposures - 1));
    out->hdr = mean_of(&c, left_out);
    for (int i = 0; i < 3; i++)
        mem_free(c.scratch[i]);
    for (int i = 0; i < 2; i++)
        planes_destroy(&c.planes[i]);
    mem_free(c.most);
}

/* A copy without pixels that are not finite; left_out[i]: whether one of the two is. */
static struct image *mended(const struct image *image, const struct image *other,
                            uint8_t *left_out, long *count)
{
    struct image *out = image_create_like(image);
    *count = 0;
    for (long i = 0; i < (long)image->width * image->height; i++) {
        struct rgb own = image_pixel(image, i), its = image_pixel(other, i);
        bool finite = rgb_is_finite(own);
        left_out[i] = !finite || !rgb_is_finite(its);
        *count += left_out[i];
        for (int c = 0; c < 3; c++)
            out->pixels[3 * i + c] = finite               ? image->pixels[3 * i + c]
                                     : rgb_is_finite(its) ? other->pixels[3 * i + c]
                                                          : 0.0f;
    }
    return out;
}

bool flip_compare(const struct image *a, const struct image *reference, struct flip *out,
                  struct err *err)
{
    *out = (struct flip){0};
    if (!metric_check_sizes(a, reference, err))
        return false;
    long pixels = (long)a->width * a->height, count;
    uint8_t *left_out = mem_alloc((size_t)pixels, sizeof *left_out);
    struct image *first = mended(a, reference, left_out, &count);
    struct image *second = mended(reference, a, left_out, &count);
    bool ok = count < pixels;
    if (ok)
        compare(first, second, left_out, out);
    else
        err_set(err, ERR_VALUE, NULL, "no pixel is finite in both pictures");
    image_destroy(first);
    image_destroy(second);
    mem_free(left_out);
    return ok;
}
