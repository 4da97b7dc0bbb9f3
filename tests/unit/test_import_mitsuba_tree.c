/* import/mitsuba/mitsuba_tree: what is defined for a file beside it, and comments that
 * XML forbids. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/mitsuba_test.h"

#define FILM(size)                                                                      \
    "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "      \
    "value=\"" size "\"/><integer name=\"height\" value=\"4\"/><rfilter type=\"box\"/>" \
    "</film></sensor>"

static struct scene_desc *defined(const char *name, const char *text,
                                  const char *const *definitions, int count,
                                  struct err *err)
{
    struct import_options options = {
        .threads = 1, .definitions = definitions, .definition_count = count};
    return import_scene(import_test_write(name, text), &options, err);
}

/* What is defined beside the file counts before its defaults. */
static void test_definitions(void **state)
{
    (void)state;
    static const char *const given[] = {"wide=12", "unit=3"};
    struct err err = {0};
    struct scene_desc *desc = defined(
        "scene.xml", NEW("<default name=\"wide\" value=\"7\"/>" FILM("$wide$unit")),
        given, 2, &err);
    assert_non_null(desc);
    assert_int_equal(desc->width, 123);
    assert_string_equal(desc->definitions, "wide=12 unit=3");
    scene_desc_destroy(desc);
    desc = good(NEW("<default name=\"wide\" value=\"7\"/>" FILM("$wide")));
    assert_int_equal(desc->width, 7);
    assert_null(desc->definitions);
    scene_desc_destroy(desc);
}

static void test_bad_definitions(void **state)
{
    (void)state;
    static const struct {
        const char *name, *first, *second, *expected;
    } rows[] = {
        {"scene.xml", "wide=1", "wied=1",
         "unknown parameter \"wied\"; did you mean \"wide\"?"},
        {"scene.xml", "wide", NULL, "'wide' defines nothing: NAME=VALUE is wanted"},
        {"scene.xml", "=1", NULL, "defines nothing"},
        {"scene.xml", "a b=1", "wide=2", "unknown parameter \"a b\""},
        {"scene.xml", "wide=1", "wide=2", "'wide=2' is defined twice"},
        {"scene.pbrt", "wide=1", NULL, "only Mitsuba's files (.xml) have parameters"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const char *given[] = {rows[i].first, rows[i].second};
        struct err err = {0};
        assert_null(defined(rows[i].name, NEW(FILM("$wide")), given,
                            rows[i].second ? 2 : 1, &err));
        import_test_error_is(&err, rows[i].expected);
    }
}

/* -- within a comment is passed over, and places stay what they were. */
static void test_comments(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<!-- one -- two --- <shape type=\"disk\"/> --->\n<!----><!---->"
            "<!-- ------ -->\n<shape type=\"sphere\"/>"));
    assert_int_equal(desc->shape_count, 1);
    assert_int_equal(desc->shapes[0].place.line, 4);
    assert_int_equal(desc->shapes[0].place.col, 1);
    scene_desc_destroy(desc);
    import_test_bad("scene.xml", NEW("<!-- no -- end\n<shape type=\"sphere\"/>"),
                    "not well-formed XML");
}

/* A second name for an id, wherever it stands. */
static void test_alias(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<alias id=\"a\" as=\"b\"/><shape type=\"sphere\"><ref id=\"b\"/></shape>"
            "<bsdf type=\"plastic\" id=\"a\"/>"));
    assert_string_equal(front(desc, 0)->type->name, "plastic");
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
    import_test_bad("scene.xml", NEW("<alias id=\"a\" as=\"b\"/>"),
                    "scene.xml:2:1: unknown id \"a\"");
    import_test_bad("scene.xml", NEW("<alias id=\"a\"/>"), "<alias> wants id and as");
    import_test_bad("scene.xml",
                    NEW("<bsdf type=\"null\" id=\"a\"/>\n<alias id=\"a\" as=\"a\"/>"),
                    "the id \"a\" is taken");
}

/* Of what moves the start is taken. */
static void test_animation(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        OLD("<shape type=\"sphere\"><animation name=\"toWorld\"><transform time=\"0\">"
            "<translate x=\"1\"/></transform><transform time=\"1\"><translate "
            "x=\"2\"/></transform></animation></shape>"));
    import_test_near(desc->shapes[0].to_world.m[0][3], 1.0, 1e-12);
    import_test_note(desc, "of an <animation> only the start is used", 1, 2);
    scene_desc_destroy(desc);
    import_test_bad("scene.xml",
                    OLD("<shape type=\"sphere\"><animation name=\"toWorld\"/></shape>"),
                    "scene.xml:2:22: this <animation> holds no <transform>");
}

/* What is known and not read says so, and what stands in its place. */
static void test_left_out(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"ellipsoids\"/><emitter type=\"volumelight\"/>"
            "<shape type=\"merge\"><shape type=\"sphere\"/><shape type=\"disk\"><bsdf "
            "type=\"diffuse\"><texture type=\"gridtexture\" name=\"reflectance\"/></bsdf>"
            "</shape></shape>"));
    assert_int_equal(desc->shape_count, 2);
    import_test_note(desc, "shape \"ellipsoids\" is not read yet and left out", 1, 2);
    import_test_note(desc, "emitter \"volumelight\" is not read yet and left out", 1, 2);
    import_test_note(desc, "texture \"gridtexture\" is not read yet: a grey of .5", 1, 2);
    assert_string_equal(desc->lost_light, "emitter \"volumelight\"");
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definitions), cmocka_unit_test(test_bad_definitions),
        cmocka_unit_test(test_comments),    cmocka_unit_test(test_alias),
        cmocka_unit_test(test_animation),   cmocka_unit_test(test_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
