/* FLIP [Andersson20] and HDR-FLIP [Andersson21].
 *
 * Two pipelines. Colour: both pictures in YCxCz are blurred as the eye's contrast
 * sensitivity blurs them, clamped to what a screen shows, and compared in L*a*b* with
 * Hunt-adjusted chroma by the HyAB distance. Features: edges and points of the luminance,
 * found with derivatives of a Gaussian. The difference in features enlarges that of
 * colours: E = Ec^(1 - Ef). All kernels are sums of products of a row and a column. */

#include "image/flip.h"

#include "base/mem.h"
#include "image/metric.h"
#include "math/accum.h"
#include "math/order.h"
#include "math/warp.h"

#include <stdint.h>
#include <string.h>

#define RADIUS_MOST 15
#define QC          0.7   /* exponent of colours */
#define QF          0.5   /* exponent of features */
#define PC          0.4   /* distances up to this share of the greatest one */
#define PT          0.95  /* are spread over [0, PT] */
#define EDGE_WIDTH  0.082 /* degrees, peak to trough of the eye's edge detector */
#define LIT         0.85  /* value on screen that exposures aim at */

struct kernel {
    int radius;
    float weights[2 * RADIUS_MOST + 1];
};

/* Kernels of the colour pipeline by channel: one Gaussian, or the weighted sum of two. */
struct flip_kernels {
    struct kernel achromatic, red_green, blue_yellow[2];
    float share[2];
    struct kernel blur, edge, point; /* of features */
    double greatest;                 /* distance of green and blue, to the power QC */
};

struct planes {
    int width, height;
    float *channel[3]; /* YCxCz, then Hunt-adjusted L*a*b* */
    float *feature[2]; /* norms of edges and points */
};

/* --- colour spaces ---------------------------------------------------------------- */

/* Linear Rec. 709 to XYZ over that of white (1, 1, 1). */
static const double to_xyz[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
};

static void xyz_of(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; i++) {
        const double *m = to_xyz[i];
        xyz[i] = (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
    }
}

/* The inverse, by Cramer's rule. */
static void invert_matrix(const double m[3][3], double inverse[3][3])
{
    double c[3][3], determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[i][j] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                      m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
    for (int j = 0; j < 3; j++)
        determinant += m[0][j] * c[0][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[i][j] = c[j][i] / determinant;
}

static void opponent_of(const double rgb[3], double out[3])
{
    double xyz[3];
    xyz_of(rgb, xyz);
    out[0] = 116.0 * xyz[1] - 16.0;
    out[1] = 500.0 * (xyz[0] - xyz[1]);
    out[2] = 200.0 * (xyz[1] - xyz[2]);
}

/* CIE L*a*b*. */
static double lab_curve(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

/* With the chroma times .01 L*: a difference in colour is seen less where it is dark
 * [Andersson20]. */
static void hunt_of(const double rgb[3], double out[3])
{
    double xyz[3];
    xyz_of(rgb, xyz);
    double x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    out[0] = 116.0 * y - 16.0;
    out[1] = 0.01 * out[0] * 500.0 * (x - y);
    out[2] = 0.01 * out[0] * 200.0 * (y - z);
}

/* HyAB distance. */
static double distance(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

/* --- kernels ---------------------------------------------------------------------- */

/* exp(-x^2 / (2 sd^2)), in pixels; its sum, and the weights over it. */
static double gaussian(struct kernel *kernel, int radius, double sd)
{
    double sum = 0.0;
    kernel->radius = radius;
    for (int x = -radius; x <= radius; x++)
        sum += exp(-0.5 * x * x / (sd * sd));
    for (int x = -radius; x <= radius; x++)
        kernel->weights[x + radius] = (float)(exp(-0.5 * x * x / (sd * sd)) / sum);
    return sum;
}

/* The first (order 1) or second derivative of a Gaussian, positive weights summing to 1
 * and negative ones to -1. */
static void derivative(struct kernel *kernel, int radius, double sd, int order)
{
    double sums[2] = {0.0, 0.0}, w[2 * RADIUS_MOST + 1] = {0.0};
    kernel->radius = radius;
    for (int x = -radius; x <= radius; x++) {
        double g = exp(-0.5 * x * x / (sd * sd));
        double v = order == 1 ? -x * g : (x * x / (sd * sd) - 1.0) * g;
        sums[v < 0.0] += fabs(v);
        w[x + radius] = v;
    }
    for (int i = 0; i <= 2 * radius; i++)
        kernel->weights[i] = (float)(w[i] / sums[w[i] < 0.0]);
}

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
    gaussian(&k->achromatic, radius, deviation(0.0047));
    gaussian(&k->red_green, radius, deviation(0.0053));
    for (int i = 0; i < 2; i++) {
        double a = by[i][0], b = by[i][1];
        double sum = gaussian(&k->blue_yellow[i], radius, deviation(b));
        sums[i] = a / sqrt(b) * sum * sum;
        all += sums[i];
    }
    for (int i = 0; i < 2; i++)
        k->share[i] = (float)(sums[i] / all);
    double sd = 0.5 * EDGE_WIDTH * FLIP_PIXELS_PER_DEGREE;
    radius = (int)ceil(3.0 * sd);
    gaussian(&k->blur, radius, sd);
    derivative(&k->edge, radius, sd, 1);
    derivative(&k->point, radius, sd, 2);
    hunt_of(green, lab[0]);
    hunt_of(blue, lab[1]);
    k->greatest = pow(distance(lab[0], lab[1]), QC);
}

static int clamped(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

/* Values that are summed at once, in registers. */
#define BLOCK 32

/* out[x] = sum over i of weights[i] * taps[i][x], for x below n, in the order of i. */
static void weigh(const struct kernel *k, const float *const taps[2 * RADIUS_MOST + 1],
                  int n, float *out)
{
    int x = 0;
    for (; x + BLOCK <= n; x += BLOCK) {
        float sums[BLOCK] = {0.0f};
        for (int i = 0; i <= 2 * k->radius; i++)
            for (int b = 0; b < BLOCK; b++)
                /* NOLINTNEXTLINE(clang-analyzer-core.*): all taps are set */
                sums[b] += k->weights[i] * taps[i][x + b];
        memcpy(out + x, sums, sizeof sums);
    }
    for (; x < n; x++) {
        out[x] = 0.0f;
        for (int i = 0; i <= 2 * k->radius; i++)
            /* NOLINTNEXTLINE(clang-analyzer-core.*): all taps are set */
            out[x] += k->weights[i] * taps[i][x];
    }
}

/* Rows; the border repeats. */
static void filter_rows(const struct kernel *k, const float *in, int width, int height,
                        float *out)
{
    const float *taps[2 * RADIUS_MOST + 1];
    float *row = mem_alloc((size_t)width + 2 * (size_t)k->radius, sizeof *row);
    for (int i = 0; i <= 2 * k->radius; i++)
        taps[i] = row + i;
    for (int y = 0; y < height; y++, in += width, out += width) {
        for (int x = -k->radius; x < width + k->radius; x++)
            row[x + k->radius] = in[clamped(x, width)];
        weigh(k, taps, width, out);
    }
    mem_free(row);
}

static void filter_columns(const struct kernel *k, const float *in, int width, int height,
                           float *out)
{
    const float *taps[2 * RADIUS_MOST + 1];
    for (int y = 0; y < height; y++, out += width) {
        for (int i = -k->radius; i <= k->radius; i++)
            taps[i + k->radius] = in + (size_t)clamped(y + i, height) * (size_t)width;
        weigh(k, taps, width, out);
    }
}

/* scratch: a plane. in and out may be the same. */
static void filter(const struct kernel *rows, const struct kernel *columns,
                   const struct planes *p, const float *in, float *scratch, float *out)
{
    filter_rows(rows, in, p->width, p->height, scratch);
    filter_columns(columns, scratch, p->width, p->height, out);
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
static void find_features(const struct flip_kernels *k, const struct kernel *derivative,
                          const struct planes *p, float *const scratch[3], float *out)
{
    size_t pixels = (size_t)p->width * (size_t)p->height;
    filter(derivative, &k->blur, p, p->channel[0], scratch[0], scratch[1]);
    filter(&k->blur, derivative, p, p->channel[0], scratch[0], scratch[2]);
    /* The kernel is for (Y + 16) / 116; it sums to 0, so the constant does not count. */
    for (size_t i = 0; i < pixels; i++)
        out[i] = hypotf(scratch[1][i], scratch[2][i]) / 116.0f;
}

static void blur_channels(const struct flip_kernels *k, struct planes *p,
                          float *const scratch[3])
{
    size_t pixels = (size_t)p->width * (size_t)p->height;
    filter(&k->achromatic, &k->achromatic, p, p->channel[0], scratch[0], p->channel[0]);
    filter(&k->red_green, &k->red_green, p, p->channel[1], scratch[0], p->channel[1]);
    for (int j = 0; j < 2; j++)
        filter(&k->blue_yellow[j], &k->blue_yellow[j], p, p->channel[2], scratch[0],
               scratch[1 + j]);
    for (size_t i = 0; i < pixels; i++)
        p->channel[2][i] = k->share[0] * scratch[1][i] + k->share[1] * scratch[2][i];
}

/* From blurred YCxCz to what a screen shows of it, to Hunt-adjusted L*a*b*. */
static void show(struct planes *p)
{
    double from[3][3], white[3], rgb[3], lab[3];
    invert_matrix(to_xyz, from);
    for (int i = 0; i < 3; i++)
        white[i] = to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        double y = ((double)p->channel[0][i] + 16.0) / 116.0;
        double xyz[3] = {white[0] * (y + (double)p->channel[1][i] / 500.0), white[1] * y,
                         white[2] * (y - (double)p->channel[2][i] / 200.0)};
        for (int c = 0; c < 3; c++)
            rgb[c] = fmin(
                fmax(from[c][0] * xyz[0] + from[c][1] * xyz[1] + from[c][2] * xyz[2],
                     0.0),
                1.0);
        hunt_of(rgb, lab);
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
        opponent_of(rgb, opponent);
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
    double colour = spread(pow(distance(lab[0], lab[1]), QC), k->greatest);
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
