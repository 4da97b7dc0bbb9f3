#include "surface/fresnel.h"

#include <complex.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define ROUNDING 1e-12

static void close_to(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", a, b, tolerance);
}

/* The definition: amplitudes with complex index and complex cosine, averaged. */
static double by_definition(double cosine, double eta, double k)
{
    double complex i = csqrt(-1.0), n = eta + k * i, cos_i = cosine;
    double complex cos_t = csqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
    double complex s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    double complex p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return 0.5 * (cabs(s) * cabs(s) + cabs(p) * cabs(p));
}

static void test_glass_at_normal_incidence(void **state)
{
    (void)state;
    double cos_t;
    close_to(fresnel_dielectric(1.0, 1.5, &cos_t), 0.04, ROUNDING);
    close_to(cos_t, 1.0, 0.0);
    close_to(fresnel_dielectric(1.0, 1.0 / 1.5, &cos_t), 0.04, ROUNDING);
    close_to(fresnel_dielectric(0.0, 1.5, &cos_t), 1.0, ROUNDING);
    close_to(fresnel_dielectric(0.3, 1.0, &cos_t), 0.0, 0.0);
    close_to(cos_t, 0.3, 0.0);
}

/* At Brewster's angle p vanishes and s is ((1-n^2)/(1+n^2))^2. */
static void test_brewster_angle(void **state)
{
    (void)state;
    double n = 1.5, cosine = cos(atan(n)), cos_t;
    double s = (1.0 - n * n) / (1.0 + n * n);
    close_to(fresnel_dielectric(cosine, n, &cos_t), 0.5 * s * s, ROUNDING);
}

static void test_total_internal_reflection(void **state)
{
    (void)state;
    double eta = 1.0 / 1.5, critical = sqrt(1.0 - eta * eta), cos_t;
    close_to(fresnel_dielectric(critical - 1e-9, eta, &cos_t), 1.0, 0.0);
    close_to(cos_t, 0.0, 0.0);
    assert_true(fresnel_dielectric(critical + 1e-9, eta, &cos_t) < 1.0);
    assert_true(cos_t > 0.0);
}

static void test_dielectric_by_definition_and_from_both_sides(void **state)
{
    (void)state;
    const double etas[] = {0.3, 0.75, 1.0, 1.33, 1.5, 2.4, 10.0};
    for (int e = 0; e < 7; e++)
        for (int i = 1; i <= 1000; i++) {
            double cos_t, back, cosine = i / 1000.0;
            double f = fresnel_dielectric(cosine, etas[e], &cos_t);
            close_to(f, by_definition(cosine, etas[e], 0.0), 1e-9);
            if (f == 1.0)
                continue;
            double sine_o = sqrt(1.0 - cosine * cosine);
            double sine_t = sqrt(1.0 - cos_t * cos_t);
            close_to(sine_o, etas[e] * sine_t, 1e-7); /* Snell */
            if (cos_t < 1e-3)
                continue; /* the way back is beyond what 1 - c^2 can tell */
            close_to(fresnel_dielectric(cos_t, 1.0 / etas[e], &back), f, 1e-9);
            close_to(fresnel_dielectric_cosines(cos_t, cosine, 1.0 / etas[e]), f,
                     ROUNDING);
        }
}

static void test_conductor_by_definition(void **state)
{
    (void)state;
    const double etas[] = {0.0, 0.05, 0.2, 1.0, 1.5, 3.0}, ks[] = {0.0, 0.5, 2.0, 7.0};
    for (int e = 0; e < 6; e++)
        for (int j = 0; j < 4; j++)
            for (int i = 0; i <= 1000; i++) {
                double c = i / 1000.0;
                struct rgb f = fresnel_conductor(c, rgb_grey(etas[e]), rgb_grey(ks[j]));
                assert_true(isfinite(f.r) && f.r >= 0.0 && f.r <= 1.0 + ROUNDING);
                if (etas[e] == 0.0)
                    close_to(f.r, 1.0, 1e-9); /* no real part: nothing enters */
                else if (c > 0.0)             /* at 0 the definition is 0/0 for index 1 */
                    close_to(f.r, by_definition(c, etas[e], ks[j]), 1e-9);
            }
}

/* Gold in linear RGB: ((n-1)^2 + k^2)/((n+1)^2 + k^2), worked out by hand. */
static void test_gold_at_normal_incidence(void **state)
{
    (void)state;
    struct rgb f = fresnel_conductor(1.0, rgb(0.143119, 0.374957, 1.442479),
                                     rgb(3.983160, 2.385721, 1.603215));
    close_to(f.r, 0.9667, 1e-4);
    close_to(f.g, 0.8022, 1e-4);
    close_to(f.b, 0.3240, 1e-4);
}

static void test_schlick(void **state)
{
    (void)state;
    struct rgb f0 = rgb(0.04, 0.5, 1.0), f = fresnel_schlick(1.0, f0);
    assert_true(f.r == f0.r && f.g == f0.g && f.b == f0.b);
    f = fresnel_schlick(0.0, f0);
    assert_true(f.r == 1.0 && f.g == 1.0 && f.b == 1.0);
    close_to(fresnel_schlick(0.5, f0).r, 0.04 + 0.96 / 32.0, ROUNDING);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_glass_at_normal_incidence),
        cmocka_unit_test(test_brewster_angle),
        cmocka_unit_test(test_total_internal_reflection),
        cmocka_unit_test(test_dielectric_by_definition_and_from_both_sides),
        cmocka_unit_test(test_conductor_by_definition),
        cmocka_unit_test(test_gold_at_normal_incidence),
        cmocka_unit_test(test_schlick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
