/* Scenes beyond what floats hold are refused in one line that says what would be right;
 * surfaces too near for rays are told. */

#include "support/stability_mesh.h"
#include "support/stability_view.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static struct scene *build(struct scene_desc *desc, struct err *err)
{
    struct scene_options options = {.threads = 1};
    *err = (struct err){0};
    return scene_build(desc, &options, err);
}

static void refuse(struct scene_desc *desc, const char *why)
{
    struct err err;
    assert_null(build(desc, &err));
    assert_non_null(strstr(err.message, why));
}

static void accept(struct scene_desc *desc)
{
    struct err err;
    struct scene *scene = build(desc, &err);
    assert_non_null(scene);
    scene_destroy(scene);
}

static void sizes(void **state)
{
    (void)state;
    refuse(make_scaled_ball(1e-15), "scale the scene");
    refuse(make_scaled_square(1e15), "scale the scene");
    accept(make_scaled_ball(1e-6));
    accept(make_scaled_ball(1e6));
    accept(make_glowing_box(1e-10));
    accept(make_glowing_box(1e11));
}

static void emissions(void **state)
{
    (void)state;
    refuse(make_radiance(1e-38), "scale all emission");
    refuse(make_radiance(1e40), "scale all emission");
    refuse(make_radiance(1e300), "scale all emission");
    accept(make_radiance(1e-30));
    accept(make_radiance(1e30));
}

static void cameras(void **state)
{
    (void)state;
    refuse(make_narrow(1e-6), "wider field of view");
    refuse(make_lens(1e4), "smaller lens");
    accept(make_narrow(1e-4));
    accept(make_lens(1e2));
    refuse(make_spot(1e-4), "outer >= 0.001");
    accept(make_spot(1e-3));
}

/* How often the scene's log says it. */
static long times(struct scene_desc *desc, const char *what)
{
    struct err err;
    struct scene *scene = build(desc, &err);
    assert_non_null(scene);
    long count = 0;
    for (size_t i = 0; i < scene->desc->log.count; i++)
        if (strstr(scene->desc->log.notes[i].text, what))
            count += scene->desc->log.notes[i].count;
    scene_destroy(scene);
    return count;
}

static bool says(struct scene_desc *desc, const char *what)
{
    return times(desc, what) > 0;
}

static void near_surfaces(void **state)
{
    (void)state;
    static const char upon[] = "a lamp lies upon another surface";
    static const char box[] = "fill the same box";
    assert_true(says(make_coplanar_lamp(0.0), upon));
    assert_true(!says(make_coplanar_lamp(1e-4), upon));
    assert_true(!says(make_square(0.5), upon) && !says(make_ball(0.5), upon));
    assert_true(says(make_panes(1e-7), box) && !says(make_panes(1e-3), box));
    assert_true(says(make_shells(1e-7), box) && !says(make_shells(1e-3), box));
    static const char within[] = "less than rays can tell apart: where";
    assert_true(says(make_double_floor(1e-9), within));
    assert_true(says(make_double_floor(1e-8), within));
    assert_true(!says(make_double_floor(0.0), within));
    assert_true(!says(make_double_floor(1e-4), within));
    assert_true(!says(make_glowing_box(1.0), within));
    assert_true(says(make_degenerate_walls(0.0), "degenerate triangle"));
    assert_true(says(make_degenerate_walls(0.0), "is there twice"));
    assert_true(says(make_narrow(2e-5), "of a pixel") &&
                !says(make_narrow(1e-3), "pixel"));
}

/* Squares side by side, the first of which is there twice. */
static struct scene_desc *make_squares(int count, bool along_x)
{
    struct scene_desc *desc = stability_patch();
    int grey = test_diffuse(desc, 0.5, 0.5, 0.5);
    for (int i = 0; i <= count; i++) {
        float at = 3.0f * (float)(i % count);
        test_quad(desc, vec3(along_x ? at : 0, 9, along_x ? 0 : at), vec3(1, 0, 0),
                  vec3(0, 0, 1), grey, rgb_grey(1.0));
    }
    return desc;
}

/* What is not looked at is told; equal boxes are found among any number. */
static void many_surfaces(void **state)
{
    (void)state;
    static const char lamps[] = "beyond the first 1024 lamps";
    static const char boxes[] = "begins at the x of more than 64 others";
    assert_int_equal(times(make_squares(1000, true), lamps), 0);
    assert_int_equal(times(make_squares(1030, true), lamps), 7);
    assert_int_equal(times(make_squares(60, false), boxes), 0);
    assert_int_equal(times(make_squares(200, true), boxes), 0);
    assert_int_equal(times(make_squares(200, false), boxes), 135);
    assert_int_equal(times(make_squares(200, false), "fill the same box"), 1);
}

/* A point light so near that its spot passes the largest float: clamped and counted. */
static void too_bright_a_picture(void **state)
{
    (void)state;
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=4", NULL};
    struct scene_desc *desc = stability_patch();
    test_point_light(desc, vec3(0, 1e-3f, 0), rgb_grey(1e37));
    struct scene *scene = test_build(desc, false);
    struct settings settings = test_settings(words);
    struct run_result r = test_run(scene, &settings);
    assert_true(r.statistics.saturated > 0.0 && r.statistics.nonfinite == 0.0);
    for (int i = 0; i < 3 * STABILITY_FILM * STABILITY_FILM; i++)
        assert_true(isfinite(r.image->pixels[i]));
    run_result_deinit(&r);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes),         cmocka_unit_test(emissions),
        cmocka_unit_test(cameras),       cmocka_unit_test(near_surfaces),
        cmocka_unit_test(many_surfaces), cmocka_unit_test(too_bright_a_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
