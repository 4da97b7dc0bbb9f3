/* import/mitsuba/mitsuba_instance: groups of shapes and where they are placed. */
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

/* The group's shapes are kept once, in its space, and each instance has its own
 * transform; the group itself shows nothing, whether it stands before them or after. */
static void test_instances(void **state)
{
    (void)state;
    static const char *const texts[] = {
        NEW(GROUP INSTANCE("<translate x=\"1\"/>") INSTANCE("<scale value=\"2\"/>")),
        NEW(INSTANCE("<translate x=\"1\"/>") INSTANCE("<scale value=\"2\"/>") GROUP)};
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = good(texts[i]);
        assert_int_equal(desc->log.count, 0);
        const struct instance_desc *instance = desc->instances.list;
        assert_int_equal(desc->object_count, 1);
        assert_int_equal(desc->instances.count, 2);
        assert_int_equal(desc->shape_count, 2);
        assert_int_equal(desc->shapes[0].kind, SHAPE_SPHERE);
        point_is(desc->shapes[1].mesh->p, -1.0, -1.0, 3.0);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(desc->shapes[k].object, 1);
            assert_int_equal(instance[k].object, 1);
            assert_int_equal(instance[k].parent, 0);
        }
        import_test_near(instance[0].to_world.m[0][3], 1.0, 1e-12);
        import_test_near(instance[1].to_world.m[0][0], 2.0, 1e-12);
        scene_desc_destroy(desc);
    }
}

/* A shape outside of the group is in the scene, though the group was read before it. */
static void test_others(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW(GROUP INSTANCE("<scale x=\"-1\"/>") "<shape type=\"sphere\"/>"));
    assert_int_equal(desc->shape_count, 3);
    assert_int_equal(desc->shapes[1].object, 1);
    assert_int_equal(desc->shapes[2].object, 0);
    assert_false(desc->shapes[1].reverse_orientation);
    scene_desc_destroy(desc);
}

/* A group that nothing places is not read; an emitter in one emits at each instance. */
static void test_lamps(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"shapegroup\" id=\"u\"><shape type=\"sphere\"/></shape>"
            "<shape type=\"shapegroup\" id=\"g\"><shape type=\"disk\"><emitter "
            "type=\"area\"><rgb name=\"radiance\" value=\"1 2 "
            "3\"/></emitter></shape></shape>" INSTANCE("<translate x=\"1\"/>")
                INSTANCE("<translate x=\"2\"/>")));
    assert_int_equal(desc->object_count, 1);
    assert_int_equal(desc->shape_count, 1);
    assert_int_equal(desc->instances.count, 2);
    assert_true(desc->shapes[0].emits);
    rgb_is(&desc->shapes[0].radiance.r, 1.0, 2.0, 3.0);
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
        cmocka_unit_test(test_others),
        cmocka_unit_test(test_lamps),
        cmocka_unit_test(test_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
