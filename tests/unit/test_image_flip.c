/* FLIP against a slow second implementation (kernels in two dimensions, sums in double,
 * written from the papers' formulas), and against figures worked out by hand. The two
 * round differently (planes of floats against doubles): their difference is bounded from
 * the 24 bits of a float, and the faults planted here are far above it. */
#include "image/flip.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/near.h"

#include <math.h>
#include <string.h>

#define SIZE 24
#define PPD  (3840.0 * MATH_PI / 180.0)

/* --- the slow one ------------------------------------------------------------------ */

typedef double plane[SIZE][SIZE];

static double f_lab(double t)
{
    return t > 216.0 / 24389.0 ? pow(t, 1.0 / 3.0) : t * 841.0 / 108.0 + 4.0 / 29.0;
}

/* [Andersson20]'s matrix, the sums of its rows being the white point. */
static void xyz(const double c[3], double out[3])
{
    out[0] = (10135552.0 * c[0] + 8788810.0 * c[1] + 4435075.0 * c[2]) / 24577794.0;
    out[1] = (2613072.0 * c[0] + 8788810.0 * c[1] + 887015.0 * c[2]) / 12288897.0;
    out[2] = (1425312.0 * c[0] + 8788810.0 * c[1] + 70074185.0 * c[2]) / 73733382.0;
    out[0] /= 0.9504285453771807;
    out[2] /= 1.0889003707981277;
}

/* The inverse as published, nine digits. */
static void linear(const double v[3], double out[3])
{
    double x = v[0] * 0.9504285453771807, y = v[1], z = v[2] * 1.0889003707981277;
    out[0] = 3.241003275 * x - 1.537398934 * y - 0.498615861 * z;
    out[1] = -0.969224334 * x + 1.875930071 * y + 0.041554224 * z;
    out[2] = 0.055639423 * x - 0.204011202 * y + 1.057148933 * z;
}

static void hunt(const double c[3], double out[3])
{
    double v[3];
    xyz(c, v);
    out[0] = 116.0 * f_lab(v[1]) - 16.0;
    out[1] = 0.01 * out[0] * 500.0 * (f_lab(v[0]) - f_lab(v[1]));
    out[2] = 0.01 * out[0] * 200.0 * (f_lab(v[1]) - f_lab(v[2]));
}

static double hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) +
           sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

typedef double (*weight)(int x, int y);

static double csf(const double p[4], int x, int y)
{
    double z = (x / PPD) * (x / PPD) + (y / PPD) * (y / PPD);
    return p[0] * sqrt(MATH_PI / p[1]) * exp(-MATH_PI * MATH_PI * z / p[1]) +
           p[2] * sqrt(MATH_PI / p[3]) * exp(-MATH_PI * MATH_PI * z / p[3]);
}

static double weight_a(int x, int y)
{
    return csf((const double[]){1.0, 0.0047, 0.0, 1e-5}, x, y);
}

static double weight_rg(int x, int y)
{
    return csf((const double[]){1.0, 0.0053, 0.0, 1e-5}, x, y);
}

static double weight_by(int x, int y)
{
    return csf((const double[]){34.1, 0.04, 13.5, 0.025}, x, y);
}

static double bell(int x, int y)
{
    double sd = 0.5 * 0.082 * PPD;
    return exp(-(x * x + y * y) / (2.0 * sd * sd));
}

static double weight_edge(int x, int y)
{
    return -x * bell(x, y);
}

static double weight_point(int x, int y)
{
    double sd = 0.5 * 0.082 * PPD;
    return (x * x / (sd * sd) - 1.0) * bell(x, y);
}

static int inside(int i)
{
    return i < 0 ? 0 : i >= SIZE ? SIZE - 1 : i;
}

/* Positive weights sum to 1, negative ones to -1. */
static void convolve(plane in, weight of, int radius, bool turned, plane out)
{
    double positive = 0.0, negative = 0.0;
    for (int y = -radius; y <= radius; y++)
        for (int x = -radius; x <= radius; x++)
            *(of(x, y) > 0.0 ? &positive : &negative) += fabs(of(x, y));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double sum = 0.0;
            for (int j = -radius; j <= radius; j++)
                for (int i = -radius; i <= radius; i++) {
                    double w = turned ? of(j, i) : of(i, j);
                    sum += in[inside(y + j)][inside(x + i)] * w /
                           (w > 0.0 ? positive : negative);
                }
            out[y][x] = sum;
        }
}

static void analyse(const struct image *image, double exposure, plane lab[3],
                    plane features[2])
{
    static plane opponent[3], blurred[3], along[2];
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double c[3], v[3];
            for (int i = 0; i < 3; i++) {
                double value = (double)image_at(image, x, y)[i];
                double s = value * pow(2.0, exposure);
                /* With the factor .6 before the curve in its constants. */
                c[i] = isnan(exposure) ? fmin(value, 1.0)
                                       : fmin((0.9036 * s * s + 0.018 * s) /
                                                  (0.8748 * s * s + 0.354 * s + 0.14),
                                              1.0);
            }
            xyz(c, v);
            opponent[0][y][x] = 116.0 * v[1] - 16.0;
            opponent[1][y][x] = 500.0 * (v[0] - v[1]);
            opponent[2][y][x] = 200.0 * (v[1] - v[2]);
        }
    convolve(opponent[0], weight_a, 10, false, blurred[0]);
    convolve(opponent[1], weight_rg, 10, false, blurred[1]);
    convolve(opponent[2], weight_by, 10, false, blurred[2]);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double l = (blurred[0][y][x] + 16.0) / 116.0, c[3], out[3];
            linear((const double[]){l + blurred[1][y][x] / 500.0, l,
                                    l - blurred[2][y][x] / 200.0},
                   c);
            for (int i = 0; i < 3; i++)
                c[i] = fmin(fmax(c[i], 0.0), 1.0);
            hunt(c, out);
            for (int i = 0; i < 3; i++)
                lab[i][y][x] = out[i];
            opponent[0][y][x] = (opponent[0][y][x] + 16.0) / 116.0;
        }
    for (int f = 0; f < 2; f++) {
        weight of = f == 0 ? weight_edge : weight_point;
        convolve(opponent[0], of, 9, false, along[0]);
        convolve(opponent[0], of, 9, true, along[1]);
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++)
                features[f][y][x] = sqrt(along[0][y][x] * along[0][y][x] +
                                         along[1][y][x] * along[1][y][x]);
    }
}

static double redistribute(double distance)
{
    const double green[3] = {0.0, 1.0, 0.0}, blue[3] = {0.0, 0.0, 1.0};
    double a[3], b[3], power = pow(distance, 0.7);
    hunt(green, a);
    hunt(blue, b);
    double most = pow(hyab(a, b), 0.7);
    return power < 0.4 * most ? 0.95 * power / (0.4 * most)
                              : 0.95 + 0.05 * (power - 0.4 * most) / (0.6 * most);
}

static void slow_map(const struct image *a, const struct image *b, double exposure,
                     plane out)
{
    static plane lab[2][3], features[2][2];
    analyse(a, exposure, lab[0], features[0]);
    analyse(b, exposure, lab[1], features[1]);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double v[2][3], feature = 0.0;
            for (int k = 0; k < 2; k++)
                for (int i = 0; i < 3; i++)
                    v[k][i] = lab[k][i][y][x];
            for (int f = 0; f < 2; f++)
                feature = fmax(feature,
                               fabs(features[0][f][y][x] - features[1][f][y][x]));
            out[y][x] = fmax(out[y][x], pow(redistribute(hyab(v[0], v[1])),
                                            1.0 - sqrt(feature / sqrt(2.0))));
        }
}

static double mean_of(plane map)
{
    double sum = 0.0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            sum += map[y][x];
    return sum / (SIZE * SIZE);
}

/* --- tests ------------------------------------------------------------------------- */

/* Patches of colour with noise and a bright spot: edges, points, values above 1. */
static struct image *drawn(uint64_t seed, double noise)
{
    struct rng rng;
    struct image *image = image_create(SIZE, SIZE);
    rng_init(&rng, seed, RNG_CHAIN, 0);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            for (int c = 0; c < 3; c++) {
                double v = 0.1 + 0.4 * ((x / 8 + y / 6 + c) % 3);
                v *= x == 12 && y == 11 ? 20.0 : 1.0;
                image_at(image, x, y)[c] = (float)(v * (1.0 + noise * rng_double(&rng)));
            }
    return image;
}

static void agrees_with_the_slow_one(void **state)
{
    (void)state;
    static plane ldr, hdr;
    struct image *a = drawn(1, 0.8), *b = drawn(2, 0.1);
    struct flip flip;
    assert_true(flip_compare(a, b, &flip, NULL));
    memset(ldr, 0, sizeof ldr);
    memset(hdr, 0, sizeof hdr);
    slow_map(a, b, (double)NAN, ldr);
    for (int i = 0; i < flip.exposures; i++)
        slow_map(a, b,
                 flip.exposure_first + (flip.exposure_last - flip.exposure_first) * i /
                                           (flip.exposures - 1),
                 hdr);
    assert_true(flip.ldr > 0.05 && flip.hdr > flip.ldr / 2.0);
    assert_relative(flip.ldr, mean_of(ldr), 2e-5);
    assert_relative(flip.hdr, mean_of(hdr), 2e-5);
    image_destroy(a);
    image_destroy(b);
}

static struct image *uniform(float r, float g, float b)
{
    struct image *image = image_create(SIZE, SIZE);
    for (int i = 0; i < SIZE * SIZE; i++) {
        image->pixels[3 * i] = r;
        image->pixels[3 * i + 1] = g;
        image->pixels[3 * i + 2] = b;
    }
    return image;
}

/* Uniform pictures have no features. Black and white differ by 100 in L*; green and blue
 * by the greatest distance there is. */
static void uniform_pictures(void **state)
{
    (void)state;
    struct image *black = uniform(0.0f, 0.0f, 0.0f), *white = uniform(1.0f, 1.0f, 1.0f);
    struct image *green = uniform(0.0f, 1.0f, 0.0f), *blue = uniform(0.0f, 0.0f, 1.0f);
    struct flip flip;
    assert_true(flip_compare(white, white, &flip, NULL));
    assert_true(flip.ldr == 0.0 && flip.hdr == 0.0);
    assert_true(flip_compare(black, white, &flip, NULL));
    assert_relative(flip.ldr, redistribute(100.0), 2e-5);
    assert_true(flip.ldr > 0.967 && flip.ldr < 0.968);
    assert_true(flip_compare(green, blue, &flip, NULL));
    assert_relative(flip.ldr, 1.0, 2e-5);
    assert_true(flip_compare(black, black, &flip, NULL) && flip.hdr == 0.0);
    image_destroy(black);
    image_destroy(white);
    image_destroy(green);
    image_destroy(blue);
}

static double curve(double x)
{
    return (0.9036 * x * x + 0.018 * x) / (0.8748 * x * x + 0.354 * x + 0.14);
}

/* The first exposure brings the brightest pixel to .85, the last one the median; a
 * picture that is black but for a few pixels has exposures too. */
static void exposures(void **state)
{
    (void)state;
    struct image *b = uniform(0.02f, 0.02f, 0.02f), *a = uniform(0.03f, 0.02f, 0.02f);
    struct flip flip;
    for (int i = 0; i < 3 * SIZE * SIZE / 3; i++)
        b->pixels[i] = 0.01f; /* a third of them: the median stays */
    image_at(b, 3, 23)[0] = image_at(b, 3, 23)[1] = image_at(b, 3, 23)[2] = 5.0f;
    assert_true(flip_compare(a, b, &flip, NULL));
    assert_relative(curve(5.0 * exp2(flip.exposure_first)), 0.85, 1e-6);
    assert_relative(curve(0.02 * exp2(flip.exposure_last)), 0.85, 1e-6);
    assert_int_equal(flip.exposures, 8); /* log2(250) = 7.97 */
    memset(b->pixels, 0, 3 * SIZE * SIZE * sizeof(float));
    image_at(b, 3, 3)[1] = 5.0f;
    assert_true(flip_compare(a, b, &flip, NULL));
    assert_true(isfinite(flip.hdr) && flip.exposures == 2);
    image_destroy(a);
    image_destroy(b);
}

/* Pixels that are not finite are left out and do not spread. */
static void not_finite(void **state)
{
    (void)state;
    struct image *a = drawn(1, 0.0), *b = drawn(1, 0.0);
    struct err err = {0};
    struct flip flip;
    image_at(a, 5, 5)[1] = NAN;
    image_at(b, 9, 9)[2] = INFINITY;
    assert_true(flip_compare(a, b, &flip, NULL));
    assert_true(flip.ldr == 0.0 && flip.hdr == 0.0);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        a->pixels[i] = NAN;
    assert_false(flip_compare(a, b, &flip, &err));
    struct image *small = image_create(3, 2);
    assert_false(flip_compare(small, b, &flip, &err));
    image_destroy(a);
    image_destroy(b);
    image_destroy(small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_slow_one),
        cmocka_unit_test(uniform_pictures),
        cmocka_unit_test(exposures),
        cmocka_unit_test(not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
