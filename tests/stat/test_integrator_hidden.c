/* hide_emitters: paths of one edge carry no light in any integrator, all others do as
 * before; and the alpha channel that comes with it.
 *
 * An orthographic camera looks at eight columns of pixels in one plane, under a sky of
 * radiance S all around, so that what each column shows is known in closed form. Nothing
 * in the plane lights anything else in it.
 *
 * Statements about hidden emitters and alpha are exact. Pictures are t-tests over
 * replicates of the mean of each column, with a family-wise false-alarm rate of 1e-6: a
 * bias of so many standard errors as the test prints fails with power 0.99. A direct
 * view that stays, or a direct view that is lost, is one of thousands. */

#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define ALARM      1e-6
#define SIDE       8
#define REPLICATES 16
#define LAMP       3.0
#define SKY        0.5
#define ALBEDO     0.6
#define ETA        1.5
/* At normal incidence a pane lets 2n / (n^2 + 1) through and reflects the rest. */
#define PASSES (2.0 * ETA / (ETA * ETA + 1.0))

enum column { LAMP_0, BACK_1, SKY_2, SKY_3, OBJECT_4, HALF_5, PANE_6, FILTER_7 };

static const struct rgb tint = {0.25, 0.5, 0.75};

/* What each column shows, and what is left of it without direct views. */
static void expected(enum column column, bool hidden, struct rgb *value, double *alpha)
{
    double object = ALBEDO * SKY, sky = hidden ? 0.0 : SKY;
    const struct rgb values[SIDE] = {
        rgb_grey(hidden ? 0.0 : LAMP),
        rgb_grey(0.0),
        rgb_grey(sky),
        rgb_grey(sky),
        rgb_grey(object),
        rgb_grey(0.5 * (object + sky)),
        rgb_grey((1.0 - PASSES) * SKY + PASSES * sky),
        rgb_scale(tint, sky),
    };
    const double alphas[SIDE] = {0.0, 1.0, 0.0,          0.0,
                                 1.0, 0.5, 1.0 - PASSES, 1.0 - rgb_luminance(tint)};
    *value = values[column];
    *alpha = alphas[column];
}

/* A strip from x0 to x1, in pixels, turned to the camera or away from it. To the right in
 * the picture is -x. */
static void strip(struct scene_desc *desc, double x0, double x1, bool away, int material,
                  double radiance)
{
    float half = (float)(0.5 * (x1 - x0)), middle = (float)(0.5 * SIDE - 0.5 * (x0 + x1));
    test_quad(desc, vec3(middle, 0, 0), vec3(away ? -half : half, 0, 0),
              vec3(0, 0.5f * SIDE, 0), material, rgb_grey(radiance));
}

static struct scene *columns(bool hidden)
{
    double eye[3] = {0.0, 0.0, 3.0}, target[3] = {0.0}, up[3] = {0.0, 1.0, 0.0};
    struct scene_desc *desc = test_desc(vec3(0, 1, 3), vec3(0, 1, 0), 20.0, SIDE);
    desc->camera.extent = SIDE;
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    struct light_desc sky = {.type = &light_environment,
                             .intensity = rgb_grey(SKY),
                             .to_world = xform_identity()};
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    int grey = test_diffuse(desc, ALBEDO, ALBEDO, ALBEDO);
    strip(desc, 0.0, 1.0, false, black, LAMP);
    strip(desc, 1.0, 2.0, true, black, LAMP);
    strip(desc, 4.0, 5.5, false, grey, 0.0);
    strip(desc, 6.0, 7.0, false,
          test_material(desc, "thindielectric", NULL, rgb_grey(1.0), "eta", ETA), 0.0);
    strip(desc, 7.0, 8.0, false,
          test_material(desc, "null", "transmittance", tint, NULL, 0.0), 0.0);
    scene_desc_add_light(desc, &sky);
    desc->hide_emitters = hidden;
    return test_build(desc, false);
}

static double column_mean(const struct image *image, int x, int channel)
{
    double sum = 0.0;
    for (int y = 0; y < SIDE; y++)
        sum += (double)image_at(image, x, y)[channel] / SIDE;
    return sum;
}

static const char *const ways[][3] = {
    {"integrator=pt", "seed=1", "mutations_per_pixel=64"},
    {"integrator=bdpt", "seed=1", "mutations_per_pixel=64"},
    {"integrator=pssmlt", "builder=bdpt", "mutations_per_pixel=1000"},
    {"integrator=pssmlt", "builder=pt", "mutations_per_pixel=1000"},
    {"integrator=mmlt", "direct=separate", "mutations_per_pixel=1000"},
    {"integrator=mmlt", "direct=joint", "mutations_per_pixel=1000"},
    {"integrator=pfmlt", "direct=joint", "mutations_per_pixel=1000"},
};
#define WAYS (sizeof ways / sizeof *ways)

static struct run_result render(const struct scene *scene, size_t way, long seed)
{
    const char *const words[] = {"max_depth=2", "bootstrap=10000", ways[way][0],
                                 ways[way][1],  ways[way][2],      NULL};
    struct settings settings = test_settings(words);
    settings.seed = seed;
    return test_run(scene, &settings);
}

/* Fails where a column of the replicates is not what it must be. */
static bool columns_are(struct run_result *runs, size_t way, bool hidden, double level)
{
    bool good = true;
    for (int x = 0; x < SIDE; x++)
        for (int channel = 0; channel < 3; channel += 2) {
            struct rgb value;
            double alpha, sample[REPLICATES], spread = 0.0;
            char what[80];
            expected((enum column)x, hidden, &value, &alpha);
            double exact = channel == 0 ? value.r : value.b;
            for (int i = 0; i < REPLICATES; i++) {
                sample[i] = column_mean(runs[i].image, x, channel);
                spread = fmax(spread, fabs(sample[i] - exact));
            }
            snprintf(what, sizeof what, "%s %s, %s, column %d, channel %d", ways[way][0],
                     ways[way][1], hidden ? "hidden" : "seen", x, channel);
            if (exact == 0.0)
                good &= spread == 0.0 || stat_ok(what, 0.0, level);
            else if (spread > 1e-6 * exact) /* else there is no noise but rounding */
                good &= stat_ok(what, stat_mean_p(sample, REPLICATES, exact), level);
        }
    return good;
}

static void test_only_direct_views_are_missing(void **state)
{
    (void)state;
    double level = stat_sidak(ALARM, 2 * (int)WAYS * SIDE * 2);
    bool good = true;
    printf("power .99 at %.1f standard errors\n",
           stat_t_seen(level, REPLICATES - 1, 0.99));
    for (int hidden = 0; hidden < 2; hidden++) {
        struct scene *scene = columns(hidden);
        for (size_t way = 0; way < WAYS; way++) {
            struct run_result runs[REPLICATES];
            for (int i = 0; i < REPLICATES; i++)
                runs[i] = render(scene, way, i + 1);
            good &= columns_are(runs, way, hidden, level);
            for (int i = 0; i < REPLICATES; i++)
                run_result_deinit(&runs[i]);
        }
        scene_destroy(scene);
    }
    assert_true(good);
}

/* The same numbers make the same paths of more edges: where a column is not seen through
 * anything, the two pictures of pt are bit-equal. So are those of mmlt whose chains have
 * length 2 alone. */
static void test_longer_paths_are_the_same(void **state)
{
    (void)state;
    static const size_t same[] = {0, 4};
    struct scene *scenes[2] = {columns(false), columns(true)};
    for (int k = 0; k < 2; k++) {
        struct run_result seen = render(scenes[0], same[k], 5),
                          hidden = render(scenes[1], same[k], 5);
        for (int y = 0; y < SIDE; y++)
            assert_memory_equal(image_at(seen.image, OBJECT_4, y),
                                image_at(hidden.image, OBJECT_4, y), 3 * sizeof(float));
        run_result_deinit(&seen);
        run_result_deinit(&hidden);
    }
    scene_destroy(scenes[0]);
    scene_destroy(scenes[1]);
}

/* No chain of length 1 is started, none is missed. */
static void test_no_chains_of_length_1(void **state)
{
    (void)state;
    struct scene *scenes[2] = {columns(false), columns(true)};
    for (int hidden = 0; hidden < 2; hidden++) {
        struct run_result r = render(scenes[hidden], 5, 1);
        assert_int_equal(r.statistics.length_count, hidden ? 1 : 2);
        assert_int_equal(r.statistics.lengths[0].length, hidden ? 2 : 1);
        run_result_deinit(&r);
        scene_destroy(scenes[hidden]);
    }
}

static void test_alpha(void **state)
{
    (void)state;
    struct scene *scene = columns(true), *seen = columns(false);
    struct run_result r = render(scene, 0, 1), other = render(seen, 0, 1);
    const float *a = layers_find(&r.layers, "A");
    assert_null(layers_find(&other.layers, "A"));
    assert_non_null(a);
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct rgb value;
        double alpha;
        expected((enum column)(i % SIDE), true, &value, &alpha);
        if (fabs((double)a[i] - alpha) > 1e-6)
            fail_msg("alpha of column %d: %g, not %g", i % SIDE, (double)a[i], alpha);
    }
    run_result_deinit(&r);
    run_result_deinit(&other);
    scene_destroy(scene);
    scene_destroy(seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_only_direct_views_are_missing),
        cmocka_unit_test(test_longer_paths_are_the_same),
        cmocka_unit_test(test_no_chains_of_length_1),
        cmocka_unit_test(test_alpha),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
