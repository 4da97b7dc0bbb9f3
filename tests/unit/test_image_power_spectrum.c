/* The radial power of an error: fields whose spectrum is known exactly. Expected values
 * are those of a windowed square, worked out from the field's autocovariance, so no
 * tolerance is set: the mean over fields is held against them by its standard error.
 *
 * False alarms: each design has at most 16 bins, z at 1e-5 two-sided, Sidak over 40:
 * below 1e-3 together; seeds are fixed. Power: with 60 fields of 96x80 the standard error
 * of a bin is .3 to 3 % of its power, so a factor of 1.15 in any bin, or a frequency axis
 * that is half a bin off on the correlated field, is seen. */

#include "analysis/analysis_spectrum.h"
#include "image/power_spectrum.h"
#include "math/accum.h"
#include "math/fft.h"
#include "support/results_make.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#define WIDTH  96
#define HEIGHT 80
#define FIELDS 60
#define LIMIT  5.1 /* standard normal, two-sided 1e-5 over 40 */

static const double pi = 3.14159265358979323846;

static void transform_is_its_definition(void **state)
{
    (void)state;
    struct rng rng;
    double complex x[16], direct[16];
    rng_init(&rng, 3, 1, 1);
    for (int j = 0; j < 16; j++)
        x[j] = rng_double(&rng) + rng_double(&rng) * (double complex)I;
    for (int k = 0; k < 16; k++) {
        direct[k] = 0.0;
        for (int j = 0; j < 16; j++)
            direct[k] += x[j] * cexp(-2.0 * pi * j * k / 16.0 * (double complex)I);
    }
    fft(x, 16);
    for (int k = 0; k < 16; k++)
        assert_true(cabs(x[k] - direct[k]) < 1e-13);
}

/* Mean of `shared` neighbours along each axis of normal deviates: 1: white. */
static void draw(struct rng *rng, int shared, double *field)
{
    static double white[(WIDTH + 1) * (HEIGHT + 1)];
    for (int i = 0; i < (WIDTH + 1) * (HEIGHT + 1); i++)
        white[i] = results_normal(rng);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double sum = 0.0;
            for (int v = 0; v < shared; v++)
                for (int u = 0; u < shared; u++)
                    sum += white[(y + v) * (WIDTH + 1) + x + u];
            field[y * WIDTH + x] = sum / (shared * shared);
        }
}

/* E of the windowed power along one axis at k of n: sum over lags of covariance times the
 * window's own autocorrelation. */
static double expected_axis(int k, int n, int shared)
{
    double energy = 0.0, lagged = 0.0;
    for (int i = 0; i < n; i++) {
        double a = 0.5 - 0.5 * cos(2.0 * pi * i / n);
        double b = i + 1 < n ? 0.5 - 0.5 * cos(2.0 * pi * (i + 1) / n) : 0.0;
        energy += a * a;
        lagged += a * b;
    }
    if (shared == 1)
        return 1.0;
    return 0.5 + 2.0 * 0.25 * lagged / energy * cos(2.0 * pi * k / n);
}

/* The same over the ring of the bin whose middle is f. */
static double expected(double f, int n, int shared)
{
    double sum = 0.0;
    long terms = 0;
    for (int v = -n / 2; v < n / 2; v++)
        for (int u = -n / 2; u < n / 2; u++) {
            double at = hypot(u, v) / n;
            double steps = 4.0 * log2(at / f); /* from the bin's middle: -1 to 1 */
            if (at * n < 1.5 || steps < -1.0 + 1e-6 || steps > 1.0 + 1e-6)
                continue;
            sum += expected_axis(u, n, shared) * expected_axis(v, n, shared);
            terms++;
        }
    return sum / (double)terms;
}

static void check(int shared)
{
    static double field[WIDTH * HEIGHT];
    struct welford bins[SPECTRUM_BINS] = {{0}};
    struct power_spectrum s = {0};
    struct rng rng;
    rng_init(&rng, 7, 1, (uint64_t)shared);
    for (int i = 0; i < FIELDS; i++) {
        draw(&rng, shared, field);
        assert_true(power_spectrum_make(field, WIDTH, HEIGHT, &s));
        for (int b = 0; b < s.count; b++)
            welford_add(&bins[b], s.power[b]);
    }
    assert_true(s.count >= 8 && s.count <= SPECTRUM_BINS);
    for (int b = 0; b < s.count; b++) {
        double wanted = expected(s.frequency[b], power_spectrum_side(WIDTH, HEIGHT),
                                 shared);
        double z = (bins[b].mean - wanted) / welford_se(&bins[b]);
        if (!(fabs(z) < LIMIT))
            fail_msg("at %g: %g, not %g: %g standard errors", s.frequency[b],
                     bins[b].mean, wanted, z);
    }
}

static void white_noise_is_flat(void **state)
{
    (void)state;
    check(1);
}

static void shared_noise_falls_as_it_must(void **state)
{
    (void)state;
    check(2);
}

/* A constant has no spectrum, however large it is. */
static void mean_does_not_leak(void **state)
{
    (void)state;
    static double field[WIDTH * HEIGHT];
    struct power_spectrum s;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        field[i] = 1e6;
    assert_true(power_spectrum_make(field, WIDTH, HEIGHT, &s));
    for (int b = 0; b < s.count; b++)
        assert_true(s.power[b] < 1e-9);
    assert_false(power_spectrum_make(field, 15, HEIGHT, &s));
    assert_int_equal(s.count, 0);
}

static void check_low_over_high(const struct analysis_spectrum *s)
{
    struct welford low = {0}, high = {0};
    for (int b = 0; b < s->mean.count; b++) {
        if (s->mean.frequency[b] < 1.0 / 16.0)
            welford_add(&low, s->mean.power[b]);
        if (s->mean.frequency[b] > 1.0 / 4.0)
            welford_add(&high, s->mean.power[b]);
    }
    assert_true(fabs(s->low_over_high / (low.mean / high.mean) - 1.0) < 1e-12);
}

/* Pictures 1 + noise: of two, three seeds, and of one against the truth, the power of the
 * noise, whose relative error has weight 1/1.01. 1 % trimmed, which is done where there
 * are two, takes 8 % of the power: E[x^2; |x| > 2.576] = 0.0845 for the normal deviate.
 */
static void pictures_of_seeds_give_the_variance(void **state)
{
    (void)state;
    const double sigma = 0.01, whole = sigma * sigma / 1.01;
    static double field[WIDTH * HEIGHT];
    struct image *pictures[3], *truth = image_create(WIDTH, HEIGHT);
    struct welford powers[4] = {{0}};
    struct rng rng;
    rng_init(&rng, 9, 1, 1);
    for (int p = 0; p < 3; p++)
        pictures[p] = image_create(WIDTH, HEIGHT);
    for (long i = 0; i < 3L * WIDTH * HEIGHT; i++)
        truth->pixels[i] = 1.0f;
    for (int repeat = 0; repeat < 12; repeat++) {
        for (int p = 0; p < 3; p++) {
            draw(&rng, 1, field);
            for (long i = 0; i < 3L * WIDTH * HEIGHT; i++)
                pictures[p]->pixels[i] = (float)(1.0 + sigma * field[i / 3]);
        }
        for (size_t n = 1; n <= 3; n++) {
            struct analysis_spectrum s;
            struct err err = {0};
            assert_true(analysis_spectrum_pictures((const struct image *const *)pictures,
                                                   n, n == 1 ? truth : NULL, &s, &err));
            welford_add(&powers[n], s.mean.power[s.mean.count - 1]);
            check_low_over_high(&s);
        }
    }
    for (size_t n = 1; n <= 3; n++) {
        double wanted = n > 1 ? whole * (1.0 - 0.0845) : whole;
        double z = (powers[n].mean - wanted) / welford_se(&powers[n]);
        if (!(fabs(z) < LIMIT))
            fail_msg("%zu pictures: %g, not %g: %g standard errors", n, powers[n].mean,
                     wanted, z);
    }
    struct analysis_spectrum s;
    struct err err = {0};
    assert_false(analysis_spectrum_pictures((const struct image *const *)pictures, 1,
                                            NULL, &s, &err));
    for (int p = 0; p < 3; p++)
        image_destroy(pictures[p]);
    image_destroy(truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transform_is_its_definition),
        cmocka_unit_test(white_noise_is_flat),
        cmocka_unit_test(shared_noise_falls_as_it_must),
        cmocka_unit_test(mean_does_not_leak),
        cmocka_unit_test(pictures_of_seeds_give_the_variance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
