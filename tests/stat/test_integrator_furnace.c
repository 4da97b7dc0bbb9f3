/* A disk of each material inside a sphere that emits radiance 1, or under a sky of that
 * radiance without end: what the camera sees is
 * the material's own directional albedo, which is known by quadrature. And things that
 * absorb nothing, behind panes and masks that neither do, inside such a sphere: nothing
 * of them can be seen. In every integrator, t-tests over replicate runs. */

#include <string.h>

#include "math/accum.h"
#include "support/albedo.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <gsl/gsl_integration.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define REPLICATES  12
#define NODES       8
#define EYE         4.0 /* distance of the camera from the disk's centre */
#define FOV         20.0
#define TILT        50.0 /* degrees between the disk's normal and the view */

static const struct {
    const char *kind, *param;
    double value;
    bool sky;
} materials[] = {
    {"diffuse", "reflectance", 0.8, false}, {"mirror", "reflectance", 0.9, false},
    {"conductor", NULL, 0.0, false},        {"roughconductor", "alpha", 0.3, false},
    {"dielectric", "eta", 1.5, false},      {"roughdielectric", "alpha", 0.4, false},
    {"substrate", "alpha", 0.15, false},    {"phong", "exponent", 20.0, false},
    {"roughplastic", "alpha", 0.2, false},  {"diffuse", "reflectance", 1.0, true},
    {"plastic", "reflectance", 0.7, true},  {"uber", "opacity", 0.6, true},
    {"thindielectric", "eta", 1.5, true},   {"roughdielectric", "alpha", 0.3, true},
};

#define MATERIALS ((int)(sizeof materials / sizeof materials[0]))

static const char *const integrators[][4] = {
    {"integrator=pt", NULL},
    {"integrator=bdpt", NULL},
    {"integrator=pssmlt", "bootstrap=4000", NULL},
    {"integrator=pssmlt", "bootstrap=4000", "builder=pt", NULL},
    {"integrator=mmlt", "bootstrap=4000", "direct=joint", NULL},
    {"integrator=pfmlt", "bootstrap=4000", "direct=joint", NULL},
    {"integrator=rjmlt", "bootstrap=4000", "jump_probability=0.5", NULL},
};

#define INTEGRATORS ((int)(sizeof integrators / sizeof integrators[0]))

static int add_material(struct scene_desc *desc, int i)
{
    struct rgb value = rgb_grey(materials[i].value);
    return test_material(desc, materials[i].kind, materials[i].param, value, NULL, 0.0);
}

static struct scene *furnace(int material)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, (float)EYE), vec3(0, 0, 0), FOV, 4);
    struct shape_desc disk = {
        .kind = SHAPE_DISK,
        .radius = 3.0,
        .to_world = xform_rotate(TILT, 1.0, 0.0, 0.0),
        .material = add_material(desc, material),
    };
    scene_desc_add_shape(desc, &disk);
    if (materials[material].sky) {
        struct light_desc sky = {.type = &light_environment,
                                 .intensity = rgb_grey(1.0),
                                 .to_world = xform_identity()};
        scene_desc_add_light(desc, &sky);
        return test_build(desc, false);
    }
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    test_sphere(desc, vec3(0, 0, 0), 10.0, black, rgb_grey(1.0), true);
    return test_build(desc, false);
}

/* A white disk under a pane, a mask and a filter without colour, inside a sphere of
 * radiance 1: radiance 1 everywhere, up to what is reflected more than 24 times. */
#define PANES_DEPTH "max_depth=24"

static struct scene *furnace_panes(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, (float)EYE), vec3(0, 0, 0), FOV, 4);
    struct rgb dark = {0.0, 0.0, 0.0};
    int white = test_diffuse(desc, 1.0, 1.0, 1.0);
    int pane = test_material(desc, "thindielectric", NULL, dark, "eta", 1.9);
    int null = test_material(desc, "null", NULL, dark, NULL, 0.0);
    struct bsdf card;
    struct err err = {0};
    double present = 0.4;
    bsdf_init(&card, bsdf_find("blend"));
    card.child[0] = scene_desc_add_part(desc, &desc->materials[null]);
    card.child[1] = scene_desc_add_part(desc, &desc->materials[white]);
    if (!bsdf_set(&card, "weight", &present, 1, NULL, &err) ||
        !bsdf_prepare(&card, NULL, &err))
        test_scene_die(&err);
    test_quad(desc, vec3(0, 0, 0), vec3(2, 0, 1), vec3(0, 2, 0), white, dark);
    test_quad(desc, vec3(0, 0, 1), vec3(3, 0, 1), vec3(0, 3, 0), pane, dark);
    test_quad(desc, vec3(0, 0.5f, 1.5f), vec3(1, 0, 0), vec3(0, 0.5f, -0.2f),
              scene_desc_add_material(desc, &card), dark);
    test_quad(desc, vec3(0, 0, 2), vec3(1, 0, 0), vec3(0, 1, 0), null, dark);
    int black = test_material(desc, "black", NULL, dark, NULL, 0.0);
    test_sphere(desc, vec3(0, 0, 0), 10.0, black, rgb_grey(1.0), true);
    return test_build(desc, false);
}

/* Luminance of the albedo towards the camera through film point (x, y) in [-1,1]^2. */
static double albedo_at(const struct bsdf *bsdf, double x, double y)
{
    double half = tan(FOV / 2.0 * MATH_PI / 180.0), tilt = TILT * MATH_PI / 180.0;
    double length = sqrt(1.0 + half * half * (x * x + y * y));
    /* To the camera is (-x half, -y half, 1) / length; the normal is (0, -sin, cos). */
    double cosine = (sin(tilt) * y * half + cos(tilt)) / length;
    struct vec3 wo = vec3((float)sqrt(1.0 - cosine * cosine), 0.0f, (float)cosine);
    return rgb_luminance(albedo_quadrature(bsdf, wo, TRANSPORT_RADIANCE));
}

/* Mean over the film by Gauss-Legendre. */
static double film_mean(const struct bsdf *bsdf)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(NODES);
    double sum = 0.0, x, y, wx, wy;
    for (size_t i = 0; i < NODES; i++)
        for (size_t j = 0; j < NODES; j++) {
            gsl_integration_glfixed_point(-1.0, 1.0, i, &x, &wx, table);
            gsl_integration_glfixed_point(-1.0, 1.0, j, &y, &wy, table);
            sum += wx * wy / 4.0 * albedo_at(bsdf, x, y);
        }
    gsl_integration_glfixed_table_free(table);
    return sum;
}

static void check(const struct scene *scene, const char *kind, const char *depth,
                  int integrator, double exact)
{
    const char *words[8] = {"mutations_per_pixel=350", depth};
    double level = stat_sidak(FALSE_ALARM, (MATERIALS + 1) * INTEGRATORS), x[REPLICATES];
    struct welford spread = {0};
    for (int i = 0; integrators[integrator][i]; i++)
        words[2 + i] = integrators[integrator][i];
    struct settings s = test_settings(words);
    double worst = 0.0;
    for (int i = 0; i < REPLICATES; i++) {
        s.seed = 10 + i;
        struct run_result r = test_run(scene, &s);
        x[i] = rgb_luminance(test_image_mean(r.image));
        welford_add(&spread, x[i]);
        worst = fmax(worst, fabs(x[i] - exact));
        assert_true(r.statistics.nonfinite == 0.0);
        run_result_deinit(&r);
    }
    printf("%s %s: exact %.6f, off by at most %.6f in %d runs, mean off by %.6f +- "
           "%.6f\n",
           kind, words[2], exact, worst, REPLICATES, spread.mean - exact,
           welford_se(&spread));
    /* Noise-free where nothing varies: then float rounding is what is left. */
    if (worst < 1e-6)
        return;
    assert_true(stat_ok(kind, stat_mean_p(x, REPLICATES, exact), level));
}

static void test_furnace(void **state)
{
    (void)state;
    for (int i = 0; i < MATERIALS; i++) {
        struct scene *scene = furnace(i);
        double exact = film_mean(&scene->desc->materials[0]);
        for (int j = 0; j < INTEGRATORS; j++)
            check(scene, materials[i].kind, "max_depth=2", j, exact);
        scene_destroy(scene);
    }
}

static void test_nothing_to_be_seen(void **state)
{
    (void)state;
    struct scene *scene = furnace_panes();
    for (int j = 0; j < INTEGRATORS; j++)
        check(scene, "panes", PANES_DEPTH, j, 1.0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_furnace),
                                       cmocka_unit_test(test_nothing_to_be_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
