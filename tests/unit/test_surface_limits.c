/* Kinds against each other and against formulas as printed: smooth kinds as limits of
 * the rough ones, Snell's law, the eta^2 of radiance, substrate by transcription. */

#include "math/rng.h"
#include "support/albedo.h"
#include "support/bsdf_make.h"

#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

static bool near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance;
}

/* Both lobes of pbrt's glass: directions, probabilities, weights, reverse densities. */
static void check_glass(double eta, double cosine)
{
    struct bsdf glass = bsdf_make("dielectric", "eta", eta, "reflectance", 0.9,
                                  "transmittance", 0.8, NULL);
    struct vec3 wo = bsdf_direction(cosine, 0.8);
    double c = fabs((double)wo.z), sine = sqrt(1.0 - c * c);
    double ratio = cosine > 0.0 ? eta : 1.0 / eta, sine_t = sine / ratio;
    const double first[3] = {0.0, 0.0, 0.0}, last[3] = {1.0 - 0x1p-53, 0.0, 0.0};
    struct bsdf_sample s;
    struct bsdf_value v;
    assert_true(bsdf_sample(&glass, wo, first, TRANSPORT_RADIANCE, &s));
    assert_true(s.delta && !s.transmission && s.pdf == s.pdf_rev);
    assert_true(s.wi.x == -wo.x && s.wi.y == -wo.y && s.wi.z == wo.z);
    assert_true(near(s.weight.r, 0.9, 1e-12));
    assert_false(bsdf_eval(&glass, wo, s.wi, TRANSPORT_RADIANCE, &v));
    double fresnel = s.pdf;
    assert_true(bsdf_sample(&glass, wo, last, TRANSPORT_RADIANCE, &s));
    if (sine_t >= 1.0) {
        assert_true(!s.transmission && s.pdf == 1.0);
        return;
    }
    double cos_t = sqrt(1.0 - sine_t * sine_t);
    assert_true(s.delta && s.transmission && near(s.pdf, 1.0 - fresnel, 1e-12));
    assert_true(near((double)s.wi.z, cosine > 0.0 ? -cos_t : cos_t, 3e-7));
    assert_true(near((double)s.wi.x, -(double)wo.x / ratio, 3e-7));
    assert_true(near((double)s.wi.y, -(double)wo.y / ratio, 3e-7));
    assert_true(near(s.weight.r, 0.8 / (ratio * ratio), 1e-12));
    assert_true(bsdf_sample(&glass, wo, last, TRANSPORT_IMPORTANCE, &s));
    assert_true(near(s.weight.r, 0.8, 1e-12));
    /* The way back chooses by the same Fresnel term. */
    double jacobian = c / (cos_t * ratio * ratio);
    assert_true(near(s.pdf_rev / s.pdf, jacobian, 1e-5 * jacobian));
    assert_false(bsdf_eval(&glass, wo, s.wi, TRANSPORT_RADIANCE, &v));
}

static void test_glass(void **state)
{
    (void)state;
    const double cosines[] = {0.999, 0.6, 0.1, -0.999, -0.8, -0.6, -0.1};
    const double etas[] = {1.5, 0.8, 2.4};
    for (int e = 0; e < 3; e++)
        for (int c = 0; c < 7; c++)
            check_glass(etas[e], cosines[c]);
}

/* Mean direction over a grid of numbers of one lobe; returns the samples used. */
static int mean_direction(const struct bsdf *bsdf, struct vec3 wo, bool transmission,
                          double mean[3])
{
    enum { GRID = 64 };
    int count = 0;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (int i = 0; i < GRID * GRID; i++) {
        const double u[3] = {transmission ? 1.0 - 0x1p-53 : 0.0, (i % GRID + 0.5) / GRID,
                             ((double)(i / GRID) + 0.5) / GRID};
        struct bsdf_sample s;
        if (!bsdf_sample(bsdf, wo, u, TRANSPORT_RADIANCE, &s))
            continue;
        if (s.transmission != transmission)
            continue;
        mean[0] += (double)s.wi.x;
        mean[1] += (double)s.wi.y;
        mean[2] += (double)s.wi.z;
        count++;
    }
    for (int k = 0; k < 3; k++)
        mean[k] /= count ? count : 1;
    return count;
}

static struct bsdf rough(const char *smooth, double alpha, double distribution)
{
    const char *kind = *smooth == 'c' ? "roughconductor" : "roughdielectric";
    return bsdf_make(kind, "alpha", alpha, "distribution", distribution, NULL);
}

/* As alpha falls, albedo, directions and the ratio of densities become the smooth
 * kind's. A share alpha^2/s^2 of GGX's facets tilts by more than s; cos -0.8 is
 * .08 rad from the critical angle, the nearest feature of all. */
static void check_limit(const char *kind, double cosine, double alpha,
                        double distribution)
{
    struct bsdf smooth = bsdf_make(kind, NULL),
                near_it = rough(kind, alpha, distribution);
    struct vec3 wo = bsdf_direction(cosine, 2.0);
    double error;
    struct rgb a = albedo_quadrature(&smooth, wo, TRANSPORT_RADIANCE);
    struct rgb b = albedo_quadrature_error(&near_it, wo, TRANSPORT_RADIANCE, &error);
    double s2 = 0.08 * 0.08, tolerance = error + 2.0 * alpha * alpha / s2 + 1e-6;
    assert_true(near(a.r, b.r, tolerance * fmax(1.0, a.r)));
    assert_true(near(a.b, b.b, tolerance * fmax(1.0, a.b)));
    for (int end = 0; end < 2; end++) {
        const double u[3] = {end ? 1.0 - 0x1p-53 : 0.0, 0.0, 0.0};
        struct bsdf_sample s;
        struct bsdf_value v;
        double mean[3];
        assert_true(bsdf_sample(&smooth, wo, u, TRANSPORT_RADIANCE, &s));
        assert_true(mean_direction(&near_it, wo, s.transmission, mean) > 4000);
        assert_true(near(mean[0], (double)s.wi.x, alpha + 1e-7));
        assert_true(near(mean[1], (double)s.wi.y, alpha + 1e-7));
        assert_true(near(mean[2], (double)s.wi.z, alpha + 1e-7));
        assert_true(bsdf_eval(&near_it, wo, s.wi, TRANSPORT_RADIANCE, &v));
        double ratio = s.pdf_rev / s.pdf;
        assert_true(near(v.pdf_rev / v.pdf, ratio, (10.0 * alpha + 1e-5) * ratio));
    }
}

static void test_smooth_kinds_are_limits_of_rough_ones(void **state)
{
    (void)state;
    const double cosines[] = {1.0, 0.7, 0.3, -0.95, -0.8};
    const double alphas[] = {1e-3, 1e-4, 1e-5};
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 5; c++)
            for (double d = 0.0; d < 2.0; d += 1.0) {
                check_limit("conductor", cosines[c], alphas[a], d);
                check_limit("dielectric", cosines[c], alphas[a], d);
            }
}

/* Ashikhmin and Shirley's coat as pbrt v3 writes it, with angles and trigonometry. */
struct coat {
    double kd, ks, alpha_u, alpha_v;
};

static double coat_d(const struct coat *k, const double h[3])
{
    double tan2 = (1.0 - h[2] * h[2]) / (h[2] * h[2]), phi = atan2(h[1], h[0]);
    double e = tan2 * (pow(cos(phi) / k->alpha_u, 2.0) + pow(sin(phi) / k->alpha_v, 2.0));
    return 1.0 / (MATH_PI * k->alpha_u * k->alpha_v * pow(h[2], 4.0) * pow(1.0 + e, 2.0));
}

static double coat_g1(const struct coat *k, struct vec3 w)
{
    double c = fabs((double)w.z), phi = atan2((double)w.y, (double)w.x);
    double alpha = hypot(cos(phi) * k->alpha_u, sin(phi) * k->alpha_v);
    double tangent = sqrt(1.0 / (c * c) - 1.0);
    return 1.0 / (1.0 + 0.5 * (sqrt(1.0 + pow(alpha * tangent, 2.0)) - 1.0));
}

static void coat_by_hand(const struct coat *k, struct vec3 wo, struct vec3 wi, double *f,
                         double *pdf)
{
    double h[3] = {(double)wo.x + (double)wi.x, (double)wo.y + (double)wi.y,
                   (double)wo.z + (double)wi.z};
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int i = 0; i < 3; i++)
        h[i] /= length;
    double cos_o = fabs((double)wo.z), cos_i = fabs((double)wi.z);
    double cos_h = fabs((double)wi.x * h[0] + (double)wi.y * h[1] + (double)wi.z * h[2]);
    double diffuse = 28.0 / (23.0 * MATH_PI) * k->kd * (1.0 - k->ks) *
                     (1.0 - pow(1.0 - 0.5 * cos_i, 5.0)) *
                     (1.0 - pow(1.0 - 0.5 * cos_o, 5.0));
    double schlick = k->ks + pow(1.0 - cos_h, 5.0) * (1.0 - k->ks);
    double d = coat_d(k, h);
    *f = diffuse + d / (4.0 * cos_h * fmax(cos_i, cos_o)) * schlick;
    double visible = d * coat_g1(k, wo) * cos_h / cos_o;
    *pdf = 0.5 * (cos_i / MATH_PI + visible / (4.0 * cos_h));
}

static void test_substrate_by_transcription(void **state)
{
    (void)state;
    const struct coat coats[] = {
        {0.5, 0.5, 0.1, 0.1}, {0.8, 0.05, 0.02, 0.3}, {0.0, 1.0, 1.0, 1.0}};
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int i = 0; i < 30000; i++) {
        const struct coat *k = &coats[i % 3];
        struct bsdf bsdf = bsdf_make("substrate", "kd", k->kd, "ks", k->ks, "alpha_u",
                                     k->alpha_u, "alpha_v", k->alpha_v, NULL);
        double side = rng_double(&rng) < 0.5 ? -1.0 : 1.0, f, pdf;
        struct vec3 wo = bsdf_direction(side * (0.01 + 0.98 * rng_double(&rng)),
                                        6.3 * rng_double(&rng));
        struct vec3 wi = bsdf_direction(side * (0.01 + 0.98 * rng_double(&rng)),
                                        6.3 * rng_double(&rng));
        struct bsdf_value v;
        assert_true(bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &v));
        coat_by_hand(k, wo, wi, &f, &pdf);
        /* The transcription takes float lengths as they are. */
        assert_true(near(v.f.r, f, 1e-4 * f) && near(v.pdf, pdf, 1e-4 * pdf));
        wi.z = -wi.z;
        assert_false(bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &v));
    }
}

/* pbrt v3 never lets a coat be smoother than alpha = 0.001. */
static void test_substrate_clamps_alpha(void **state)
{
    (void)state;
    struct bsdf a = bsdf_make("substrate", "alpha", 0.0, NULL);
    struct bsdf b = bsdf_make("substrate", "alpha", 1e-3, NULL);
    struct vec3 wo = bsdf_direction(0.5, 0.0), wi = bsdf_direction(0.5005, MATH_PI);
    const struct coat least = {0.5, 0.5, 1e-3, 1e-3};
    struct bsdf_value va, vb;
    double f, pdf;
    assert_true(bsdf_eval(&a, wo, wi, TRANSPORT_RADIANCE, &va));
    assert_true(bsdf_eval(&b, wo, wi, TRANSPORT_RADIANCE, &vb));
    assert_true(va.pdf == vb.pdf && va.f.r == vb.f.r);
    coat_by_hand(&least, wo, wi, &f, &pdf);
    assert_true(near(va.f.r, f, 1e-3 * f) && near(va.pdf, pdf, 1e-3 * pdf));
}

/* Mitsuba 3's principled as its documentation and [Burley15] print it, with |cos i|
 * divided out: reflection from the front, and refraction from either side. */
struct disney {
    double base, rough, metallic, glass, tint, sheen, flat, coat, gloss, eta;
};

static double weight5(double c)
{
    return pow(1.0 - c, 5.0);
}

static double fresnel_by_hand(double c, double eta)
{
    double g2 = eta * eta - 1.0 + c * c;
    if (g2 <= 0.0)
        return 1.0;
    double g = sqrt(g2), a = (g - c) / (g + c);
    double b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

static double g1_by_hand(double c, double alpha)
{
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * (1.0 / (c * c) - 1.0)));
}

static double ggx_by_hand(double c, double alpha)
{
    double q = c * c * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (MATH_PI * q * q);
}

static double reflect_by_hand(const struct disney *k, struct vec3 wo, struct vec3 wi)
{
    double h[3] = {(double)wo.x + (double)wi.x, (double)wo.y + (double)wi.y,
                   (double)wo.z + (double)wi.z};
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), alpha;
    double co = (double)wo.z, ci = (double)wi.z, ch = h[2] / length, cd = 0.5 * length;
    alpha = k->rough * k->rough;
    double plain = (1.0 - k->metallic) * (1.0 - k->tint), r0 = (k->eta - 1.0);
    r0 = r0 * r0 / ((k->eta + 1.0) * (k->eta + 1.0));
    double metal = k->base + (1.0 - k->base) * weight5(cd);
    double tinted = r0 + (1.0 - r0) * weight5(cd);
    double f = plain * fresnel_by_hand(cd, k->eta) + k->metallic * metal +
               (1.0 - k->metallic) * k->tint * tinted;
    f *= ggx_by_hand(ch, alpha) * g1_by_hand(co, alpha) * g1_by_hand(ci, alpha) /
         (4.0 * co * ci);
    double a = 0.1 + k->gloss * (0.001 - 0.1), a2 = a * a;
    double d1 = (a2 - 1.0) / (MATH_PI * log(a2) * (1.0 + (a2 - 1.0) * ch * ch));
    f += 0.25 * k->coat * (0.04 + 0.96 * weight5(cd)) * d1 * g1_by_hand(co, 0.25) *
         g1_by_hand(ci, 0.25);
    double fo = weight5(co), fi = weight5(ci), rr = 2.0 * k->rough * cd * cd;
    double diffuse = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) +
                     rr * (fo + fi + fo * fi * (rr - 1.0));
    double ss = (1.0 + fo * (0.5 * rr - 1.0)) * (1.0 + fi * (0.5 * rr - 1.0));
    ss = 1.25 * (ss * (1.0 / (co + ci) - 0.5) + 0.5);
    double under = (1.0 - k->metallic) * (1.0 - k->glass);
    if (under > 0.0)
        f += under * k->base / MATH_PI * ((1.0 - k->flat) * diffuse + k->flat * ss) +
             k->sheen * (1.0 - k->metallic) * weight5(cd);
    return f;
}

static struct bsdf make_disney(const struct disney *k)
{
    return bsdf_make("principled", "base_color", k->base, "roughness", k->rough,
                     "metallic", k->metallic, "spec_trans", k->glass, "spec_tint",
                     k->tint, "sheen", k->sheen, "flatness", k->flat, "clearcoat",
                     k->coat, "clearcoat_gloss", k->gloss, "eta", k->eta, NULL);
}

static void test_principled_by_transcription(void **state)
{
    (void)state;
    const struct disney all[] = {{0.7, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5},
                                 {0.6, 0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5},
                                 {0.4, 0.8, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.2, 1.3},
                                 {0.9, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 2.0},
                                 {0.5, 0.4, 0.2, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.4}};
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 0);
    for (int i = 0; i < 20000; i++) {
        const struct disney *k = &all[i % 5];
        struct bsdf bsdf = make_disney(k);
        struct vec3 wo = bsdf_direction(0.01 + 0.98 * rng_double(&rng),
                                        6.3 * rng_double(&rng));
        struct vec3 wi = bsdf_direction(0.01 + 0.98 * rng_double(&rng),
                                        6.3 * rng_double(&rng));
        struct bsdf_value v;
        assert_true(bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &v));
        double f = reflect_by_hand(k, wo, wi);
        /* The transcription takes float lengths as they are. */
        assert_true(near(v.f.g, f, 2e-4 * f));
        /* Behind: black if the front refracts, else the same. */
        wo.z = -wo.z;
        wi.z = -wi.z;
        bool any = bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &v);
        if (k->glass == 0.0)
            assert_true(any && near(v.f.g, f, 2e-4 * f));
        else
            assert_true(any && v.f.g < f);
    }
}

/* Without metal and of white colour its refraction is that of rough glass, but for the
 * masking of the two directions, which is separable here: at small roughness the same. */
static void test_principled_refracts_as_glass(void **state)
{
    (void)state;
    const struct disney k = {1.0, 0.1, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.4};
    struct bsdf principled = make_disney(&k);
    struct bsdf glass = bsdf_make("roughdielectric", "alpha", 0.01, "eta", 1.4, NULL);
    struct rng rng;
    rng_init(&rng, 6, RNG_TEST, 0);
    int tried = 0;
    for (int i = 0; i < 4000; i++) {
        double side = i % 2 ? 1.0 : -1.0;
        struct vec3 wo = bsdf_direction(side * (0.3 + 0.69 * rng_double(&rng)), 1.0);
        const double u[3] = {rng_double(&rng), rng_double(&rng), rng_double(&rng)};
        struct bsdf_sample s;
        struct bsdf_value a, b;
        enum transport mode = i % 4 < 2 ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE;
        if (!bsdf_sample(&glass, wo, u, mode, &s) || fabsf(s.wi.z) < 0.3f)
            continue;
        assert_true(bsdf_eval(&glass, wo, s.wi, mode, &a));
        assert_true(bsdf_eval(&principled, wo, s.wi, mode, &b));
        assert_true(near(b.f.g, a.f.g, 2e-3 * a.f.g));
        assert_true(near(b.pdf, a.pdf, 1e-9 * a.pdf));
        assert_true(near(b.pdf_rev, a.pdf_rev, 1e-9 * a.pdf_rev));
        tried++;
    }
    assert_true(tried > 2000);
}

/* What a rough coat lets in is what rough glass transmits, here by quadrature; a base
 * without its coat's glint tells it. Before, strata of the lobe number rounded it by up
 * to 4 %. And a white base gives back all that the coat lets in. */
static void test_coat_lets_in_what_glass_transmits(void **state)
{
    (void)state;
    const double cosines[] = {1.0, 0.8, 0.5, 0.2}, alphas[] = {0.05, 0.1, 0.3};
    struct vec3 wi = bsdf_direction(0.9, 1.0);
    for (int a = 0; a < 3; a++) {
        struct bsdf coat = bsdf_make("roughplastic", "alpha", alphas[a], "specular", 0.0,
                                     "reflectance", 1.0, "nonlinear", 1.0, NULL);
        struct bsdf glass = bsdf_make("roughdielectric", "alpha", alphas[a],
                                      "reflectance", 0.0, NULL);
        double first = 0.0;
        for (int c = 0; c < 4; c++) {
            struct vec3 wo = bsdf_direction(cosines[c], 0.0);
            struct bsdf_value v;
            assert_true(bsdf_eval(&coat, wo, wi, TRANSPORT_IMPORTANCE, &v));
            double transmits = albedo_quadrature(&glass, wo, TRANSPORT_IMPORTANCE).g;
            double base = albedo_quadrature(&coat, wo, TRANSPORT_IMPORTANCE).g;
            first = c == 0 ? v.f.g / transmits : first;
            if (!near(v.f.g / transmits, first, 6e-3 * first) ||
                !near(base, transmits, 6e-3 * transmits))
                fail_msg("alpha %g cos %g: %g of %g, base %g of %g", alphas[a],
                         cosines[c], v.f.g / transmits, first, base, transmits);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_glass),
        cmocka_unit_test(test_smooth_kinds_are_limits_of_rough_ones),
        cmocka_unit_test(test_substrate_by_transcription),
        cmocka_unit_test(test_coat_lets_in_what_glass_transmits),
        cmocka_unit_test(test_principled_by_transcription),
        cmocka_unit_test(test_principled_refracts_as_glass),
        cmocka_unit_test(test_substrate_clamps_alpha),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
