/* Every kind's sampling against its own density: chi-squared over polar cells about the
 * lobe (side x ring x octant, plus "nothing scattered"), expectations by quadrature of
 * eval's pdf. Each of
 * the two tests raises a false alarm with probability 1e-4 (Sidak over its cases). */

#include "math/rng.h"
#include "support/albedo.h"
#include "support/stat_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#define FALSE_ALARM 1e-4
#define CELLS       (2 * ALBEDO_LEVELS * 8)

struct setup {
    const char *kind;
    double alpha_u, alpha_v; /* 0: has none */
    double eta;              /* 0: default */
    double distribution;
    struct {
        const char *name;
        double value;
    } more[8]; /* up to name NULL */
};

#define NO_MORE       \
    {                 \
        {             \
            NULL, 0.0 \
        }             \
    }

static const struct setup setups[] = {
    {"diffuse", 0, 0, 0, 0, NO_MORE},
    {"roughconductor", 1e-3, 1e-3, 0, 0, NO_MORE},
    {"roughconductor", 0.05, 0.3, 0, 0, NO_MORE},
    {"roughconductor", 1.0, 1.0, 0, 0, NO_MORE},
    {"roughconductor", 1e-3, 1e-3, 0, 1, NO_MORE},
    {"roughconductor", 0.4, 0.05, 0, 1, NO_MORE},
    {"roughconductor", 1.0, 1.0, 0, 1, NO_MORE},
    {"roughdielectric", 1e-3, 1e-3, 1.5, 0, NO_MORE},
    {"roughdielectric", 0.1, 0.3, 1.5, 0, NO_MORE},
    {"roughdielectric", 0.6, 0.6, 1.33, 0, NO_MORE},
    {"roughdielectric", 0.2, 0.2, 0.7, 0, NO_MORE},
    {"roughdielectric", 0.05, 0.05, 1.5, 1, NO_MORE},
    {"roughdielectric", 0.5, 0.2, 2.4, 1, NO_MORE},
    {"substrate", 1e-3, 1e-3, 0, 0, NO_MORE},
    {"substrate", 0.1, 0.4, 0, 0, NO_MORE},
    {"substrate", 0.8, 0.8, 0, 0, NO_MORE},
    {"plastic", 0, 0, 1.5, 0, NO_MORE},
    {"roughplastic", 0.02, 0.02, 1.5, 0, NO_MORE},
    {"roughplastic", 0.3, 0.3, 1.9, 1, NO_MORE},
    {"phong", 0, 0, 0, 0, NO_MORE},
    {"uber", 0.05, 0.05, 1.5, 0, NO_MORE},
    {"uber", 0.3, 0.1, 0.66, 1, NO_MORE},
    {"translucent", 0, 0, 0, 0, {{"reflectance", 0.6}, {"transmittance", 0.2}}},
    {"translucent", 0, 0, 0, 0, {{"reflectance", 0.0}, {"transmittance", 0.5}}},
    {"orennayar", 0, 0, 0, 0, {{"sigma", 0.5}}},
    {"orennayar", 0, 0, 0, 0, {{"sigma", 1.5}, {"full", 1.0}, {"reflectance", 1.0}}},
};
#define SETUPS ((int)(sizeof setups / sizeof setups[0]))

static const double cosines[] = {1.0, 0.8, 0.3, 0.05, 0.01, -0.95, -0.6, -0.1, -0.01};
#define COSINES ((int)(sizeof cosines / sizeof cosines[0]))

static void set_number(struct bsdf *bsdf, const char *name, double value)
{
    assert_true(bsdf_set(bsdf, name, &value, 1, NULL, NULL));
}

static struct bsdf make(const struct setup *s)
{
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find(s->kind));
    if (s->alpha_u > 0.0) {
        set_number(&bsdf, "alpha_u", s->alpha_u);
        set_number(&bsdf, "alpha_v", s->alpha_v);
    }
    if (s->eta > 0.0)
        set_number(&bsdf, "eta", s->eta);
    if (s->distribution > 0.0)
        set_number(&bsdf, "distribution", s->distribution);
    for (int i = 0; s->more[i].name; i++)
        set_number(&bsdf, s->more[i].name, s->more[i].value);
    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
    return bsdf;
}

static struct vec3 direction(double cosine)
{
    double sine = sqrt(1.0 - cosine * cosine);
    return vec3((float)(sine * 0.6), (float)(sine * -0.8), (float)cosine);
}

static int sample_count(void)
{
    return getenv("ETALON_LONG") ? 2000000 : 100000;
}

static int cell_of(const struct albedo_polar polar[2], struct vec3 wo, struct vec3 wi)
{
    int transmission = (wo.z > 0.0f) != (wi.z > 0.0f);
    double t, phi;
    albedo_polar_of(&polar[transmission], wi, &t, &phi);
    int ring = 0, octant = (int)floor(phi / (0.25 * MATH_PI)) + 4;
    while (ring < ALBEDO_LEVELS - 1 && t < albedo_ring(ring + 1))
        ring++;
    octant = octant < 0 ? 0 : octant > 7 ? 7 : octant;
    return (transmission * ALBEDO_LEVELS + ring) * 8 + octant;
}

/* Probability of every cell; returns the bound of the error of their sum. */
static double expect(const struct albedo_query *query, const struct albedo_polar polar[2],
                     double probability[CELLS])
{
    double error = 0.0;
    for (int cell = 0; cell < CELLS; cell++) {
        int transmission = cell / (8 * ALBEDO_LEVELS), ring = cell / 8 % ALBEDO_LEVELS;
        double total[4] = {0};
        const double t[2] = {albedo_ring(ring + 1), albedo_ring(ring)};
        struct albedo_problem problem = {&polar[transmission], albedo_scattering, query,
                                         albedo_tolerance(query->bsdf)};
        if (query->bsdf->flags & (transmission ? BSDF_TRANSMITS : BSDF_REFLECTS))
            error += albedo_octant(&problem, t, cell % 8, total);
        probability[cell] = total[3];
    }
    return error;
}

/* What eval's pdf may change by when a component of wi is off by one unit in the last
 * place: sample saw wi before it was rounded. */
static double rounding_of_pdf(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                              double pdf)
{
    double sum = 1e-6 * pdf;
    for (int i = 0; i < 6; i++) {
        struct vec3 w = wi;
        float *component = i / 2 == 0 ? &w.x : i / 2 == 1 ? &w.y : &w.z;
        *component = nextafterf(*component, i % 2 ? 2.0f : -2.0f);
        struct bsdf_value value;
        bsdf_eval(bsdf, wo, w, TRANSPORT_RADIANCE, &value);
        sum += fabs(value.pdf - pdf);
    }
    return sum;
}

/* The sample's own numbers agree with eval at the direction it returned. */
static void check_against_eval(const struct bsdf *bsdf, struct vec3 wo,
                               const struct bsdf_sample *s, enum transport mode)
{
    struct bsdf_value v;
    assert_true(bsdf_eval(bsdf, wo, s->wi, mode, &v));
    double scale = fabs((double)s->wi.z) / v.pdf;
    /* The weight is smooth where f and pdf are steep. */
    assert_true(fabs(v.f.r * scale - s->weight.r) <= 2e-5 * s->weight.r);
    assert_true(fabs(v.f.g * scale - s->weight.g) <= 2e-5 * s->weight.g);
    assert_true(fabs(v.f.b * scale - s->weight.b) <= 2e-5 * s->weight.b);
    assert_true(fabs(v.pdf - s->pdf) <= 2.0 * rounding_of_pdf(bsdf, wo, s->wi, v.pdf));
    /* The ratio of the two densities is smooth too. */
    assert_true(fabs(v.pdf_rev / v.pdf - s->pdf_rev / s->pdf) <=
                2e-5 * v.pdf_rev / v.pdf);
}

/* One kind from one direction: the p-value. */
static double run_case(const struct bsdf *bsdf, struct vec3 wo, uint64_t index)
{
    static double observed[CELLS + 1], expected[CELLS + 1];
    const struct albedo_polar polar[2] = {albedo_polar_init(bsdf, wo, false),
                                          albedo_polar_init(bsdf, wo, true)};
    struct albedo_query query = {bsdf, wo, TRANSPORT_RADIANCE};
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, index);
    int n = sample_count();
    for (int i = 0; i <= CELLS; i++)
        observed[i] = 0.0;
    for (int k = 0; k < n; k++) {
        const double u[3] = {rng_double(&rng), rng_double(&rng), rng_double(&rng)};
        enum transport mode = k % 2 ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE;
        struct bsdf_sample s;
        bool some = bsdf_sample(bsdf, wo, u, mode, &s);
        /* Delta lobes have no density: they are of what eval's leaves. */
        some = some && !s.delta;
        observed[some ? cell_of(polar, wo, s.wi) : CELLS] += 1.0;
        if (some && k < 2000)
            check_against_eval(bsdf, wo, &s, mode);
    }
    double error = expect(&query, polar, expected), total = 0.0;
    for (int i = 0; i < CELLS; i++) {
        total += expected[i];
        expected[i] = n * fmax(1e-9, expected[i]);
    }
    assert_true(total <= 1.0 + error + 1e-6);
    /* Never 0, here and above: what the quadrature cannot see may happen. */
    expected[CELLS] = n * fmax(1e-9, 1.0 - total);
    return stat_chi2_p(observed, expected, CELLS + 1);
}

static void test_samples_follow_the_pdf(void **state)
{
    (void)state;
    double level = stat_sidak(FALSE_ALARM, SETUPS * COSINES);
    int failed = 0;
    for (int i = 0; i < SETUPS; i++)
        for (int j = 0; j < COSINES; j++) {
            struct bsdf bsdf = make(&setups[i]);
            char what[128];
            snprintf(what, sizeof what,
                     "%d: %s alpha %g %g eta %g distribution %g, cos %g", i,
                     setups[i].kind, setups[i].alpha_u, setups[i].alpha_v, setups[i].eta,
                     setups[i].distribution, cosines[j]);
            uint64_t index = (uint64_t)(i * COSINES + j);
            failed += !stat_ok(what, run_case(&bsdf, direction(cosines[j]), index),
                               level);
        }
    assert_int_equal(failed, 0);
}

/* Lobes of a smooth kind come with their probability: exact binomial law. */
static void test_delta_lobes_follow_their_probability(void **state)
{
    (void)state;
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find("dielectric"));
    assert_true(bsdf_prepare(&bsdf, NULL, NULL));
    double level = stat_sidak(FALSE_ALARM, COSINES);
    for (int j = 0; j < COSINES; j++) {
        struct rng rng;
        rng_init(&rng, 2, RNG_TEST, (uint64_t)j);
        long n = 100000, reflected = 0;
        double pdf[2] = {0.0, 0.0};
        for (long k = 0; k < n; k++) {
            const double u[3] = {rng_double(&rng), 0.0, 0.0};
            struct bsdf_sample s;
            assert_true(
                bsdf_sample(&bsdf, direction(cosines[j]), u, TRANSPORT_RADIANCE, &s));
            reflected += !s.transmission;
            pdf[s.transmission] = s.pdf;
        }
        double p = pdf[0] > 0.0 ? pdf[0] : 1.0 - pdf[1];
        assert_true(stat_ok("dielectric lobe", stat_binomial_p(reflected, n, p), level));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_samples_follow_the_pdf),
        cmocka_unit_test(test_delta_lobes_follow_their_probability),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
