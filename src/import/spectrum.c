#include "import/spectrum.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/illuminant.h"
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

/* XYZ of D65, whose Y is 1: what the primaries of Rec. 709 make of (1, 1, 1). */
static const double white_point[3] = {0.950456, 1.0, 1.089058};

/* Integrates value(lambda) against the observer in steps of one nanometre: divided by the
 * integral of y, or under D65, so that a constant 1 has that illuminant's colour. */
static struct rgb integrate(double (*value)(const void *ctx, double lambda),
                            const void *ctx, bool d65)
{
    double sum[3] = {0}, white[3] = {0};
    for (int lambda = LAMBDA_MIN; lambda <= LAMBDA_MAX; lambda++) {
        double xyz[3];
        observer(lambda, xyz);
        double v = value(ctx, lambda), light = d65 ? illuminant_d65(lambda) : 1.0;
        for (int i = 0; i < 3; i++) {
            sum[i] += v * light * xyz[i];
            white[i] += light * xyz[i];
        }
    }
    for (int i = 0; i < 3; i++)
        sum[i] = d65 ? sum[i] * white_point[i] / white[i] : sum[i] / white[1];
    return spectrum_from_xyz(sum[0], sum[1], sum[2]);
}

struct pair_list {
    const double *pairs;
    size_t count; /* of pairs */
    bool cut_off;
};

static double pairs_at(const void *ctx, double lambda)
{
    const struct pair_list *list = ctx;
    const double *p = list->pairs;
    size_t low = 0, high = list->count - 1;
    if (list->cut_off && (lambda < p[0] || lambda > p[2 * high]))
        return 0.0;
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

bool spectrum_from_pairs_by(const double *pairs, size_t count,
                            const struct spectrum_rule *rule, struct rgb *out)
{
    if (count == 0)
        return false;
    for (size_t i = 1; i < count; i++)
        if (!(pairs[2 * i] > pairs[2 * i - 2]))
            return false;
    *out = integrate(pairs_at, &(struct pair_list){pairs, count, rule->cut_off},
                     rule->d65);
    return true;
}

bool spectrum_from_pairs(const double *pairs, size_t count, struct rgb *out)
{
    return spectrum_from_pairs_by(pairs, count, &(struct spectrum_rule){0}, out);
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
    return kelvin > 0.0 ? integrate(blackbody_at, &kelvin, false) : rgb_grey(0.0);
}

static double planck_per_nm(const void *ctx, double lambda)
{
    return planck(*(const double *)ctx, lambda * 1e-9) * 1e-9;
}

struct rgb spectrum_from_blackbody_radiance(double kelvin)
{
    return kelvin > 0.0 ? integrate(planck_per_nm, &kelvin, false) : rgb_grey(0.0);
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

bool spectrum_from_file_by(const char *path, const struct spectrum_rule *rule,
                           const struct place *at, struct rgb *out, struct err *err)
{
    size_t size, count = 0;
    char *data = text_read_file(path, &size, at, err);
    if (!data)
        return false;
    double *list = NULL;
    const char *bad = read_pairs(data, &list, &count);
    bool good = !bad && count % 2 == 0 &&
                spectrum_from_pairs_by(list, count / 2, rule, out);
    if (!good)
        err_set(err, ERR_SYNTAX, at,
                "\"%s\" is not a list of pairs (rising wavelength, value)", path);
    mem_free(list);
    mem_free(data);
    return good;
}

bool spectrum_from_file(const char *path, const struct place *at, struct rgb *out,
                        struct err *err)
{
    return spectrum_from_file_by(path, &(struct spectrum_rule){0}, at, out, err);
}
