/* Microfacets over alpha 1e-5..1 and grazing angles down to 1e-6 rad: everything finite,
 * bounded as the theory bounds it, and right where a limit is known. */

#include "math/rng.h"
#include "support/albedo.h"
#include "surface/microfacet.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <cmocka.h>

static const double alphas[] = {1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0};
static const double elevations[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0, 1.5707};
#define ALPHAS     ((int)(sizeof alphas / sizeof alphas[0]))
#define ELEVATIONS ((int)(sizeof elevations / sizeof elevations[0]))
#define ROUNDING   1e-12

static struct direction at_elevation(double elevation, double phi)
{
    double c = cos(elevation);
    return (struct direction){c * cos(phi), c * sin(phi), sin(elevation)};
}

static void each(void (*check)(const struct microfacet *mf, struct direction w))
{
    for (int distribution = 0; distribution < 2; distribution++)
        for (int u = 0; u < ALPHAS; u++)
            for (int v = 0; v < ALPHAS; v++)
                for (int e = 0; e < ELEVATIONS; e++) {
                    struct microfacet mf = {alphas[u], alphas[v],
                                            (enum microfacet_distribution)distribution};
                    check(&mf, at_elevation(elevations[e], 0.7 * e));
                }
}

/* cos <= sigma <= cos + half the stretched sine: between a smooth surface and a needle
 * field; masking lies in [0,1]. */
static void check_area(const struct microfacet *mf, struct direction w)
{
    double area = microfacet_area(mf, w), g1 = microfacet_g1(mf, w);
    double sine = hypot(mf->alpha_u * w.x, mf->alpha_v * w.y);
    assert_true(isfinite(area) && area >= w.z * (1.0 - ROUNDING));
    assert_true(area <= w.z + 0.5 * sine * (1.0 + ROUNDING));
    assert_true(g1 > 0.0 && g1 <= 1.0 + ROUNDING);
}

static void test_visible_area_is_bounded(void **state)
{
    (void)state;
    each(check_area);
}

/* Grazing limits: sigma -> a sine/2 (GGX), a sine/(2 sqrt(pi)) (Beckmann). */
static void test_visible_area_at_grazing(void **state)
{
    (void)state;
    const double limits[2] = {0.5, 0.28209479177387814};
    for (int distribution = 0; distribution < 2; distribution++) {
        struct microfacet mf = {1.0, 1.0, (enum microfacet_distribution)distribution};
        struct direction w = at_elevation(1e-6, 0.3);
        double area = microfacet_area(&mf, w);
        /* The next term is cos/2. */
        assert_true(fabs(area - limits[distribution] - 0.5 * w.z) < 1e-11);
    }
}

/* Visible normals: unit, above, facing the view; density finite and positive. */
static void check_samples(const struct microfacet *mf, struct direction w)
{
    const double ends[] = {0.0, 0x1p-53, 1e-9,       0.25,
                           0.5, 0.75,    1.0 - 1e-9, 1.0 - 0x1p-53};
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 8; j++) {
            const double u[2] = {ends[i], ends[j]};
            struct direction m = microfacet_sample(mf, w, u);
            double length2 = direction_dot(m, m);
            assert_true(fabs(length2 - 1.0) < ROUNDING);
            assert_true(m.z >= 0.0);
            /* At the very edge the facet is seen from the side. */
            assert_true(direction_dot(m, w) > -1e-8);
            double pdf = microfacet_pdf(mf, w, m), d = microfacet_d(mf, m);
            assert_true(isfinite(pdf) && pdf >= 0.0 && isfinite(d) && d >= 0.0);
        }
}

static void test_samples_at_the_ends_of_u(void **state)
{
    (void)state;
    each(check_samples);
}

/* Stretched to roughness 1, the visible share of slopes beyond s along the view is known
 * in closed form, and must be 1 - u at the slope that u gives. */
static void check_visible_slopes(const struct microfacet *mf, struct direction w)
{
    if (mf->distribution != MICROFACET_BECKMANN)
        return;
    double x = mf->alpha_u * w.x, y = mf->alpha_v * w.y, sine = hypot(x, y);
    for (int k = 1; k < 20; k++) {
        const double u[2] = {k / 20.0, 0.5};
        struct direction m = microfacet_sample(mf, w, u);
        double slope = (m.x / mf->alpha_u * x + m.y / mf->alpha_v * y) / (m.z * sine);
        double beyond = 0.5 * w.z * erfc(slope) +
                        sine * exp(-slope * slope) / (2.0 * sqrt(MATH_PI));
        assert_true(fabs(beyond / microfacet_area(mf, w) - (1.0 - u[0])) < 1e-9);
    }
}

static void test_beckmann_inverts_its_distribution(void **state)
{
    (void)state;
    each(check_visible_slopes);
}

/* All that a renderer asks of rough kinds stays finite and weights stay within [0,1]. */
static void check_kind(const struct bsdf *bsdf, struct vec3 wo, struct rng *rng)
{
    for (int k = 0; k < 20; k++) {
        const double u[3] = {rng_double(rng), rng_double(rng), rng_double(rng)};
        struct bsdf_sample s;
        struct bsdf_value v;
        struct vec3 wi = wo;
        if (bsdf_sample(bsdf, wo, u, TRANSPORT_IMPORTANCE, &s)) {
            wi = s.wi;
            assert_true(isfinite(s.pdf) && s.pdf > 0.0);
            assert_true(isfinite(s.pdf_rev) && s.pdf_rev > 0.0);
            assert_true(s.weight.r >= 0.0 && s.weight.r <= 1.0 + 1e-6);
            assert_true(fabsf(vec3_length(wi) - 1.0f) < 3e-7f);
        }
        bsdf_eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v);
        assert_true(rgb_is_finite(v.f) && isfinite(v.pdf) && isfinite(v.pdf_rev));
        assert_true(v.f.r >= 0.0 && v.f.g >= 0.0 && v.f.b >= 0.0);
        assert_true(v.pdf >= 0.0 && v.pdf_rev >= 0.0);
    }
}

static void test_rough_kinds_stay_finite(void **state)
{
    (void)state;
    const char *const kinds[] = {"roughconductor", "roughdielectric"};
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int kind = 0; kind < 2; kind++)
        for (int a = 0; a < ALPHAS; a++)
            for (int e = -ELEVATIONS; e < ELEVATIONS; e++)
                for (int distribution = 0; distribution < 2; distribution++) {
                    double which = distribution;
                    struct bsdf bsdf;
                    bsdf_init(&bsdf, bsdf_find(kinds[kind]));
                    assert_true(bsdf_set(&bsdf, "alpha", &alphas[a], 1, NULL, NULL));
                    assert_true(bsdf_set(&bsdf, "distribution", &which, 1, NULL, NULL));
                    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
                    struct direction w = at_elevation(elevations[e < 0 ? ~e : e], 1.0);
                    struct vec3 wo = direction_to_vec3(e < 0 ? direction_flip(w) : w);
                    check_kind(&bsdf, wo, &rng);
                }
}

/* Exactly grazing, or a number too small for squares: nothing, never NaN. */
static void test_exactly_grazing_scatters_nothing(void **state)
{
    (void)state;
    const struct vec3 grazing = {1.0f, 0.0f, 0.0f}, up = {0.0f, 0.0f, 1.0f};
    const struct vec3 tiny = {0.6f, 0.8f, 1e-38f}, back = {-0.6f, -0.8f, 1e-38f};
    for (int k = 0; bsdf_types[k]; k++) {
        struct bsdf bsdf;
        bsdf_init(&bsdf, bsdf_types[k]);
        assert_true(bsdf_prepare(&bsdf, NULL, NULL));
        const double u[3] = {0.5, 0.3, 0.7};
        struct bsdf_value v;
        struct bsdf_sample s;
        assert_false(bsdf_eval(&bsdf, grazing, up, TRANSPORT_RADIANCE, &v));
        assert_true(rgb_is_black(v.f) && v.pdf == 0.0 && v.pdf_rev == 0.0);
        assert_false(bsdf_eval(&bsdf, up, grazing, TRANSPORT_RADIANCE, &v));
        assert_true(rgb_is_black(v.f) && v.pdf == 0.0 && v.pdf_rev == 0.0);
        assert_false(bsdf_sample(&bsdf, grazing, u, TRANSPORT_RADIANCE, &s));
        assert_true(rgb_is_black(s.weight) && s.pdf == 0.0);
        bsdf_eval(&bsdf, tiny, back, TRANSPORT_RADIANCE, &v);
        assert_true(rgb_is_finite(v.f) && isfinite(v.pdf) && isfinite(v.pdf_rev));
        bsdf_eval(&bsdf, tiny, tiny, TRANSPORT_RADIANCE, &v);
        assert_true(rgb_is_finite(v.f) && isfinite(v.pdf) && isfinite(v.pdf_rev));
        if (bsdf_sample(&bsdf, tiny, u, TRANSPORT_RADIANCE, &s))
            assert_true(rgb_is_finite(s.weight) && isfinite(s.pdf) && s.pdf > 0.0);
    }
}

/* The length of a float vector, off by 1e-7, must not tilt half vectors: it would move a
 * lobe of alpha 1e-5 by a percent of its width. */
static void test_float_lengths_do_no_harm(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int i = 0; i < 1000; i++) {
        struct direction w = at_elevation(rng_double(&rng), 6.0 * rng_double(&rng));
        double off = 1.0 + 2e-7 * (rng_double(&rng) - 0.5);
        struct direction d = direction_from(direction_to_vec3(direction_scale(w, off)));
        assert_true(fabs(direction_dot(d, d) - 1.0) < 3e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_float_lengths_do_no_harm),
        cmocka_unit_test(test_visible_area_is_bounded),
        cmocka_unit_test(test_visible_area_at_grazing),
        cmocka_unit_test(test_samples_at_the_ends_of_u),
        cmocka_unit_test(test_beckmann_inverts_its_distribution),
        cmocka_unit_test(test_rough_kinds_stay_finite),
        cmocka_unit_test(test_exactly_grazing_scatters_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
