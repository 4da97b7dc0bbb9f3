/* Extremes of scale, emission, roughness, depth and lamp, and the rarer places of light
 * and camera: pt and bdpt agree there, nothing is non-finite, and what has to be
 * invariant is so to the last bit. */

#include <string.h>

#include "math/accum.h"
#include "path/estimate.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define BATCHES     40
#define FILM        8
#define CELLS       5 /* luminance of four quarters of the film, and of all */

enum extreme {
    EXTREME_PLAIN,
    EXTREME_TWO_SIDED, /* a lamp in mid-air that emits to both sides and reflects */
    EXTREME_BULB,      /* a lamp within smooth glass */
    EXTREME_INSIDE,    /* the camera within smooth glass */
    EXTREME_GLOWING,   /* glass and a mirror that emit */
    EXTREME_SMOOTHED,  /* rough glass whose shading normals are not its own */
    EXTREME_BENT,      /* the same of smooth glass */
    EXTREME_LENS,      /* a wide lens */
    EXTREME_LIGHTS,    /* radiances from 1e-6 to 1e6 and a point light */
    EXTREME_NEEDLE,    /* a lamp ten thousand times as long as wide */
    EXTREME_POLISHED,  /* alpha 1e-3 */
    EXTREME_RAZOR,     /* metal and glass of alpha 1e-5 */
    EXTREMES
};

static const char *const name[EXTREMES] = {"plain",   "two-sided", "bulb",     "inside",
                                           "glowing", "smoothed",  "bent",     "lens",
                                           "lights",  "needle",    "polished", "razor"};

static void lamp(struct scene_desc *desc, int material, float y, float u, float v,
                 struct rgb radiance, bool two_sided)
{
    test_quad(desc, vec3(0.1f, y, 0), vec3(u, 0, 0), vec3(0, 0, v), material, radiance);
    desc->shapes[desc->shape_count - 1].two_sided = two_sided;
}

static void vase_of(struct scene_desc *desc, const char *kind, const char *param,
                    double value)
{
    test_vase(desc, test_material(desc, kind, NULL, rgb_grey(0.0), param, value));
}

static void add_extreme(struct scene_desc *desc, enum extreme what)
{
    const struct rgb dark = {0, 0, 0};
    const struct vec3 left = {-0.45f, 0.45f, -0.3f}, right = {0.45f, 0.4f, 0.25f};
    int black = test_material(desc, "black", NULL, dark, NULL, 0.0);
    int glass = test_material(desc, "dielectric", NULL, dark, "eta", 1.5);
    int white = test_diffuse(desc, 0.6, 0.6, 0.6);
    switch (what) {
    case EXTREME_TWO_SIDED:
        lamp(desc, white, 1.2f, 0.3f, 0.2f, rgb(4, 5, 6), true);
        break;
    case EXTREME_BULB:
        test_sphere(desc, vec3(0, 1, 0), 0.5, glass, dark, false);
        test_sphere(desc, vec3(0, 1, 0), 0.25, black, rgb(9, 8, 7), false);
        break;
    case EXTREME_GLOWING: {
        int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0);
        test_sphere(desc, left, 0.4, mirror, rgb(1, 2, 1), false);
        test_sphere(desc, right, 0.35, glass, rgb(1, 0.5, 2), false);
        break;
    }
    case EXTREME_SMOOTHED:
        vase_of(desc, "roughdielectric", "alpha", 0.3);
        break;
    case EXTREME_BENT:
        vase_of(desc, "dielectric", "eta", 1.3);
        break;
    case EXTREME_LIGHTS:
        lamp(desc, black, 1.9f, 1e-4f, 1e-4f, rgb(3e6, 2e6, 1e6), false);
        lamp(desc, black, 1.8f, 0.9f, 0.1f, rgb(1e-6, 2e-6, 1e-6), true);
        test_sphere(desc, left, 0.3, white, rgb(0.2, 0.1, 0.1), false);
        test_point_light(desc, vec3(-0.6f, 1.6f, 0.6f), rgb(0.5, 0.6, 0.9));
        break;
    case EXTREME_POLISHED: {
        int metal = test_material(desc, "roughconductor", NULL, dark, "alpha", 1e-3);
        test_sphere(desc, left, 0.4, metal, dark, false);
        break;
    }
    case EXTREME_RAZOR: {
        int metal = test_material(desc, "roughconductor", NULL, dark, "alpha", 1e-5);
        int frosted = test_material(desc, "roughdielectric", NULL, dark, "alpha", 1e-5);
        test_sphere(desc, left, 0.4, metal, dark, false);
        test_sphere(desc, right, 0.35, frosted, dark, false);
        break;
    }
    default:
        test_sphere(desc, left, 0.4, white, dark, false);
    }
    if (what == EXTREME_NEEDLE) /* shines up, so that no pixel sees it directly */
        lamp(desc, black, 1.2f, 0.8f, -8e-5f, rgb_grey(5e4), false);
    else
        lamp(desc, black, 1.98f, 0.8f, 0.35f, rgb_grey(12.0), false);
}

static void scale_desc(struct scene_desc *desc, double scale, double emission)
{
    struct xform grow = xform_scale(scale, scale, scale);
    for (size_t i = 0; i < desc->shape_count; i++) {
        struct shape_desc *s = &desc->shapes[i];
        if (s->mesh)
            mesh_transform(s->mesh, &grow);
        else
            s->to_world = xform_mul(&grow, &s->to_world);
        s->radiance = rgb_scale(s->radiance, emission);
    }
    for (size_t i = 0; i < desc->light_count; i++) {
        struct light_desc *l = &desc->lights[i];
        l->to_world = xform_mul(&grow, &l->to_world);
        l->intensity = rgb_scale(l->intensity, emission * scale * scale);
    }
    desc->camera.to_world = xform_mul(&grow, &desc->camera.to_world);
    desc->camera.lens_radius *= scale;
    desc->camera.focus_distance *= scale;
}

static struct scene *extreme(enum extreme what, double scale, double emission)
{
    float z = what == EXTREME_INSIDE ? 0.9f : 4.5f;
    struct scene_desc *desc = test_desc(vec3(0, 1, z), vec3(0, 1, 0), 34.0, FILM);
    test_room(desc);
    add_extreme(desc, what);
    if (what == EXTREME_INSIDE) {
        int glass = test_material(desc, "dielectric", NULL, rgb_grey(0), "eta", 1.5);
        test_sphere(desc, vec3(0, 1, z), 0.2, glass, rgb_grey(0), false);
    }
    if (what == EXTREME_LENS) {
        desc->camera.lens_radius = 0.5;
        desc->camera.focus_distance = 4.0;
        desc->camera.crop[0] = 0.25;
        desc->camera.crop[3] = 0.75;
    }
    scale_desc(desc, scale, emission);
    return test_build(desc, false);
}

/* --- pt and bdpt ------------------------------------------------------------------ */

typedef void (*estimate_function)(struct subpaths *paths, const struct numbers *numbers,
                                  struct contrib *out);

struct cells {
    struct welford batch[CELLS];
};

static void add_splats(const struct scene *scene, const struct contrib *out, double *sum)
{
    int width = scene->camera.width, height = scene->camera.height;
    for (int i = 0; i < out->count; i++) {
        int x = out->splats[i].pixel % width, y = out->splats[i].pixel / width;
        sum[2 * (2 * y / height) + 2 * x / width] += rgb_luminance(out->splats[i].value);
    }
    sum[4] += out->target;
}

static struct cells gather(const struct scene *scene, estimate_function estimate,
                           int depth, long paths, int stream)
{
    struct cells c = {0};
    struct subpaths p;
    struct rng rng;
    struct ustream_random u;
    struct contrib out;
    rng_init(&rng, 21, RNG_TEST, (uint64_t)stream);
    ustream_random_init(&u, &rng);
    subpaths_init(&p, scene, depth);
    contrib_init(&out, estimate_splats(depth));
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    for (int batch = 0; batch < BATCHES; batch++) {
        double sum[CELLS] = {0};
        for (long i = 0; i < paths / BATCHES; i++) {
            estimate(&p, &numbers, &out);
            add_splats(scene, &out, sum);
        }
        for (int i = 0; i < CELLS; i++)
            welford_add(&c.batch[i],
                        sum[i] * scene->emission_scale / (double)(paths / BATCHES));
    }
    assert_int_equal(out.nonfinite, 0);
    contrib_deinit(&out);
    subpaths_deinit(&p);
    return c;
}

static void compare(const char *what, const struct cells *a, const struct cells *b,
                    int comparisons)
{
    double level = stat_sidak(FALSE_ALARM, CELLS * comparisons), worst = 0.0;
    for (int i = 0; i < CELLS; i++) {
        double se = hypot(welford_se(&a->batch[i]), welford_se(&b->batch[i]));
        double z = (a->batch[i].mean - b->batch[i].mean) / se;
        worst = fabs(z) > fabs(worst) ? z : worst;
        assert_true(stat_ok(what, stat_t_p(z, BATCHES - 1), level));
    }
    printf("%-10s %.6g +- %.2g against %.6g +- %.2g; worst t of %d: %.2f\n", what,
           a->batch[4].mean, welford_se(&a->batch[4]), b->batch[4].mean,
           welford_se(&b->batch[4]), CELLS, worst);
}

static long samples(long usual)
{
    return getenv("ETALON_LONG") ? 10 * usual : usual;
}

static void test_places(void **state)
{
    (void)state;
    for (int i = 0; i < EXTREMES; i++) {
        struct scene *scene = extreme((enum extreme)i, 1.0, 1.0);
        /* pt finds no caustic of a point light, which begins at 3 edges. */
        int depth = i == EXTREME_LIGHTS ? 4 : 5;
        struct cells pt = gather(scene, estimate_pt, depth, samples(120000), 2 * i);
        struct cells bdpt = gather(scene, estimate_bdpt, depth, samples(40000),
                                   2 * i + 1);
        compare(name[i], &pt, &bdpt, EXTREMES);
        scene_destroy(scene);
    }
}

/* At other scales the same picture. */
static void test_scales(void **state)
{
    (void)state;
    static const double scales[] = {1e-6, 1e6};
    static const enum extreme what[] = {EXTREME_LIGHTS, EXTREME_BULB, EXTREME_LENS};
    for (int i = 0; i < 3; i++) {
        struct scene *one = extreme(what[i], 1.0, 1.0);
        struct cells reference = gather(one, estimate_bdpt, 4, samples(30000), 50);
        for (int j = 0; j < 2; j++) {
            struct scene *scene = extreme(what[i], scales[j], 1.0);
            struct cells pt = gather(scene, estimate_pt, 4, samples(60000), 51);
            struct cells bdpt = gather(scene, estimate_bdpt, 4, samples(30000), 52);
            compare(name[what[i]], &pt, &bdpt, 12);
            compare(name[what[i]], &bdpt, &reference, 12);
            scene_destroy(scene);
        }
        scene_destroy(one);
    }
}

static void test_deep(void **state)
{
    (void)state;
    struct scene *scene = extreme(EXTREME_TWO_SIDED, 1.0, 1.0);
    struct cells pt = gather(scene, estimate_pt, 64, samples(60000), 60);
    struct cells bdpt = gather(scene, estimate_bdpt, 64, samples(20000), 61);
    compare("depth 64", &pt, &bdpt, 1);
    scene_destroy(scene);
}

/* --- to the last bit -------------------------------------------------------------- */

static void same_cells(const struct cells *a, const struct cells *b, double factor)
{
    for (int i = 0; i < CELLS; i++) {
        assert_true(a->batch[i].mean > 0.0);
        assert_true(a->batch[i].mean * factor == b->batch[i].mean);
    }
}

/* A scene made larger by a power of two has the very same paths, bit by bit: no length
 * is fixed anywhere. */
static void test_power_of_two_scale(void **state)
{
    (void)state;
    static const double scales[] = {0x1p-20, 0x1p20};
    for (int i = 0; i < EXTREMES; i++) {
        struct scene *one = extreme((enum extreme)i, 1.0, 1.0);
        struct cells reference = gather(one, estimate_bdpt, 5, 4000, 70);
        for (int j = 0; j < 2; j++) {
            struct scene *scene = extreme((enum extreme)i, scales[j], 1.0);
            struct cells scaled = gather(scene, estimate_bdpt, 5, 4000, 70);
            same_cells(&reference, &scaled, 1.0);
            scene_destroy(scene);
        }
        scene_destroy(one);
    }
}

/* The same numbers give the same paths whatever the emission. */
static void test_emission(void **state)
{
    (void)state;
    struct scene *one = extreme(EXTREME_LIGHTS, 1.0, 1.0);
    struct cells reference = gather(one, estimate_bdpt, 5, 4000, 80);
    static const double powers[] = {0x1p-100, 0x1p100};
    static const double others[] = {1e-30, 1e30};
    for (int i = 0; i < 2; i++) {
        struct scene *exact = extreme(EXTREME_LIGHTS, 1.0, powers[i]);
        struct scene *rounded = extreme(EXTREME_LIGHTS, 1.0, others[i]);
        struct cells a = gather(exact, estimate_bdpt, 5, 4000, 80);
        struct cells b = gather(rounded, estimate_bdpt, 5, 4000, 80);
        same_cells(&reference, &a, powers[i]);
        for (int j = 0; j < CELLS; j++)
            assert_true(
                fabs(b.batch[j].mean / others[i] / reference.batch[j].mean - 1.0) < 1e-9);
        scene_destroy(exact);
        scene_destroy(rounded);
    }
    scene_destroy(one);
}

static struct run_result chains(double emission, const char *estimator)
{
    const char *const words[] = {"mutations_per_pixel=500",
                                 "bootstrap=1000",
                                 "chains=7",
                                 "max_depth=5",
                                 estimator,
                                 NULL};
    struct scene *scene = extreme(EXTREME_LIGHTS, 1.0, emission);
    struct settings s = test_settings(words);
    struct run_result r = test_run(scene, &s);
    assert_true(r.statistics.nonfinite == 0.0 && r.statistics.saturated == 0.0);
    scene_destroy(scene);
    return r;
}

/* Emission times 2^k: every accept decision is the same. */
static void test_decisions(void **state)
{
    (void)state;
    static const char *const estimators[] = {"estimator=kelemen", "estimator=plain"};
    static const double factors[] = {0x1p-90, 0x1p90};
    for (int i = 0; i < 2; i++) {
        struct run_result one = chains(1.0, estimators[i]);
        for (int j = 0; j < 2; j++) {
            struct run_result r = chains(factors[j], estimators[i]);
            const struct run_statistics *a = &one.statistics, *b = &r.statistics;
            assert_true(a->acceptance == b->acceptance && a->acceptance > 0.0);
            assert_memory_equal(&a->start, &b->start, sizeof a->start);
            assert_memory_equal(&a->whole, &b->whole, sizeof a->whole);
            assert_true(a->plarge.p_l == b->plarge.p_l);
            assert_true(a->b * factors[j] == b->b && a->b_se * factors[j] == b->b_se);
            for (int k = 0; k < 3 * FILM * FILM; k++)
                assert_true(one.image->pixels[k] * (float)factors[j] ==
                            r.image->pixels[k]);
            run_result_deinit(&r);
        }
        run_result_deinit(&one);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),   cmocka_unit_test(test_scales),
        cmocka_unit_test(test_deep),     cmocka_unit_test(test_power_of_two_scale),
        cmocka_unit_test(test_emission), cmocka_unit_test(test_decisions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
