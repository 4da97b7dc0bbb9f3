/* import/mitsuba/import_mitsuba: every way to be wrong has one line that names its place.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_test.h"

#include <sys/stat.h>
#include <unistd.h>

#define HEAD "<scene version=\"3.0.0\">\n"
#define TAIL "</scene>\n"

static void bad(const char *body, const char *expected)
{
    struct text text = {0};
    text_append(&text, HEAD "%s" TAIL, body);
    import_test_bad("scene.xml", text.data, expected);
    free(text.data);
}

static void test_xml(void **state)
{
    (void)state;
    import_test_bad("scene.xml", "", "scene.xml:1:1: not well-formed XML: no element");
    import_test_bad("scene.xml", "<scene version=\"3.0.0\">\n <a>\n</scene>",
                    "scene.xml:3:3: not well-formed XML: mismatched tag");
    import_test_bad("scene.xml", "<scene version=\"3.0.0\">\n <a b='1' b='2'/></scene>",
                    "scene.xml:2:11: not well-formed XML: duplicate attribute");
    import_test_bad("scene.xml", "<scene/><scene/>", "junk after document element");
    import_test_bad("scene.xml", "<html/>",
                    "scene.xml:1:1: this is no Mitsuba scene: the outermost element is "
                    "<html>");
    import_test_bad("scene.xml", "<scene version=\"next\"/>", "\"next\" is no version");
    import_test_bad("scene.xml",
                    "<!DOCTYPE scene [\n<!ENTITY a \"aaaa\">\n<!ENTITY b "
                    "\"&a;&a;\">]>\n<scene version=\"3.0\">&b;</scene>",
                    "scene.xml:2:12: the entity \"a\" is declared here");
}

static void test_depth(void **state)
{
    (void)state;
    struct text text = {0};
    text_append(&text, "%s", HEAD);
    for (int i = 0; i < 200000; i++)
        text_append(&text, "<a>");
    import_test_bad("scene.xml", text.data, "more than 100 elements inside one another");
    free(text.data);
}

static void test_references(void **state)
{
    (void)state;
    bad("<shape type=\"disk\" id=\"plate\"/>\n<shape type=\"disk\"><ref id=\"plat\"/>"
        "</shape>\n",
        "scene.xml:3:20: unknown id \"plat\"; did you mean \"plate\"?");
    bad("<shape type=\"disk\"><ref/></shape>", "scene.xml:2:20: <ref> wants an id");
    bad("<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>",
        "scene.xml:3:1: the id \"a\" is taken");
    bad("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>\n"
        "<shape type=\"disk\"><ref id=\"a\"/></shape>",
        "scene.xml:2:1: this <bsdf> refers to itself");
    bad("<bsdf type=\"mask\" id=\"a\"><bsdf type=\"mask\" id=\"b\"><ref id=\"a\"/>"
        "</bsdf></bsdf><shape type=\"disk\"><ref id=\"b\"/></shape>",
        "refers to itself");
    bad("<integrator type=\"aov\" id=\"a\"><ref id=\"a\"/></integrator>",
        "refers to itself");
    bad("<texture type=\"checkerboard\" id=\"a\"><ref name=\"color0\" id=\"a\"/>"
        "</texture>\n<shape type=\"disk\"><bsdf type=\"diffuse\"><ref "
        "name=\"reflectance\" id=\"a\"/></bsdf></shape>",
        "scene.xml:2:1: this <texture> refers to itself");
    bad("<default name=\"depth\" value=\"3\"/>\n<integrator type=\"path\"><integer "
        "name=\"max_depth\" value=\"$dept\"/></integrator>",
        "scene.xml:3:25: unknown parameter \"dept\"; did you mean \"depth\"?");
    bad("<default name=\"depth\"/>", "scene.xml:2:1: <default> wants a name and a value");
}

static void test_includes(void **state)
{
    char name[32], body[100];
    (void)state;
    bad("<include filename=\"absent.xml\"/>", "scene.xml:2:1: cannot open");
    bad("<include/>", "<include> wants a filename");
    bad(" <include filename=\"scene.xml\"/>", "scene.xml:2:2: ");
    import_test_write("a.xml", HEAD "<include filename=\"b.xml\"/>" TAIL);
    import_test_write("b.xml", HEAD "\n <include filename=\"a.xml\"/>" TAIL);
    bad("<include filename=\"a.xml\"/>", "b.xml:3:2: ");
    bad("<include filename=\"a.xml\"/>", "includes itself");
    for (int i = 0; i < 40; i++) {
        snprintf(name, sizeof name, "deep%d.xml", i);
        snprintf(body, sizeof body, HEAD "<include filename=\"deep%d.xml\"/>" TAIL,
                 i + 1);
        import_test_write(name, body);
    }
    bad("<include filename=\"deep0.xml\"/>", "more than 16 files include one another");
    assert_int_equal(symlink("loop.xml", import_test_path("loop.xml")), 0);
    bad("<include filename=\"loop.xml\"/>", "scene.xml:2:1: ");
    mkdir(import_test_path("folder.xml"), 0755);
    bad("<include filename=\"folder.xml\"/>", "scene.xml:2:1: ");
    import_test_write("broken.xml", HEAD "<a></b>");
    bad("<include filename=\"broken.xml\"/>", "broken.xml:2:6: not well-formed");
}

static void test_values(void **state)
{
    (void)state;
#define SENSOR(body) "<sensor type=\"perspective\">\n" body "</sensor>"
    bad(SENSOR("<float name=\"fov\" value=\"wide\"/>"),
        "scene.xml:3:1: \"wide\" in the value of <float> is not a number");
    bad(SENSOR("<float name=\"fov\" value=\"1e999\"/>"), "beyond the range of float");
    bad(SENSOR("<float name=\"fov\" value=\"\"/>"), "holds no number");
    bad(SENSOR("<float name=\"fov\"/>"), "<float> wants the attribute value");
    bad(SENSOR("<string name=\"fov\" value=\"3\"/>"), "wants <float>, this is <string>");
    bad(SENSOR("<float name=\"fov\" value=\"180\"/>"), "fov 180 is not between");
    bad(SENSOR("<float name=\"fov\" value=\"nan\"/>"), "is not a number");
    bad(SENSOR("<float name=\"fov\" value=\"3\"/><string name=\"fov_axis\" "
               "value=\"diagonl\"/>"),
        "scene.xml:3:30: unknown fov_axis \"diagonl\"; did you mean \"diagonal\"?");
    bad(SENSOR("<string name=\"focal_length\" value=\"long\"/>"), "no length");
    bad(SENSOR("<film type=\"hdrfilm\"><integer name=\"width\" value=\"0\"/></film>"),
        "scene.xml:3:1: a film of 0 x 576");
    bad(SENSOR("<film type=\"hdrfilm\"><integer name=\"width\" value=\"3.5\"/></film>"),
        "3.5 is no integer");
    bad(SENSOR("<film type=\"hdrfilm\"><integer name=\"crop_offset_x\" value=\"800\"/>"
               "</film>"),
        "crop_offset_x 800 and crop_width 0 do not lie within the film's 768 pixels");
    bad(SENSOR("<film type=\"hdrfilm\"><integer name=\"crop_height\" value=\"600\"/>"
               "</film>"),
        "crop_offset_y 0 and crop_height 600");
    bad("<sensor type=\"thinlens\"><float name=\"fov\" value=\"3\"/></sensor>",
        "wants an aperture_radius");
    bad("<sensor type=\"spherical\"/>", "is not read, only");
    bad("<sensor type=\"perspectiv\"/>", "did you mean \"perspective\"?");
    bad("<integrator type=\"path\"><integer name=\"max_depth\" value=\"-2\"/>"
        "</integrator>",
        "max_depth -2 is out of range");
    bad("<shape type=\"disk\"><boolean name=\"flip_normals\" value=\"yes\"/></shape>",
        "\"yes\" is neither true nor false");
    bad("<shape type=\"disk\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
        "value=\"1 2\"/></bsdf></shape>",
        "<rgb> wants 1 or 3 numbers, not 2");
    bad("<shape type=\"disk\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
        "value=\"500:1, 400:2\"/></bsdf></shape>",
        "pairs of a rising wavelength");
    bad("<shape type=\"disk\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
        "filename=\"absent.spd\"/></bsdf></shape>",
        "scene.xml:2:41: cannot open");
    bad("<shape type=\"disk\"><bsdf type=\"dielectric\"><string name=\"int_ior\" "
        "value=\"diamand\"/></bsdf></shape>",
        "did you mean \"diamond\"?");
    bad("<shape type=\"disk\"><bsdf type=\"twosided\"/></shape>",
        "scene.xml:2:20: bsdf \"twosided\" wants a <bsdf> in it");
#define MIXTURE(inside) \
    "<shape type=\"disk\"><bsdf type=\"mixturebsdf\">" inside "</bsdf></shape>"
#define WEIGHTS(value) "<string name=\"weights\" value=\"" value "\"/>"
    bad(MIXTURE("<bsdf type=\"diffuse\"/>"), "wants a string \"weights\"");
    bad(MIXTURE(WEIGHTS("1")), "wants a <bsdf> in it");
    bad(MIXTURE(WEIGHTS("1, 2") "<bsdf type=\"diffuse\"/>"), "2 weights for 1 materials");
    bad(MIXTURE(WEIGHTS("-1") "<bsdf type=\"diffuse\"/>"), "a weight is negative");
    bad(MIXTURE(WEIGHTS("half") "<bsdf type=\"diffuse\"/>"), "is not a number");
    bad("<emitter type=\"area\"/>", "belongs into a <shape>");
    bad("<emitter type=\"envmap\"/>", "wants a string \"filename\"");
    bad("<emitter type=\"directional\"><vector name=\"direction\" "
        "value=\"0\"/></emitter>",
        "no direction");
    bad("<emitter type=\"spot\"><float name=\"beam_width\" value=\"30\"/></emitter>",
        "beam_width 30 and cutoff_angle 20");
    bad("<shape type=\"disk\"><bsdf type=\"bumpmap\"><bsdf type=\"diffuse\"/></bsdf>"
        "</shape>",
        "wants a <texture> in it");
    bad("<shape type=\"disk\"><bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/></bsdf>"
        "</shape>",
        "wants two <bsdf> in it");
#define TWICE(name, part)                                                            \
    "<bsdf type=\"blendbsdf\" id=\"" name "\"><float name=\"weight\" value=\".5\"/>" \
    "<ref id=\"" part "\"/><ref id=\"" part "\"/></bsdf>"
    bad("<bsdf type=\"diffuse\" id=\"1\"/>" TWICE("2", "1") TWICE("3", "2")
            TWICE("4", "3") TWICE("5", "4") TWICE("6", "5") TWICE("7", "6") "\n" TWICE(
                "8", "7") "<shape type=\"disk\"><ref id=\"8\"/></shape>",
        "scene.xml:3:1: blend: a blend of blends with 383 materials in all");
    import_test_write("no.png", "picture");
    bad("<shape type=\"disk\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" "
        "type=\"bitmap\">\n<string name=\"filename\" value=\"no.png\"/></texture></bsdf>"
        "</shape>",
        "scene.xml:3:1: ");
    bad("<shape type=\"disk\"><bsdf type=\"twosided\"><bsdf type=\"dielectric\"/><bsdf "
        "type=\"diffuse\"/></bsdf></shape>",
        "belongs to both sides");
}

static void test_transforms(void **state)
{
    (void)state;
#define STEP(step) \
    "<shape type=\"disk\"><transform name=\"to_world\">\n" step "</transform></shape>"
    bad(STEP("<scale x=\"0\"/>"), "scene.xml:3:1: this <scale> has no inverse");
    bad(STEP("<matrix value=\"1 2 3\"/>"), "16 numbers by rows (or 9), not 3");
    bad(STEP("<matrix value=\"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1\"/>"), "has no inverse");
    bad(STEP("<rotate x=\"1\"/>"), "<rotate> wants the attribute angle");
    bad(STEP("<rotate angle=\"1\"/>"), "<rotate> wants an axis");
    bad(STEP("<lookat origin=\"0 0 0\" target=\"0 0 0\"/>"), "coincide");
    bad(STEP("<lookat origin=\"0 0 0\" target=\"0 0 1\" up=\"0 0 2\"/>"), "parallel");
    bad(STEP("<lookat origin=\"0 0\" target=\"0 0 1\"/>"), "the origin of <lookat>");
    bad(STEP("<skew x=\"1\"/>"), "<skew> is no step of a transform");
    bad("<shape type=\"disk\"><float name=\"to_world\" value=\"1\"/></shape>",
        "wants <transform>");
}

static void test_shapes(void **state)
{
    (void)state;
    static const char *const kinds[] = {"obj", "ply", "serialized"};
    char body[300], expected[100];
    for (int i = 0; i < 3; i++) {
        snprintf(body, sizeof body, "<shape type=\"%s\"/>", kinds[i]);
        snprintf(expected, sizeof expected,
                 "2:1: shape \"%s\" wants a string \"filename\"", kinds[i]);
        bad(body, expected);
        snprintf(body, sizeof body,
                 "<shape type=\"%s\">\n <string name=\"filename\" value=\"none\"/>"
                 "</shape>",
                 kinds[i]);
        bad(body, "scene.xml:3:2: cannot open");
        mkdir(import_test_path("folder.mesh"), 0755);
        snprintf(body, sizeof body,
                 "<shape type=\"%s\">\n <string name=\"filename\" "
                 "value=\"folder.mesh\"/></shape>",
                 kinds[i]);
        bad(body, "scene.xml:3:2: ");
    }
    import_test_write("huge.ply",
                      "ply\nformat ascii 1.0\nelement vertex 100000000\nproperty float "
                      "x\nproperty float y\nproperty float z\nelement face 1\nproperty "
                      "list uchar int vertex_indices\nend_header\n0 0 0\n");
    bad("<shape type=\"ply\"><string name=\"filename\" value=\"huge.ply\"/></shape>",
        "huge.ply");
    bad("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>",
        "the radius 0 is not positive");
    bad("<shape type=\"cylinder\"><point name=\"p1\" value=\"0 0 0\"/></shape>",
        "p0 and p1 coincide");
    import_test_write("far.obj", "v 3e38 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    bad("<shape type=\"obj\"><string name=\"filename\" value=\"far.obj\"/><transform "
        "name=\"to_world\"><scale value=\"10\"/></transform></shape>",
        "scene.xml:2:1: the position of vertex 0 is not finite");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_xml),        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_references), cmocka_unit_test(test_includes),
        cmocka_unit_test(test_values),     cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
