/* Inverse samples of every kind of BSDF. Numbers u give wi; of wi, numbers v are found.
 * Then v gives wi again; and v has the law of u given that something was scattered: by
 * chi-squared of 6 x 6 x 6 cells of the cube of (lobe, two of the direction), 40000 of
 * each, all cases together raising a false alarm with the rate FALSE_ALARM. By the
 * noncentral law of that, a lobe of half of the density that is drawn 9 % too often is
 * seen with a power of .9. A number that is not drawn anew within its lobe, and a lobe
 * drawn by its chance rather than by its share of the density, give p below 1e-50. */

#include "math/rng.h"
#include "support/bsdf_make.h"
#include "support/stat_test.h"

#include <setjmp.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define SAMPLES     80000
#define SIDE        6
#define CELLS       (SIDE * SIDE * SIDE)

/* Largest difference of a direction in units of 2^-24: the rounding of its components. */
#define ULPS 2.0

#define MATERIALS 44

struct material {
    const char *words;
    struct bsdf bsdf;
};

static struct material materials[MATERIALS];
static int material_count;

static const struct bsdf *add(const char *words, struct bsdf bsdf)
{
    struct material *m = &materials[material_count++];
    *m = (struct material){words, bsdf};
    return &m->bsdf;
}

static void add_rough(void)
{
    add("roughconductor GGX .1", bsdf_make("roughconductor", "alpha", 0.1, NULL));
    add("roughconductor GGX .05 x .6",
        bsdf_make("roughconductor", "alpha_u", 0.05, "alpha_v", 0.6, NULL));
    add("roughconductor Beckmann .3 x .1",
        bsdf_make("roughconductor", "alpha_u", 0.3, "alpha_v", 0.1, "distribution", 1.0,
                  NULL));
    add("roughdielectric GGX .3", bsdf_make("roughdielectric", "alpha", 0.3, NULL));
    add("roughdielectric Beckmann .2", bsdf_make("roughdielectric", "alpha", 0.2,
                                                 "distribution", 1.0, "eta", 0.7, NULL));
    add("roughconductor GGX .01", bsdf_make("roughconductor", "alpha", 0.01, NULL));
    add("roughconductor Beckmann .001",
        bsdf_make("roughconductor", "alpha", 0.001, "distribution", 1.0, NULL));
    add("roughdielectric GGX .005", bsdf_make("roughdielectric", "alpha", 0.005, NULL));
    add("roughplastic .01", bsdf_make("roughplastic", "alpha", 0.01, NULL));
    add("substrate", bsdf_make("substrate", "alpha", 0.2, NULL));
    add("roughplastic", bsdf_make("roughplastic", "alpha", 0.2, NULL));
    add("roughplastic, coat alone",
        bsdf_make("roughplastic", "alpha", 0.3, "reflectance", 0.0, NULL));
    add("phong", bsdf_make("phong", "exponent", 20.0, "ks", 0.5, NULL));
    add("phong, lobe alone", bsdf_make("phong", "kd", 0.0, NULL));
    add("principled",
        bsdf_make("principled", "clearcoat", 1.0, "sheen", 0.5, "roughness", 0.4, NULL));
    add("principled metal",
        bsdf_make("principled", "metallic", 1.0, "anisotropic", 0.8, NULL));
    add("principled glass",
        bsdf_make("principled", "spec_trans", 0.7, "clearcoat", 1.0, NULL));
}

static void add_smooth(void)
{
    add("mirror", bsdf_make("mirror", NULL));
    add("conductor", bsdf_make("conductor", NULL));
    add("dielectric", bsdf_make("dielectric", NULL));
    add("dielectric 1/1.33", bsdf_make("dielectric", "eta", 0.75, NULL));
    add("thindielectric", bsdf_make("thindielectric", "eta", 1.8, NULL));
    add("null", bsdf_make("null", NULL));
}

static void add_all(void)
{
    const struct bsdf *diffuse = add("diffuse", bsdf_make("diffuse", NULL));
    add("orennayar", bsdf_make("orennayar", "sigma", 0.5, NULL));
    add("translucent", bsdf_make("translucent", "transmittance", 0.5, NULL));
    add_rough();
    add_smooth();
    const struct bsdf *plastic = add("plastic", bsdf_make("plastic", NULL));
    const struct bsdf *uber = add(
        "uber", bsdf_make("uber", "opacity", 0.7, "kr", 0.5, "kt", 0.3, NULL));
    add("uber without lobes that are straight", bsdf_make("uber", "alpha", 0.3, NULL));
    const struct bsdf *metal = &materials[3].bsdf, *nothing = NULL;
    for (int i = 0; i < material_count; i++)
        nothing = strcmp(materials[i].words, "null") ? nothing : &materials[i].bsdf;
    const struct bsdf *half = add("diffuse and metal",
                                  bsdf_make_pair("blend", diffuse, metal, 0.4));
    add("plastic in a mask", bsdf_make_pair("blend", nothing, plastic, 0.6));
    add("uber in a mask", bsdf_make_pair("blend", uber, nothing, 0.3));
    add("a blend of blends", bsdf_make_pair("blend", half, plastic, 0.3));
    add("two sides", bsdf_make_pair("sides", half, plastic, 0.0));
}

static double apart(struct vec3 a, struct vec3 b)
{
    struct vec3 d = vec3_sub(a, b);
    return sqrt((double)vec3_dot(d, d)) / 0x1p-24;
}

static int cell(const double u[3])
{
    int at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (int)(u[i] * SIDE);
    return (at[0] * SIDE + at[1]) * SIDE + at[2];
}

struct tried {
    long samples, refused, far;
    double worst, before[CELLS], after[CELLS];
};

static void try_one(const struct bsdf *bsdf, struct vec3 wo, bool even, struct rng *rng,
                    struct tried *tried)
{
    struct bsdf_sample s, again;
    double u[3], v[3], choice = rng_double(rng);
    for (int i = 0; i < 3; i++) {
        u[i] = rng_double(rng);
        v[i] = rng_double(rng);
    }
    if (!bsdf_sample(bsdf, wo, u, TRANSPORT_RADIANCE, &s))
        return;
    tried->samples++;
    if (!bsdf_invert(bsdf, wo, s.wi, s.delta, choice, v)) {
        tried->refused++;
        return;
    }
    for (int i = 0; i < 3; i++)
        assert_true(v[i] >= 0.0 && v[i] < 1.0);
    (even ? tried->before : tried->after)[cell(even ? u : v)] += 1.0;
    bool scattered = bsdf_sample(bsdf, wo, v, TRANSPORT_RADIANCE, &again);
    double ulps = scattered && again.delta == s.delta ? apart(s.wi, again.wi) : 0x1p24;
    tried->far += ulps > ULPS;
    tried->worst = fmax(tried->worst, ulps);
}

static void test_inverses(void **state)
{
    static const double cosines[] = {0.9, 0.25, -0.6, 0.02};
    struct rng rng;
    bool ok = true;
    (void)state;
    rng_init(&rng, 41, RNG_TEST, 0);
    add_all();
    double level = stat_sidak(FALSE_ALARM, 4 * material_count);
    for (int m = 0; m < material_count; m++)
        for (int c = 0; c < 4; c++) {
            struct tried tried = {0};
            struct vec3 wo = bsdf_direction(cosines[c], 0.7);
            for (int i = 0; i < SAMPLES; i++)
                try_one(&materials[m].bsdf, wo, i % 2 == 0, &rng, &tried);
            if (tried.samples == 0)
                continue;
            double p = stat_chi2_two_p(tried.before, tried.after, CELLS);
            printf("%-36s cos %5.2f: %5ld samples, refused %ld, beyond %g ulp %ld, worst "
                   "%.3g; p %.3g\n",
                   materials[m].words, cosines[c], tried.samples, tried.refused, ULPS,
                   tried.far, tried.worst, p);
            ok = stat_ok(materials[m].words, p, level) && ok;
            assert_int_equal(tried.refused + tried.far, 0);
        }
    assert_true(ok);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inverses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
