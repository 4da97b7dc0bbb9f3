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

/* A disk in the plane y = x whose lamp, if any, shines down. */
static void add_disk(struct scene_desc *desc, double x, bool lamp)
{
    struct xform down = xform_rotate(90.0, 1.0, 0.0, 0.0);
    struct xform up = xform_translate(0.0, x, 0.0);
    struct shape_desc disk = {.kind = SHAPE_DISK,
                              .radius = 0.25,
                              .to_world = xform_mul(&up, &down),
                              .material = test_diffuse(desc, 0.5, 0.5, 0.5),
                              .emits = lamp,
                              .radiance = rgb_grey(lamp ? 1.0 : 0.0)};
    scene_desc_add_shape(desc, &disk);
}

enum lamp { LAMP_DISK, LAMP_QUAD, LAMP_BALL, LAMP_EDGE };

/* A lamp `apart` from a floor (disk: a quadric one, else triangles), turned or not.
 * LAMP_EDGE stands upright on it; the ball touches it in a point. */
static struct scene_desc *make_contact(enum lamp lamp, double apart, bool disk, bool turn)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 0.001f), vec3(0, 0, 0), 40.0, 4);
    float y = (float)apart;
    int black = stability_black(desc);
    if (disk)
        add_disk(desc, 0.0, false);
    else
        stability_floor(desc, 2.0f);
    if (lamp == LAMP_DISK)
        add_disk(desc, apart, true);
    else if (lamp == LAMP_BALL)
        test_sphere(desc, vec3(0, y + 0.125f, 0), 0.125, black, rgb_grey(1.0), false);
    else if (lamp == LAMP_QUAD)
        test_quad(desc, vec3(0, y, 0), vec3(0.125f, 0, 0), vec3(0, 0, 0.125f), black,
                  rgb_grey(1.0));
    else
        test_quad(desc, vec3(0, y + 0.125f, 0), vec3(0.125f, 0, 0), vec3(0, 0.125f, 0),
                  black, rgb_grey(1.0));
    if (turn)
        stability_turn(desc);
    return desc;
}

/* Whichever of the two surfaces rays meet, and wherever both lie: contact is told, a
 * distance that floats hold is not. Nothing here is drawn at random. */
static void lamps_in_contact(void **state)
{
    (void)state;
    static const char upon[] = "a lamp lies upon another surface";
    for (int disk = 0; disk < 2; disk++)
        for (int turn = 0; turn < 2; turn++) {
            assert_true(says(make_contact(LAMP_DISK, 0.0, disk, turn), upon));
            assert_true(says(make_contact(LAMP_QUAD, 0.0, disk, turn), upon));
            assert_false(says(make_contact(LAMP_DISK, 1e-4, disk, turn), upon));
            assert_false(says(make_contact(LAMP_QUAD, 1e-4, disk, turn), upon));
            assert_false(says(make_contact(LAMP_BALL, 0.0, disk, turn), upon));
            assert_false(says(make_contact(LAMP_EDGE, 0.0, disk, turn), upon));
        }
    assert_true(says(make_near_lamp(0.0), upon));
    assert_false(says(make_near_lamp(1e-5), upon));
}

/* The note stands at the lamp and names the other's place. */
static void both_surfaces_are_named(void **state)
{
    (void)state;
    struct err err;
    struct scene_desc *desc = make_near_lamp(0.0);
    for (size_t i = 0; i < desc->shape_count; i++)
        desc->shapes[i].place = (struct place){"room.yaml", 10 + (int)i, 5};
    struct scene *scene = build(desc, &err);
    assert_non_null(scene);
    const struct log *log = &scene->desc->log;
    assert_int_equal(log->count, 1);
    assert_int_equal(log->notes[0].line, 11);
    assert_non_null(strstr(log->notes[0].text, "(that of room.yaml:10:5)"));
    scene_destroy(scene);
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
        cmocka_unit_test(sizes),
        cmocka_unit_test(emissions),
        cmocka_unit_test(cameras),
        cmocka_unit_test(near_surfaces),
        cmocka_unit_test(lamps_in_contact),
        cmocka_unit_test(both_surfaces_are_named),
        cmocka_unit_test(many_surfaces),
        cmocka_unit_test(too_bright_a_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
