/* The table of kinds, and the laws that every kind must obey. */

#include "math/rng.h"
#include "support/albedo.h"
#include "support/bsdf_make.h"
#include "surface/fresnel.h"

#include <setjmp.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include <float.h>

#define MAX_MATERIALS 128
#define SAME          1e-9 /* relative: two ways to compute one number in double */

/* Kinds of several lobes, deltas beside others; children are made once. */
static int coated_and_blended(struct bsdf *out)
{
    static struct bsdf diffuse, mirror, glass, rough, through, plastic;
    int n = 0;
    diffuse = bsdf_make("diffuse", "reflectance", 0.8, NULL);
    mirror = bsdf_make("mirror", NULL);
    glass = bsdf_make("dielectric", NULL);
    rough = bsdf_make("roughconductor", "alpha", 0.3, NULL);
    through = bsdf_make("null", NULL);
    plastic = bsdf_make("plastic", "reflectance", 0.4, NULL);
    out[n++] = bsdf_make("plastic", "reflectance", 1.0, "nonlinear", 1.0, NULL);
    out[n++] = bsdf_make("plastic", "reflectance", 0.0, NULL);
    out[n++] = bsdf_make("plastic", "specular", 0.0, "eta", 1.9, NULL);
    out[n++] = bsdf_make("roughplastic", "alpha", 0.05, "reflectance", 0.9, "nonlinear",
                         1.0, NULL);
    out[n++] = bsdf_make("roughplastic", "alpha", 0.4, "distribution", 1.0, NULL);
    out[n++] = bsdf_make("phong", "exponent", 2000.0, "kd", 0.0, "ks", 1.0, NULL);
    out[n++] = bsdf_make("phong", "exponent", 3.0, "kd", 0.3, "ks", 0.7, NULL);
    out[n++] = bsdf_make("uber", "kd", 0.3, "ks", 0.2, "kr", 0.1, "kt", 0.4, "opacity",
                         0.6, NULL);
    out[n++] = bsdf_make("uber", "kd", 0.5, "ks", 0.5, "eta", 1.0 / 1.5, NULL);
    out[n++] = bsdf_make("uber", "kd", 0.9, "ks", 0.5, "eta", 1.0, NULL);
    out[n++] = bsdf_make_pair("blend", &diffuse, &through, 0.3);
    out[n++] = bsdf_make_pair("blend", &rough, &mirror, 0.5);
    out[n++] = bsdf_make_pair("blend", &mirror, &glass, 0.5);
    out[n++] = bsdf_make_pair("blend", &plastic, &rough, 0.7);
    out[n++] = bsdf_make_pair("blend", &plastic, NULL, 0.2);
    out[n++] = bsdf_make_pair("sides", &diffuse, NULL, 0.0);
    out[n++] = bsdf_make_pair("sides", &plastic, &rough, 0.0);
    return n;
}

/* Every kind with several parameters. Returns their count. */
static int materials(struct bsdf out[MAX_MATERIALS])
{
    static const double alphas[] = {1e-3, 0.05, 0.3, 1.0};
    int n = 0;
    for (int k = 0; bsdf_types[k]; k++)
        out[n++] = bsdf_make(bsdf_types[k]->name, NULL);
    for (int a = 0; a < 4; a++)
        for (double d = 0.0; d < 2.0; d += 1.0) {
            double alpha = alphas[a];
            out[n++] = bsdf_make("roughconductor", "alpha", alpha, "distribution", d,
                                 NULL);
            out[n++] = bsdf_make("roughdielectric", "alpha", alpha, "distribution", d,
                                 "alpha_v", 0.2, "eta", 1.33, NULL);
            out[n++] = bsdf_make("roughdielectric", "alpha", alpha, "distribution", d,
                                 "eta", 0.6, NULL);
        }
    for (int k = 0; k < 6; k++)
        out[n++] = bsdf_make("orennayar", "sigma", k / 2 * 0.78, "full", k % 2 * 1.0,
                             "reflectance", 0.95, NULL);
    for (int k = 0; k < 4; k++) {
        double rough = k * 0.33, glass = k == 3;
        out[n++] = bsdf_make("principled", "roughness", rough, "metallic", 0.3, "sheen",
                             0.3, "clearcoat", 0.5, "clearcoat_gloss", 0.3 * k,
                             "spec_trans", 0.5 * glass, NULL);
        out[n++] = bsdf_make("principled", "roughness", rough, "anisotropic", 0.7,
                             "spec_trans", 1.0, "base_color", 1.0, "eta", 1.3, NULL);
        out[n++] = bsdf_make("principled", "roughness", rough, "metallic", 1.0,
                             "base_color", 1.0, NULL);
        out[n++] = bsdf_make("principled", "roughness", rough, "flatness", rough,
                             "spec_tint", rough, "base_color", 0.7, NULL);
    }
    out[n++] = bsdf_make("translucent", "reflectance", 0.7, "transmittance", 0.3, NULL);
    out[n++] = bsdf_make("translucent", "reflectance", 0.0, NULL);
    out[n++] = bsdf_make("translucent", "transmittance", 0.0, NULL);
    out[n++] = bsdf_make("substrate", "alpha_u", 0.02, "alpha_v", 0.3, NULL);
    out[n++] = bsdf_make("substrate", "alpha", 1.0, "kd", 1.0, "ks", 0.0, NULL);
    out[n++] = bsdf_make("substrate", "alpha", 0.1, "kd", 1.0, "ks", 0.3, NULL);
    return n + coated_and_blended(out + n);
}

static bool same(double a, double b)
{
    /* Below DBL_MIN a double has fewer digits than SAME asks for. */
    return fabs(a - b) <= fmax(SAME * fmax(fabs(a), fabs(b)), DBL_MIN);
}

static struct vec3 random_direction(struct rng *rng)
{
    return bsdf_direction(2.0 * rng_double(rng) - 1.0, 2.0 * MATH_PI * rng_double(rng));
}

/* A pair of directions that scatter into each other, when there are such. */
static bool random_pair(const struct bsdf *bsdf, struct rng *rng, struct vec3 *wo,
                        struct vec3 *wi)
{
    const double u[3] = {rng_double(rng), rng_double(rng), rng_double(rng)};
    struct bsdf_sample s;
    *wo = random_direction(rng);
    *wi = random_direction(rng);
    if (rng_double(rng) < 0.5)
        return true;
    if (!bsdf_sample(bsdf, *wo, u, TRANSPORT_RADIANCE, &s))
        return false;
    *wi = s.wi;
    return true;
}

/* f(o,i) = f(i,o) on one side; through an interface, what radiance sees one way is what
 * importance sees the other way, and the two differ by eta^2. pdf_rev is the pdf with
 * the directions swapped. */
static void check_reciprocity(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi)
{
    struct bsdf_value a, b, c;
    bool any = bsdf_eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &a);
    assert_int_equal(any, bsdf_eval(bsdf, wi, wo, TRANSPORT_IMPORTANCE, &b));
    assert_int_equal(any, bsdf_eval(bsdf, wo, wi, TRANSPORT_IMPORTANCE, &c));
    assert_true(any || (rgb_is_black(a.f) && a.pdf == 0.0 && a.pdf_rev == 0.0));
    assert_true(same(a.f.r, b.f.r) && same(a.f.g, b.f.g) && same(a.f.b, b.f.b));
    assert_true(same(a.pdf, b.pdf_rev) && same(a.pdf_rev, b.pdf));
    assert_true(same(a.pdf, c.pdf) && same(a.pdf_rev, c.pdf_rev));
    double ratio = 1.0; /* index of wi's side over that of wo's */
    if ((wo.z > 0.0f) != (wi.z > 0.0f)) {
        ratio = albedo_param(bsdf, "eta", 1.0);
        ratio = wo.z > 0.0f ? ratio : 1.0 / ratio;
    }
    assert_true(same(a.f.g * ratio * ratio, c.f.g));
}

static void test_reciprocity(void **state)
{
    (void)state;
    struct bsdf all[MAX_MATERIALS];
    int n = materials(all);
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 5000; k++) {
            struct vec3 wo, wi;
            if (!random_pair(&all[i], &rng, &wo, &wi))
                continue;
            if (all[i].flags & BSDF_DELTA)
                wi = random_direction(&rng);
            check_reciprocity(&all[i], wo, wi);
        }
}

static const double cosines[] = {1.0, 0.5, 0.03, -0.85, -0.05};
#define COSINES ((int)(sizeof cosines / sizeof cosines[0]))

/* Of 1: principled's base does not know what the lobes over it reflect (its file's head);
 * 1.23 is seen at grazing angles here. Without that base it keeps the law. */
static double most_albedo(const struct bsdf *bsdf)
{
    bool base = strcmp(bsdf->type->name, "principled") == 0 &&
                albedo_param(bsdf, "metallic", 0.0) < 1.0 &&
                albedo_param(bsdf, "spec_trans", 0.0) < 1.0;
    return base ? 1.25 : 1.0;
}

/* Importance carries no eta^2: nothing may come back brighter. */
static void test_energy(void **state)
{
    (void)state;
    struct bsdf all[MAX_MATERIALS];
    int n = materials(all);
    for (int i = 0; i < n; i++)
        for (int c = 0; c < COSINES; c++) {
            double error;
            struct vec3 wo = bsdf_direction(cosines[c], 0.4);
            struct rgb albedo = albedo_quadrature_error(&all[i], wo, TRANSPORT_IMPORTANCE,
                                                        &error);
            if (rgb_max(albedo) > most_albedo(&all[i]) + error + 1e-6)
                fail_msg("%s %d cos %g: %g +- %g", all[i].type->name, i, cosines[c],
                         rgb_max(albedo), error);
            assert_true(error < 5e-3);
        }
}

/* Radiance gains or loses eta^2 on the way through, and nothing else: R + T eta^2 = 1. */
static void test_white_furnace(void **state)
{
    (void)state;
    struct bsdf diffuse = bsdf_make("diffuse", "reflectance", 1.0, NULL);
    struct bsdf through = bsdf_make("null", NULL);
    const struct bsdf white[] = {
        through,
        bsdf_make("thindielectric", NULL),
        bsdf_make("uber", "kd", 0.0, "ks", 0.0, "kr", 1.0, "kt", 1.0, NULL),
        bsdf_make_pair("blend", &diffuse, &through, 0.3),
        bsdf_make("uber", "kd", 1.0, "ks", 0.0, "opacity", 0.3, NULL),
        bsdf_make("diffuse", "reflectance", 1.0, NULL),
        bsdf_make("mirror", "reflectance", 1.0, NULL),
        bsdf_make("dielectric", NULL),
        bsdf_make("dielectric", "eta", 0.7, NULL),
        bsdf_make("dielectric", "eta", 1.0, NULL),
        bsdf_make("orennayar", "reflectance", 1.0, "sigma", 0.0, NULL),
        bsdf_make("translucent", "reflectance", 0.3, "transmittance", 0.7, NULL)};
    for (int i = 0; i < (int)(sizeof white / sizeof white[0]); i++)
        for (int c = 0; c < COSINES; c++) {
            double error;
            struct rgb albedo = albedo_quadrature_error(
                &white[i], bsdf_direction(cosines[c], 1.0), TRANSPORT_IMPORTANCE, &error);
            assert_true(fabs(albedo.r - 1.0) <= error + 1e-6);
            assert_true(fabs(albedo.g - 1.0) <= error + 1e-6);
            assert_true(fabs(albedo.b - 1.0) <= error + 1e-6);
        }
}

/* A white base under a coat that absorbs nothing gives all light back: what its mean over
 * the hemisphere lacks is what the coat's directional laws and the mean F_in leave of
 * each other, nothing for a smooth coat. */
static void test_plastic_keeps_all_light(void **state)
{
    (void)state;
    const struct bsdf smooth = bsdf_make("plastic", "reflectance", 1.0, "nonlinear", 1.0,
                                         NULL);
    double sum = 0.0;
    const int n = 64;
    for (int i = 0; i < n; i++) {
        double x = (i + 0.5) / n; /* cos = x^2 */
        struct rgb albedo = albedo_quadrature(&smooth, bsdf_direction(x * x, 0.0),
                                              TRANSPORT_RADIANCE);
        sum += albedo.g * 4.0 * x * x * x / n;
    }
    assert_true(fabs(sum - 1.0) < 1e-3);
}

/* The only delta lobe that leads from `from` to `to`, sought over the whole lobe number;
 * false if there is none or more than one. */
static bool find_delta(const struct bsdf *bsdf, struct vec3 from, struct vec3 to,
                       struct bsdf_sample *found)
{
    int count = 0;
    for (int k = 0; k <= 256; k++) {
        const double u[3] = {fmin(k / 256.0, 1.0 - 0x1p-53), 0.5, 0.5};
        struct bsdf_sample s;
        if (!bsdf_sample(bsdf, from, u, TRANSPORT_RADIANCE, &s) || !s.delta ||
            vec3_dot(vec3_sub(s.wi, to), vec3_sub(s.wi, to)) > 1e-8f)
            continue;
        if (count == 0 || s.pdf != found->pdf)
            count++;
        *found = s;
    }
    return count == 1;
}

/* pdf_rev of a delta lobe is the chance of the way back, times the Jacobian of the
 * direction where it is bent; there radiance is squeezed by eta^2, and importance not. */
static void test_delta_lobes_run_back(void **state)
{
    (void)state;
    struct bsdf all[MAX_MATERIALS];
    int n = materials(all), tried = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 64 * COSINES; k++) {
            /* Along the normal nothing is bent, though squeezed it is: not here. */
            struct vec3 wo = bsdf_direction(fmin(cosines[k % COSINES], 0.95), 0.4);
            const double u[3] = {(k / COSINES + 0.5) / 64.0, 0.5, 0.5};
            struct bsdf_sample s, back;
            if (!bsdf_sample(&all[i], wo, u, TRANSPORT_RADIANCE, &s) || !s.delta)
                continue;
            if (!find_delta(&all[i], s.wi, wo, &back))
                continue; /* a lobe too small for the steps of find_delta */
            double bent = 1.0, eta = 1.0;
            if (s.transmission && fabsf(s.wi.z + wo.z) > 1e-6f) {
                eta = albedo_param(&all[i], "eta", 1.5);
                eta = wo.z > 0.0f ? eta : 1.0 / eta;
                bent = fabs((double)wo.z) / (fabs((double)s.wi.z) * eta * eta);
            }
            struct bsdf_sample importance;
            assert_true(bsdf_sample(&all[i], wo, u, TRANSPORT_IMPORTANCE, &importance));
            double squeezed = importance.weight.g / (eta * eta);
            assert_true(fabs(s.weight.g - squeezed) <= 1e-12 * squeezed);
            if (!(fabs(s.pdf_rev / (back.pdf * bent) - 1.0) < 1e-4))
                fail_msg("%s %d cos %g: %g, the way back %g", all[i].type->name, i,
                         (double)wo.z, s.pdf_rev, back.pdf * bent);
            tried++;
        }
    assert_true(tried > 1000);
}

/* What two faces send to and fro, summed term by term. */
static void test_thin_glass_sums_its_reflections(void **state)
{
    (void)state;
    struct bsdf pane = bsdf_make("thindielectric", "eta", 1.7, NULL);
    for (int c = 0; c < COSINES; c++) {
        double cos_t, cosine = fabs(cosines[c]);
        double r = fresnel_dielectric(cosine, 1.7, &cos_t), sum = r;
        for (double way = (1.0 - r) * (1.0 - r) * r; way > 1e-12; way *= r * r)
            sum += way;
        const double u[3] = {0x1.fffffffffffffp-1, 0.5, 0.5};
        struct bsdf_sample s;
        assert_true(bsdf_sample(&pane, bsdf_direction(cosines[c], 0.4), u,
                                TRANSPORT_RADIANCE, &s));
        assert_true(!s.transmission && fabs(s.pdf - sum) < 1e-6);
    }
}

/* bsdf_straight says what bsdf_sample does with each lobe number, and the same from both
 * sides. */
static void check_straight(const struct bsdf *bsdf, struct vec3 wo, double lobe)
{
    const double u[3] = {lobe, 0.3, 0.6};
    struct bsdf_straight s = {.chance = 0.0}, back = {.chance = 0.0};
    struct bsdf_sample sample;
    bool passes = bsdf_straight(bsdf, wo, &s);
    assert_true(bsdf_straight(bsdf, vec3_neg(wo), &back) == passes);
    assert_true(s.chance == back.chance && s.transmittance.g == back.transmittance.g);
    bool sampled = bsdf_sample(bsdf, wo, u, TRANSPORT_RADIANCE, &sample);
    bool straight = sampled && sample.delta && sample.wi.x == -wo.x &&
                    sample.wi.y == -wo.y && sample.wi.z == -wo.z;
    assert_true(straight == (passes && lobe < s.chance));
    if (straight)
        assert_true(sample.pdf == s.chance && sample.pdf_rev == s.chance &&
                    same(sample.weight.g * s.chance, s.transmittance.g));
}

/* Half of a diffuse card over a filter whose light the weight's colour takes away: the
 * filter has a straight lobe, and the blend has none. The children must live as long. */
static struct bsdf disjoint_blend(const struct bsdf *filter, const struct bsdf *card)
{
    const double weight[3] = {1.0, 0.5, 0.5};
    struct bsdf blend = bsdf_make_pair("blend", filter, card, 0.5);
    if (!bsdf_set(&blend, "weight", weight, 3, NULL, NULL) ||
        !bsdf_prepare(&blend, NULL, NULL))
        abort();
    return blend;
}

static struct bsdf red_filter(void)
{
    const double red[3] = {1.0, 0.0, 0.0};
    struct bsdf filter = bsdf_make("null", NULL);
    if (!bsdf_set(&filter, "transmittance", red, 3, NULL, NULL) ||
        !bsdf_prepare(&filter, NULL, NULL))
        abort();
    return filter;
}

/* All materials, and blends of those that pass, one in another. */
static int straight_materials(struct bsdf *out)
{
    static struct bsdf pane, through, diffuse, card, mirror, red;
    pane = bsdf_make("thindielectric", "eta", 1.7, NULL);
    through = bsdf_make("null", "transmittance", 0.7, NULL);
    diffuse = bsdf_make("diffuse", NULL);
    mirror = bsdf_make("mirror", NULL);
    card = bsdf_make_pair("blend", &through, &diffuse, 0.4);
    int n = materials(out);
    out[n++] = card;
    out[n++] = bsdf_make_pair("blend", &card, &pane, 0.3);
    out[n++] = bsdf_make_pair("blend", &pane, &mirror, 0.8);
    out[n++] = bsdf_make_pair("blend", &through, &pane, 0.1);
    out[n++] = bsdf_make_pair("blend", &through, NULL, 0.1);
    red = red_filter();
    out[n++] = disjoint_blend(&red, &diffuse);
    return n;
}

static void test_straight_lobe(void **state)
{
    (void)state;
    static struct bsdf all[MAX_MATERIALS + 8];
    int n = straight_materials(all), passing = 0, tried = 0;
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    for (int i = 0; i < n; i++) {
        struct bsdf_straight s;
        passing += (all[i].flags & BSDF_STRAIGHT) != 0;
        for (int k = 0; k < 200; k++) {
            struct vec3 wo = random_direction(&rng);
            double at = bsdf_straight(&all[i], wo, &s) ? s.chance : 0.5;
            check_straight(&all[i], wo, rng_double(&rng));
            check_straight(&all[i], wo, nextafter(at, 0.0));
            if (at < 1.0)
                check_straight(&all[i], wo, at);
            tried++;
        }
        assert_true(!(all[i].flags & BSDF_ONLY_STRAIGHT) || all[i].flags & BSDF_STRAIGHT);
    }
    assert_true(passing >= 8 && tried > 1000);
}

/* What absorbs nothing, in blends: the lobes' weights by their shares of the number sum
 * to 1, up to one step of the number a lobe. */
static void test_blend_keeps_all_light(void **state)
{
    (void)state;
    enum { NUMBERS = 20000 };
    struct bsdf pane = bsdf_make("thindielectric", "eta", 1.7, NULL);
    struct bsdf mirror = bsdf_make("mirror", "reflectance", 1.0, NULL);
    struct bsdf through = bsdf_make("null", NULL);
    struct bsdf first = bsdf_make_pair("blend", &pane, &mirror, 0.4);
    const struct bsdf all[] = {first, bsdf_make_pair("blend", &mirror, &pane, 0.3),
                               bsdf_make_pair("blend", &first, &pane, 0.7),
                               bsdf_make_pair("blend", &first, &through, 0.2)};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        for (int c = 0; c < COSINES; c++) {
            double sum = 0.0;
            for (int k = 0; k < NUMBERS; k++) {
                const double u[3] = {(k + 0.5) / NUMBERS, 0.5, 0.5};
                struct bsdf_sample s;
                if (bsdf_sample(&all[i], bsdf_direction(cosines[c], 0.4), u,
                                TRANSPORT_RADIANCE, &s))
                    sum += s.weight.g / NUMBERS;
            }
            assert_true(fabs(sum - 1.0) < 1e-3);
        }
}

/* Samples of the blend without a straight lobe gather what its eval says: the filter's
 * share of the lobe number is spent on nothing, up to one step of the number. */
static void test_blend_of_disjoint_colours(void **state)
{
    (void)state;
    enum { NUMBERS = 20000 };
    const struct bsdf red = red_filter(), card = bsdf_make("diffuse", NULL);
    const struct bsdf blend = disjoint_blend(&red, &card);
    struct vec3 wo = bsdf_direction(0.7, 0.4);
    struct rgb sum = rgb_grey(0.0),
               albedo = albedo_quadrature(&blend, wo, TRANSPORT_RADIANCE);
    for (int k = 0; k < NUMBERS; k++) {
        const double u[3] = {(k + 0.5) / NUMBERS, 0.5, 0.5};
        struct bsdf_sample s;
        if (bsdf_sample(&blend, wo, u, TRANSPORT_RADIANCE, &s))
            sum = rgb_add(sum, rgb_scale(s.weight, 1.0 / NUMBERS));
    }
    assert_true(fabs(albedo.r - 0.5) < 1e-3 && fabs(albedo.g - 0.25) < 1e-3);
    assert_true(fabs(sum.r - albedo.r) < 1e-3 && fabs(sum.g - albedo.g) < 1e-3);
}

/* Diffuse is its own oracle: f = reflectance/pi on one side, from both sides. */
static void test_diffuse_values(void **state)
{
    (void)state;
    struct bsdf bsdf = bsdf_make("diffuse", "reflectance", 0.3, NULL);
    struct bsdf_value v;
    for (double side = -1.0; side <= 1.0; side += 2.0) {
        struct vec3 wo = bsdf_direction(0.5 * side, 0.0);
        assert_true(bsdf_eval(&bsdf, wo, bsdf_direction(0.25 * side, 2.0),
                              TRANSPORT_RADIANCE, &v));
        assert_true(same(v.f.g, 0.3 / MATH_PI) && same(v.pdf, 0.25 / MATH_PI));
        assert_true(same(v.pdf_rev, 0.5 / MATH_PI));
        assert_false(bsdf_eval(&bsdf, wo, bsdf_direction(-0.25 * side, 2.0),
                               TRANSPORT_RADIANCE, &v));
    }
}

/* Oren and Nayar's models with angles and trigonometry, as Mitsuba's documentation and
 * pbrt's print them. */
static double grooves_by_hand(double sigma, bool full, double rho, struct vec3 wo,
                              struct vec3 wi)
{
    double o = acos(fabs((double)wo.z)), i = acos(fabs((double)wi.z));
    double phi = atan2((double)wo.y, (double)wo.x) - atan2((double)wi.y, (double)wi.x);
    double a = fmax(o, i), b = fmin(o, i), s2 = sigma * sigma, c = cos(phi);
    double c1 = 1.0 - 0.5 * s2 / (s2 + 0.33), c2 = 0.45 * s2 / (s2 + 0.09);
    if (!full)
        return rho / MATH_PI * (c1 + c2 * fmax(0.0, c) * sin(a) * tan(b));
    c2 *= sin(a) - (c < 0.0 ? pow(2.0 * b / MATH_PI, 3.0) : 0.0);
    double c3 = 0.125 * s2 / (s2 + 0.09) * pow(4.0 * a * b / (MATH_PI * MATH_PI), 2.0);
    double single = c1 + c * c2 * tan(b) + (1.0 - fabs(c)) * c3 * tan(0.5 * (a + b));
    double twice = 0.17 * s2 / (s2 + 0.13) * (1.0 - c * pow(2.0 * b / MATH_PI, 2.0));
    return (rho * fmax(0.0, single) + rho * rho * twice) / MATH_PI;
}

static void test_grooves_by_transcription(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    for (int k = 0; k < 4000; k++) {
        double sigma = 1.57 * rng_double(&rng), rho = rng_double(&rng);
        bool full = k % 2;
        struct bsdf bsdf = bsdf_make("orennayar", "sigma", sigma, "full", (double)full,
                                     "reflectance", rho, NULL);
        double side = k % 4 < 2 ? 1.0 : -1.0;
        struct vec3 wo = bsdf_direction(side * (0.001 + 0.998 * rng_double(&rng)),
                                        6.3 * rng_double(&rng));
        struct vec3 wi = bsdf_direction(side * (0.001 + 0.998 * rng_double(&rng)),
                                        6.3 * rng_double(&rng));
        struct bsdf_value v;
        double f = grooves_by_hand(sigma, full, rho, wo, wi);
        assert_true(bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &v) == (f > 0.0));
        /* The transcription takes float lengths as they are. */
        assert_true(fabs(v.f.g - f) <= 2e-5 * (1.0 + f));
    }
}

/* Light falls through to the other side: transmittance / pi there. */
static void test_translucent_values(void **state)
{
    (void)state;
    struct bsdf bsdf = bsdf_make("translucent", "reflectance", 0.3, "transmittance", 0.1,
                                 NULL);
    struct bsdf_value v;
    for (double side = -1.0; side <= 1.0; side += 2.0) {
        struct vec3 wo = bsdf_direction(0.5 * side, 0.0);
        assert_true(bsdf_eval(&bsdf, wo, bsdf_direction(0.25 * side, 2.0),
                              TRANSPORT_RADIANCE, &v));
        assert_true(same(v.f.g, 0.3 / MATH_PI) && same(v.pdf, 0.75 * 0.25 / MATH_PI));
        assert_true(bsdf_eval(&bsdf, wo, bsdf_direction(-0.25 * side, 2.0),
                              TRANSPORT_RADIANCE, &v));
        assert_true(same(v.f.g, 0.1 / MATH_PI) && same(v.pdf, 0.25 * 0.25 / MATH_PI));
        assert_true(same(v.pdf_rev, 0.25 * 0.5 / MATH_PI));
    }
}

/* Zero reflectance scatters nothing and says so. */
static void test_black_returns_false(void **state)
{
    (void)state;
    const struct bsdf black[] = {
        bsdf_make("black", NULL),
        bsdf_make("diffuse", "reflectance", 0.0, NULL),
        bsdf_make("mirror", "reflectance", 0.0, NULL),
        bsdf_make("conductor", "reflectance", 0.0, NULL),
        bsdf_make("roughconductor", "reflectance", 0.0, NULL),
        bsdf_make("dielectric", "reflectance", 0.0, "transmittance", 0.0, NULL),
        bsdf_make("roughdielectric", "reflectance", 0.0, "transmittance", 0.0, NULL)};
    const double u[3] = {0.9, 0.4, 0.6};
    struct vec3 wo = bsdf_direction(0.7, 0.0), wi = bsdf_direction(0.7, MATH_PI);
    for (int i = 0; i < 7; i++) {
        struct bsdf_sample s;
        struct bsdf_value v;
        assert_true(black[i].flags & BSDF_BLACK);
        assert_false(bsdf_sample(&black[i], wo, u, TRANSPORT_RADIANCE, &s));
        assert_false(bsdf_eval(&black[i], wo, wi, TRANSPORT_RADIANCE, &v));
        assert_true(rgb_is_black(s.weight) && rgb_is_black(v.f) && v.pdf == 0.0);
    }
}

/* A number that the flags do not announce may be anything; one that they announce is
 * used by some sample. */
static void test_flags_announce_the_numbers(void **state)
{
    (void)state;
    struct bsdf all[MAX_MATERIALS];
    int n = materials(all);
    for (int i = 0; i < n; i++) {
        bool lobe = all[i].flags & BSDF_U_LOBE, along = all[i].flags & BSDF_U_DIRECTION;
        bool uses_lobe = false, uses_direction = false;
        for (int k = 0; k < 50; k++) {
            struct vec3 wo = bsdf_direction(0.2 + 0.015 * k, 0.5);
            const double u[3] = {lobe ? 0.01 : (double)NAN, along ? 0.4 : (double)NAN,
                                 along ? 0.45 : (double)NAN};
            const double v[3] = {lobe ? 0.99 : (double)NAN, u[1], u[2]};
            /* Any lobe, in two directions. */
            const double w[3] = {lobe ? (k + 0.5) / 50.0 : (double)NAN, u[1], u[2]};
            const double x[3] = {w[0], along ? 0.7 : (double)NAN, u[2]};
            struct bsdf_sample a, b, c, d;
            bsdf_sample(&all[i], wo, u, TRANSPORT_RADIANCE, &a);
            bsdf_sample(&all[i], wo, v, TRANSPORT_RADIANCE, &b);
            bsdf_sample(&all[i], wo, w, TRANSPORT_RADIANCE, &c);
            bsdf_sample(&all[i], wo, x, TRANSPORT_RADIANCE, &d);
            assert_true(isfinite(a.pdf) && rgb_is_finite(a.weight));
            assert_true(isfinite(vec3_dot(a.wi, a.wi)));
            uses_lobe |= a.wi.z != b.wi.z;
            uses_direction |= c.wi.z != d.wi.z;
        }
        assert_int_equal(uses_lobe, lobe);
        assert_int_equal(uses_direction, along);
    }
}

static void set_fails(const char *kind, const char *name, const double *values, int count,
                      const char *said)
{
    struct bsdf bsdf;
    struct err err = {0};
    const struct place at = {"a.yaml", 3, 7};
    bsdf_init(&bsdf, bsdf_find(kind));
    assert_false(bsdf_set(&bsdf, name, values, count, &at, &err));
    assert_int_equal(err.line, 3);
    assert_int_equal(err.col, 7);
    if (!strstr(err.message, said))
        fail_msg("\"%s\" does not say \"%s\"", err.message, said);
}

static void test_set_checks(void **state)
{
    (void)state;
    const double half = 0.5, two[3] = {2.0, 0.0, 0.0}, nan = (double)NAN;
    const double below = -0.1, huge = HUGE_VAL;
    set_fails("diffuse", "reflectanse", &half, 1, "did you mean 'reflectance'");
    set_fails("substrate", "zzz", &half, 1, "it takes: kd, ks, alpha, alpha_u, alpha_v");
    set_fails("black", "kd", &half, 1, "it takes: none");
    set_fails("diffuse", "reflectance", two, 3, "reflectance = 2 must be from 0 to 1");
    set_fails("diffuse", "reflectance", &below, 1, "from 0 to 1");
    set_fails("diffuse", "reflectance", &nan, 1, "from 0 to 1");
    set_fails("dielectric", "eta", &huge, 1, "from 0.05 to 20");
    set_fails("diffuse", "reflectance", two, 2, "1 number or 3 (r, g, b), not 2");
    set_fails("dielectric", "eta", two, 3, "1 number, not 3");
}

/* Three numbers are a colour, one is a grey. */
static void test_set_colours(void **state)
{
    (void)state;
    const double colour[3] = {0.1, 0.2, 0.3};
    struct bsdf bsdf;
    struct bsdf_value v;
    struct vec3 up = bsdf_direction(1.0, 0.0);
    bsdf_init(&bsdf, bsdf_find("diffuse"));
    assert_true(bsdf_set(&bsdf, "reflectance", colour, 3, NULL, NULL));
    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
    assert_true(bsdf_eval(&bsdf, up, up, TRANSPORT_RADIANCE, &v));
    assert_true(same(v.f.r * MATH_PI, 0.1) && same(v.f.g * MATH_PI, 0.2));
    assert_true(same(v.f.b * MATH_PI, 0.3));
    assert_true(bsdf_set(&bsdf, "reflectance", colour + 1, 1, NULL, NULL));
    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
    assert_true(bsdf_eval(&bsdf, up, up, TRANSPORT_RADIANCE, &v));
    assert_true(same(v.f.r * MATH_PI, 0.2) && same(v.f.b * MATH_PI, 0.2));
}

static void test_prepare_checks(void **state)
{
    (void)state;
    struct bsdf bsdf;
    struct err err = {0};
    const double half = 0.5, one = 1.0;
    bsdf_init(&bsdf, bsdf_find("roughconductor"));
    assert_true(bsdf_set(&bsdf, "distribution", &half, 1, NULL, NULL));
    assert_false(bsdf_prepare(&bsdf, NULL, &err));
    assert_non_null(strstr(err.message, "0 (GGX) or 1 (Beckmann), not 0.5"));
    err = (struct err){0};
    bsdf_init(&bsdf, bsdf_find("roughdielectric"));
    assert_true(bsdf_set(&bsdf, "eta", &one, 1, NULL, NULL));
    assert_false(bsdf_prepare(&bsdf, NULL, &err));
    assert_non_null(strstr(err.message, "use dielectric"));
}

/* alpha is both axes; alpha_u and alpha_v override it, in any order. */
static void test_alpha_sets_both_axes(void **state)
{
    (void)state;
    struct bsdf a = bsdf_make("roughconductor", "alpha", 0.2, NULL);
    struct bsdf b = bsdf_make("roughconductor", "alpha_u", 0.2, "alpha_v", 0.2, NULL);
    struct bsdf c = bsdf_make("roughconductor", "alpha_v", 0.4, "alpha", 0.2, NULL);
    struct vec3 wo = bsdf_direction(0.6, 0.3), wi = bsdf_direction(0.5, 3.0);
    struct bsdf_value va, vb, vc;
    assert_true(bsdf_eval(&a, wo, wi, TRANSPORT_RADIANCE, &va));
    assert_true(bsdf_eval(&b, wo, wi, TRANSPORT_RADIANCE, &vb));
    assert_true(bsdf_eval(&c, wo, wi, TRANSPORT_RADIANCE, &vc));
    assert_true(va.pdf == vb.pdf && va.pdf != vc.pdf);
    assert_false(a.flags & BSDF_ANISOTROPIC);
    assert_true(c.flags & BSDF_ANISOTROPIC);
}

static struct rgb left_and_right(const struct texture *texture,
                                 const struct texture_point *at)
{
    (void)texture;
    return rgb_grey(at->u);
}

/* A texture's value at the hit is what the parameter would be everywhere: for a coat
 * within what its tables, which know of one axis only, lose between their
 * knots. */
static void test_textured_roughness(void **state)
{
    (void)state;
    static const struct texture ramp = {.eval = left_and_right};
    static const char *const kinds[] = {"roughconductor", "roughdielectric", "substrate",
                                        "uber", "roughplastic"};
    static const char *const names[] = {"alpha", "alpha_u", "alpha_v"};
    const double alphas[] = {0.0, 0.05, 0.2, 0.7, 1.0};
    for (int k = 0; k < 5; k++)
        for (int i = 0; i < 3 * 5; i++) {
            double alpha = alphas[i % 5], least = k == 2 ? 0.0 : 1e-5;
            const char *name = names[i / 5];
            struct bsdf constant = bsdf_make(kinds[k], name, fmax(alpha, least), NULL);
            struct bsdf textured;
            struct bsdf_nodes nodes = {0};
            bsdf_init(&textured, bsdf_find(kinds[k]));
            assert_true(bsdf_bind(&textured, name, &ramp, NULL, NULL));
            assert_true(bsdf_prepare(&textured, NULL, NULL));
            assert_true(textured.flags & BSDF_TEXTURED);
            assert_true(!(textured.flags & BSDF_ANISOTROPIC) == (i < 5));
            const struct bsdf *at = bsdf_at(
                &textured, &(struct texture_point){.u = alpha, .v = 0.5}, &nodes);
            struct vec3 wo = bsdf_direction(0.6, 0.3), wi = bsdf_direction(0.5, 3.0);
            struct bsdf_value a, b;
            bsdf_eval(&constant, wo, wi, TRANSPORT_RADIANCE, &a);
            bsdf_eval(at, wo, wi, TRANSPORT_RADIANCE, &b);
            double lost = k < 4 ? SAME : i < 5 ? 0.02 : 0.1;
            assert_true(isfinite(b.f.g) && isfinite(b.pdf));
            if (!(fabs(a.f.g - b.f.g) <= lost * a.f.g &&
                  fabs(a.pdf - b.pdf) <= lost * a.pdf))
                fail_msg("%s %s %g: f %g, of a texture %g; pdf %g, %g", kinds[k], name,
                         alpha, a.f.g, b.f.g, a.pdf, b.pdf);
        }
}

/* Two axes by textures may differ somewhere, though their middles do not. */
static void test_textured_axes_align_frames(void **state)
{
    (void)state;
    static const struct texture ramp = {.eval = left_and_right};
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find("roughconductor"));
    assert_true(bsdf_bind(&bsdf, "alpha_u", &ramp, NULL, NULL));
    assert_true(bsdf_bind(&bsdf, "alpha_v", &ramp, NULL, NULL));
    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
    assert_true(bsdf.flags & BSDF_ANISOTROPIC);
}

/* A kind neither writes nor reads numbers beyond those that are copied for a textured
 * hit: NaN there stays and does not show. */
static void test_places(void **state)
{
    (void)state;
    struct bsdf child;
    bsdf_init(&child, bsdf_find("diffuse"));
    assert_true(bsdf_prepare(&child, NULL, NULL));
    for (int i = 0; bsdf_types[i]; i++) {
        struct bsdf bsdf;
        struct rng rng;
        int places = bsdf_types[i]->places;
        rng_init(&rng, 9, RNG_TEST, (uint64_t)i);
        assert_true(places >= 0 && places <= BSDF_PARAMS);
        bsdf_init(&bsdf, bsdf_types[i]);
        bsdf.child[0] = bsdf.child[1] = &child;
        for (int k = places; k < BSDF_PARAMS; k++)
            bsdf.param[k] = (double)NAN;
        assert_true(bsdf_prepare(&bsdf, NULL, NULL));
        for (int k = 0; k < BSDF_PARAMS; k++)
            assert_true(k < places || isnan(bsdf.param[k]));
        for (int k = 0; k < 200; k++) {
            struct vec3 wo = random_direction(&rng), wi = random_direction(&rng);
            const double u[3] = {rng_double(&rng), rng_double(&rng), rng_double(&rng)};
            struct bsdf_value value;
            struct bsdf_sample sample;
            if (bsdf_eval(&bsdf, wo, wi, TRANSPORT_RADIANCE, &value))
                assert_true(rgb_is_finite(value.f) &&
                            isfinite(value.pdf + value.pdf_rev));
            if (bsdf_sample(&bsdf, wo, u, TRANSPORT_RADIANCE, &sample))
                assert_true(rgb_is_finite(sample.weight) && isfinite(sample.pdf));
        }
    }
}

static void test_table(void **state)
{
    (void)state;
    for (int i = 0; bsdf_types[i]; i++) {
        assert_ptr_equal(bsdf_find(bsdf_types[i]->name), bsdf_types[i]);
        for (const struct bsdf_param *p = bsdf_types[i]->params; p->name; p++) {
            assert_ptr_equal(bsdf_param_find(bsdf_types[i], p->name), p);
            assert_true(p->offset >= 0 && p->offset + p->count <= BSDF_PARAMS);
            assert_true(p->count == 1 || p->count == 3);
        }
    }
    assert_null(bsdf_find("velvet"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_textured_roughness),
        cmocka_unit_test(test_textured_axes_align_frames),
        cmocka_unit_test(test_set_checks),
        cmocka_unit_test(test_set_colours),
        cmocka_unit_test(test_prepare_checks),
        cmocka_unit_test(test_alpha_sets_both_axes),
        cmocka_unit_test(test_flags_announce_the_numbers),
        cmocka_unit_test(test_black_returns_false),
        cmocka_unit_test(test_diffuse_values),
        cmocka_unit_test(test_grooves_by_transcription),
        cmocka_unit_test(test_translucent_values),
        cmocka_unit_test(test_delta_lobes_run_back),
        cmocka_unit_test(test_thin_glass_sums_its_reflections),
        cmocka_unit_test(test_straight_lobe),
        cmocka_unit_test(test_blend_keeps_all_light),
        cmocka_unit_test(test_blend_of_disjoint_colours),
        cmocka_unit_test(test_plastic_keeps_all_light),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_white_furnace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
