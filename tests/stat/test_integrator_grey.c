/* Every integrator and its main designs (support/designs.h) in the grey furnace: a closed
 * room all of whose surfaces emit radiance 1 and reflect the same share, so that every
 * pixel and every path length is known exactly. Noise is low: a picture that is wrong by
 * 1 % is seen in every design, and the test fails where it would not be.
 *
 * False alarms: FALSE_ALARM for all figures of all designs together. */

#include "support/designs.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define REPLICATES  40
#define MUTATIONS   32.0 /* a pixel and replicate, see design_run */
#define SEES_LEAST  0.01

static const struct rgb grey = {0.7, 0.5, 0.3};

/* A box closed on all sides, a diffuse ball and a mirror; all emit 1 and reflect `grey`.
 */
static struct scene *grey_furnace(void)
{
    const struct rgb one = {1.0, 1.0, 1.0};
    struct scene_desc *desc = test_desc(vec3(0.4f, 1.1f, 0.9f), vec3(-0.1f, 0.8f, 0),
                                        70.0, DESIGN_SIDE);
    int wall = test_diffuse(desc, grey.r, grey.g, grey.b);
    int mirror = test_material(desc, "mirror", "reflectance", grey, NULL, 0.0);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 1), vec3(1, 0, 0), wall, one);
    test_quad(desc, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1), wall, one);
    test_quad(desc, vec3(0, 1, -1), vec3(1, 0, 0), vec3(0, 1, 0), wall, one);
    test_quad(desc, vec3(0, 1, 1), vec3(0, 1, 0), vec3(1, 0, 0), wall, one);
    test_quad(desc, vec3(-1, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), wall, one);
    test_quad(desc, vec3(1, 1, 0), vec3(0, 0, 1), vec3(0, 1, 0), wall, one);
    test_sphere(desc, vec3(-0.4f, 0.5f, -0.3f), 0.4, wall, one, false);
    test_sphere(desc, vec3(0.45f, 0.6f, -0.2f), 0.35, mirror, one, false);
    return test_build(desc, false);
}

/* Each edge more multiplies by the reflectance. */
static struct truth furnace_truth(void)
{
    struct truth t = {.value = {0.0}};
    struct rgb length = {1.0, 1.0, 1.0};
    for (int k = 1; k <= DESIGN_DEPTH; k++) {
        t.value[FIGURE_LENGTH + k - 1] = rgb_luminance(length);
        t.value[FIGURE_FILM] += rgb_luminance(length);
        t.value[FIGURE_RED] += length.r;
        t.value[FIGURE_BLUE] += length.b;
        length = rgb_mul(length, grey);
    }
    t.value[FIGURE_B] = t.value[FIGURE_FILM];
    for (int i = 0; i < 4; i++)
        t.value[FIGURE_QUARTER + i] = 1.0;
    t.value[FIGURE_FILM_B] = 1.0;
    return t;
}

static void test_furnace(void **state)
{
    (void)state;
    struct scene *scene = grey_furnace();
    struct truth truth = furnace_truth();
    double level = stat_sidak(FALSE_ALARM, FIGURES * DESIGNS), sees;
    for (int i = 0; i < DESIGNS; i++) {
        struct figures f = design_run(scene, &designs[i], REPLICATES, MUTATIONS);
        design_print("furnace", &designs[i]);
        assert_true(figures_agree("furnace", &f, &truth, level, &sees));
        assert_true(sees < SEES_LEAST);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_furnace)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
