/* import/mitsuba/mitsuba_instance, import/instance: groups of shapes and where they are
 * placed. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/mitsuba_test.h"

#define GROUP                                                                    \
    "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"><bsdf "          \
    "type=\"diffuse\"/>"                                                         \
    "</shape><shape type=\"rectangle\"><transform name=\"to_world\"><translate " \
    "z=\"3\"/>"                                                                  \
    "</transform></shape></shape>"
#define INSTANCE(step)                                                           \
    "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">" step \
    "</transform></shape>"

/* Each instance has every shape of the group, under its own transform; the group itself
 * shows nothing, whether it stands before them or after. */
static void test_instances(void **state)
{
    (void)state;
    static const char *const texts[] = {
        NEW(GROUP INSTANCE("<translate x=\"1\"/>") INSTANCE("<scale value=\"2\"/>")),
        NEW(INSTANCE("<translate x=\"1\"/>") INSTANCE("<scale value=\"2\"/>") GROUP)};
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = good(texts[i]);
        assert_int_equal(desc->log.count, 0);
        assert_int_equal(desc->instance_count, 2);
        assert_int_equal(desc->shape_count, 4);
        assert_int_equal(desc->shapes[0].kind, SHAPE_SPHERE);
        import_test_near(desc->shapes[0].to_world.m[0][3], 1.0, 1e-12);
        import_test_near(desc->shapes[2].to_world.m[0][0], 2.0, 1e-12);
        point_is(desc->shapes[1].mesh->p, 0.0, -1.0, 3.0);
        point_is(desc->shapes[3].mesh->p, -2.0, -2.0, 6.0);
        assert_int_equal(desc->shapes[0].material, desc->shapes[2].material);
        scene_desc_destroy(desc);
    }
}

/* An instance that mirrors keeps the outside, though it turns the winding. */
static void test_mirrored(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW(GROUP INSTANCE("<scale x=\"-1\"/>") INSTANCE("<scale x=\"2\"/>")));
    assert_true(desc->shapes[1].reverse_orientation);
    assert_false(desc->shapes[3].reverse_orientation);
    assert_false(desc->shapes[0].reverse_orientation);
    scene_desc_destroy(desc);
}

/* A group that nothing places is not read; an emitter in one is as bright in each. */
static void test_lamps(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"shapegroup\" id=\"u\"><shape type=\"sphere\"/></shape>"
            "<shape type=\"shapegroup\" id=\"g\"><shape type=\"disk\"><emitter "
            "type=\"area\"><rgb name=\"radiance\" value=\"1 2 "
            "3\"/></emitter></shape></shape>" INSTANCE("<translate x=\"1\"/>")
                INSTANCE("<translate x=\"2\"/>")));
    assert_int_equal(desc->shape_count, 2);
    for (int i = 0; i < 2; i++) {
        assert_true(desc->shapes[i].emits);
        rgb_is(&desc->shapes[i].radiance.r, 1.0, 2.0, 3.0);
    }
    scene_desc_destroy(desc);
}

static void test_bad(void **state)
{
    (void)state;
    import_test_bad("scene.xml", NEW("<shape type=\"instance\"/>"),
                    "scene.xml:2:1: shape \"instance\" wants a shape \"shapegroup\"");
    import_test_bad("scene.xml",
                    NEW("<shape type=\"sphere\" id=\"g\"/>" INSTANCE("<scale/>")),
                    "wants a shape \"shapegroup\"");
    import_test_bad("scene.xml",
                    NEW("<shape type=\"shapegroup\" id=\"g\">" INSTANCE(
                        "<scale value=\"2\"/>") "</shape>" INSTANCE("<scale/>")),
                    "an instance within a shapegroup");
    import_test_bad("scene.xml",
                    NEW("<shape type=\"shapegroup\" id=\"g\"><shape "
                        "type=\"shapegroup\"/></shape>" INSTANCE("<scale/>")),
                    "a shapegroup within a shapegroup");
    import_test_bad(
        "scene.xml",
        NEW("<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"><float "
            "name=\"radius\" value=\"-1\"/></shape></shape>" INSTANCE("<scale/>")),
        "the radius -1 is not positive");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_instances),
        cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_lamps),
        cmocka_unit_test(test_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
