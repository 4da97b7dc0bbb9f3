#include "import/spectrum.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/number.h"

#include <math.h>
#include <string.h>

#define LAMBDA_MIN 360 /* nm */
#define LAMBDA_MAX 830

struct lobe {
    double height, mean, below, above; /* standard deviations on both sides, nm */
};

static double lobes(const struct lobe *list, int count, double lambda)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double d = lambda - list[i].mean;
        double t = d / (d < 0.0 ? list[i].below : list[i].above);
        sum += list[i].height * exp(-0.5 * t * t);
    }
    return sum;
}

static void observer(double lambda, double xyz[3])
{
    static const struct lobe x[] = {{1.056, 599.8, 37.9, 31.0},
                                    {0.362, 442.0, 16.0, 26.7},
                                    {-0.065, 501.1, 20.4, 26.2}};
    static const struct lobe y[] = {{0.821, 568.8, 46.9, 40.5},
                                    {0.286, 530.9, 16.3, 31.1}};
    static const struct lobe z[] = {{1.217, 437.0, 11.8, 36.0},
                                    {0.681, 459.0, 26.0, 13.8}};
    xyz[0] = lobes(x, 3, lambda);
    xyz[1] = lobes(y, 2, lambda);
    xyz[2] = lobes(z, 2, lambda);
}

struct rgb spectrum_from_xyz(double x, double y, double z)
{
    return rgb(3.240479 * x - 1.537150 * y - 0.498535 * z,
               -0.969256 * x + 1.875991 * y + 0.041556 * z,
               0.055648 * x - 0.204043 * y + 1.057311 * z);
}

struct rgb spectrum_from_chromaticity(double x, double y)
{
    return spectrum_from_xyz(x / y, 1.0, (1.0 - x - y) / y);
}

/* Integrates value(lambda) against the observer in steps of one nanometre. */
static struct rgb integrate(double (*value)(const void *ctx, double lambda),
                            const void *ctx)
{
    double sum[3] = {0}, white = 0.0;
    for (int lambda = LAMBDA_MIN; lambda <= LAMBDA_MAX; lambda++) {
        double xyz[3];
        observer(lambda, xyz);
        double v = value(ctx, lambda);
        for (int i = 0; i < 3; i++)
            sum[i] += v * xyz[i];
        white += xyz[1];
    }
    return spectrum_from_xyz(sum[0] / white, sum[1] / white, sum[2] / white);
}

struct pair_list {
    const double *pairs;
    size_t count; /* of pairs */
};

static double pairs_at(const void *ctx, double lambda)
{
    const struct pair_list *list = ctx;
    const double *p = list->pairs;
    size_t low = 0, high = list->count - 1;
    if (lambda <= p[0])
        return p[1];
    if (lambda >= p[2 * high])
        return p[2 * high + 1];
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (p[2 * middle] <= lambda)
            low = middle;
        else
            high = middle;
    }
    double t = (lambda - p[2 * low]) / (p[2 * high] - p[2 * low]);
    return (1.0 - t) * p[2 * low + 1] + t * p[2 * high + 1];
}

static bool pairs_rise(const double *pairs, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (!(pairs[2 * i] > pairs[2 * i - 2]))
            return false;
    return count > 0;
}

bool spectrum_from_pairs(const double *pairs, size_t count, struct rgb *out)
{
    if (!pairs_rise(pairs, count))
        return false;
    *out = integrate(pairs_at, &(struct pair_list){pairs, count});
    return true;
}

/* CIE standard illuminant D65, every 10 nm [ISO/CIE 11664-2]. */
static double d65(double lambda)
{
    static const double power[] = {
        46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823,
        104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
        104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
        90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778,
        78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856, 75.0870, 63.5927,
        46.4182, 66.8054, 63.3828, 64.3040, 59.4519, 51.9590, 57.4406, 60.3125};
    int last = (int)(sizeof power / sizeof power[0]) - 1;
    double x = (lambda - LAMBDA_MIN) / 10.0;
    int i = x < last ? (int)x : last - 1;
    return power[i] + (x - i) * (power[i + 1] - power[i]);
}

static double lit_pairs_at(const void *ctx, double lambda)
{
    return d65(lambda) * pairs_at(ctx, lambda);
}

/* Divided by what white gives, so that the fit of the observer tints no grey. */
bool spectrum_reflectance_from_pairs(const double *pairs, size_t count, struct rgb *out)
{
    static const double one[] = {550.0, 1.0};
    if (!pairs_rise(pairs, count))
        return false;
    struct rgb white = integrate(lit_pairs_at, &(struct pair_list){one, 1});
    struct rgb lit = integrate(lit_pairs_at, &(struct pair_list){pairs, count});
    *out = rgb(lit.r / white.r, lit.g / white.g, lit.b / white.b);
    return true;
}

/* Planck's law, W/(m^2 sr m). */
static double planck(double kelvin, double metres)
{
    const double c = 299792458.0, h = 6.62606957e-34, k = 1.3806488e-23;
    return 2.0 * h * c * c / (pow(metres, 5.0) * expm1(h * c / (metres * k * kelvin)));
}

static double blackbody_at(const void *ctx, double lambda)
{
    double kelvin = *(const double *)ctx;
    double peak = 2.8977721e-3 / kelvin; /* Wien's law, m */
    return planck(kelvin, lambda * 1e-9) / planck(kelvin, peak);
}

struct rgb spectrum_from_blackbody(double kelvin)
{
    /* Below, nothing visible is left in doubles, and the peak may have none. */
    return kelvin > 1.0 ? integrate(blackbody_at, &kelvin) : rgb_grey(0.0);
}

/* Appends the numbers of the text to *list; the position of what is not one or NULL. */
static const char *read_pairs(const char *s, double **list, size_t *count)
{
    size_t capacity = 0;
    for (;;) {
        s += strspn(s, " \t\r\n,");
        if (*s == '#')
            s += strcspn(s, "\n");
        else if (*s == '\0')
            return NULL;
        else {
            double value;
            const char *after = number_parse(s, &value);
            if (!after || !isfinite(value))
                return s;
            *list = mem_grow(*list, &capacity, *count + 1, sizeof **list);
            (*list)[(*count)++] = value;
            s = after;
        }
    }
}

double *spectrum_read_file(const char *path, const struct place *at, size_t *pair_count,
                           struct err *err)
{
    size_t size, count = 0;
    char *data = text_read_file(path, &size, at, err);
    if (!data)
        return NULL;
    double *list = NULL;
    bool good = !read_pairs(data, &list, &count) && count % 2 == 0 &&
                pairs_rise(list, count / 2);
    mem_free(data);
    *pair_count = count / 2;
    if (good)
        return list;
    err_set(err, ERR_SYNTAX, at,
            "\"%s\" is not a list of pairs (rising wavelength, value)", path);
    mem_free(list);
    return NULL;
}
