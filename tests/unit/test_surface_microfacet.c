/* Distributions of normals against their defining integrals, by quadrature in slopes
 * (x, y) = alpha (p, q), in which the distributions do not depend on alpha. */

#include "surface/microfacet.h"

#include "math/warp.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const double alphas[] = {1e-3, 1e-2, 0.1, 0.5, 1.0};
static const double cosines[] = {1.0, 0.9, 0.5, 0.1, 0.01};

typedef double (*integrand)(const struct microfacet *mf, struct direction wo,
                            struct direction m);

/* Over all normals m of the upper side, dm = cos^3 dx dy. Slope radius r = s/(1-s) on
 * [0,1) by midpoints, in a frame along the view, where what is visible ends at an
 * abscissa: (wo.m)+ is a kink only. */
static double over_normals(const struct microfacet *mf, struct direction wo, integrand f)
{
    enum { RADII = 800, ANGLES = 200 };
    double sum = 0.0;
    for (int i = 0; i < RADII; i++) {
        double s = (i + 0.5) / RADII, r = s / (1.0 - s);
        double jacobian = 1.0 / ((1.0 - s) * (1.0 - s) * RADII), ring = 0.0;
        for (int j = 0; j < ANGLES; j++) {
            double phi = 2.0 * MATH_PI * (j + 0.5) / ANGLES;
            struct direction m = {mf->alpha_u * r * cos(phi), mf->alpha_v * r * sin(phi),
                                  1.0};
            double scale = 1.0 / sqrt(direction_dot(m, m));
            m = direction_scale(m, scale);
            ring += f(mf, wo, m) * scale * scale * scale;
        }
        sum += ring * r * jacobian;
    }
    return sum * mf->alpha_u * mf->alpha_v * 2.0 * MATH_PI / ANGLES;
}

static double projected(const struct microfacet *mf, struct direction wo,
                        struct direction m)
{
    (void)wo;
    return microfacet_d(mf, m) * m.z;
}

static double visible(const struct microfacet *mf, struct direction wo,
                      struct direction m)
{
    double cosine = direction_dot(wo, m);
    return cosine > 0.0 ? microfacet_d(mf, m) * cosine : 0.0;
}

static double visible_normal(const struct microfacet *mf, struct direction wo,
                             struct direction m)
{
    return microfacet_pdf(mf, wo, m);
}

static struct direction view(double cosine)
{
    double sine = sqrt(1.0 - cosine * cosine);
    return (struct direction){sine * 0.6, sine * 0.8, cosine};
}

static void check_integrals(struct microfacet mf)
{
    assert_true(fabs(over_normals(&mf, view(1.0), projected) - 1.0) < 1e-5);
    for (int c = 0; c < 5; c++) {
        struct direction wo = view(cosines[c]);
        double area = microfacet_area(&mf, wo);
        /* sigma is the visible area [Heitz14]; visible normals have density. */
        assert_true(fabs(over_normals(&mf, wo, visible) / area - 1.0) < 1e-4);
        assert_true(fabs(over_normals(&mf, wo, visible_normal) - 1.0) < 1e-4);
    }
}

static void test_normals_cover_the_surface(void **state)
{
    (void)state;
    for (int distribution = 0; distribution < 2; distribution++)
        for (int a = 0; a < 5; a++)
            check_integrals(
                (struct microfacet){alphas[a], a % 2 ? alphas[a] : 0.3 * alphas[a],
                                    (enum microfacet_distribution)distribution});
}

/* The weak furnace [Heitz14]: what leaves a perfect mirror of microfacets,
 * masked once and never shadowed, is 1: the integral over wi of D G1(wo)/(4 cos wo).
 * Reflected directions below the horizon count. wi = reflect(wo, m), dwi = 4 wo.m dm. */
static double weak_furnace_term(const struct microfacet *mf, struct direction wo,
                                struct direction m)
{
    double cosine = direction_dot(wo, m);
    if (cosine <= 0.0)
        return 0.0;
    return microfacet_d(mf, m) * microfacet_g1(mf, wo) / (4.0 * wo.z) * 4.0 * cosine;
}

static void test_weak_furnace(void **state)
{
    (void)state;
    for (int distribution = 0; distribution < 2; distribution++)
        for (int a = 0; a < 5; a++)
            for (int c = 0; c < 5; c++) {
                struct microfacet mf = {alphas[a], alphas[a],
                                        (enum microfacet_distribution)distribution};
                double sum = over_normals(&mf, view(cosines[c]), weak_furnace_term);
                assert_true(fabs(sum - 1.0) < 1e-4);
            }
}

/* Masking against Smith's formulas as they are printed, Beckmann's by its integral
 * definition through erf [Walter07 Eq. 26 and 34]. */
static void test_masking_as_printed(void **state)
{
    (void)state;
    for (int a = 0; a < 5; a++)
        for (int c = 1; c < 5; c++) {
            double cosine = cosines[c], tangent = sqrt(1.0 / (cosine * cosine) - 1.0);
            double at = alphas[a] * tangent, x = 1.0 / at;
            struct microfacet ggx = {alphas[a], alphas[a], MICROFACET_GGX};
            struct microfacet beckmann = {alphas[a], alphas[a], MICROFACET_BECKMANN};
            double g = 2.0 / (1.0 + sqrt(1.0 + at * at));
            double b = 2.0 / (1.0 + erf(x) + exp(-x * x) / (x * sqrt(MATH_PI)));
            assert_true(fabs(microfacet_g1(&ggx, view(cosine)) - g) < 1e-12);
            assert_true(fabs(microfacet_g1(&beckmann, view(cosine)) - b) < 1e-12);
            /* G2 = 1/(1 + Lambda_o + Lambda_i) with the cosines that cancel. */
            double area = microfacet_area(&ggx, view(cosine)), lambda = 1.0 / g - 1.0;
            double area_i = microfacet_area(&ggx, view(0.7));
            double lambda_i = area_i / 0.7 - 1.0;
            double over = microfacet_cosines_over_g2(cosine, area, 0.7, area_i);
            double expected = cosine * 0.7 * (1.0 + lambda + lambda_i);
            assert_true(fabs(over - expected) < 1e-12 * expected);
        }
}

/* Values of pbrt v3's polynomial, worked out apart. */
static void test_roughness_to_alpha(void **state)
{
    (void)state;
    assert_true(fabs(microfacet_roughness_to_alpha(1.0) - 1.62142) < 1e-12);
    assert_true(fabs(microfacet_roughness_to_alpha(0.1) - 0.461760032) < 1e-9);
    assert_true(microfacet_roughness_to_alpha(0.0) ==
                microfacet_roughness_to_alpha(1e-3));
    assert_true(fabs(microfacet_roughness_to_alpha(0.0) - 0.047269451) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normals_cover_the_surface),
        cmocka_unit_test(test_weak_furnace),
        cmocka_unit_test(test_masking_as_printed),
        cmocka_unit_test(test_roughness_to_alpha),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
