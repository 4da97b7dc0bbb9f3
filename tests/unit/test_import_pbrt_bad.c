/* import/pbrt/import_pbrt: what is wrong in a file, by its exact place. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_test.h"

struct row {
    const char *text, *expected;
};

static void all_bad(const struct row *rows, size_t count)
{
    for (size_t i = 0; i < count; i++)
        import_test_bad("scene.pbrt", rows[i].text, rows[i].expected);
}

#define ALL_BAD(rows) all_bad(rows, sizeof rows / sizeof rows[0])

static void test_structure(void **state)
{
    static const struct row rows[] = {
        {"", "scene.pbrt:1:1: the file has no WorldBegin"},
        {"WorldBegin\nMaterial \"matte\"\n",
         "scene.pbrt:3:1: the file ends before the WorldEnd of the WorldBegin in line 1"},
        {"WorldBegin AttributeEnd", ":1:12: AttributeEnd without AttributeBegin"},
        {"WorldBegin AttributeBegin TransformEnd",
         ":1:27: TransformEnd closes the AttributeBegin of line 1"},
        {"WorldBegin\n TransformBegin\nAttributeEnd",
         ":3:1: AttributeEnd closes the TransformBegin of line 2"},
        {"WorldBegin\n AttributeBegin\nWorldEnd", ":2:2: this Begin is still open"},
        {"AttributeBegin WorldBegin", ":1:1: this Begin is still open at WorldBegin"},
        {"WorldBegin WorldEnd\nWorldBegin",
         ":2:1: WorldBegin after WorldEnd: one picture in a file"},
        {"WorldBegin Camera \"perspective\"", ":1:12: Camera belongs before WorldBegin"},
        {"Shape \"sphere\"", ":1:1: Shape belongs after WorldBegin"},
        {"WorldBegin Shpae \"sphere\"",
         ":1:12: unknown directive \"Shpae\"; did you mean \"Shape\"?"},
        {"WorldBegin \"sphere\"", ":1:12: expected a directive, got \"sphere\""},
        {"WorldBegin 7", ":1:12: expected a directive, got 7"},
        {"WorldBegin ObjectBegin \"o\" ObjectBegin \"p\"", ":1:28: ObjectBegin inside"},
        {"WorldBegin ObjectEnd", ":1:12: ObjectEnd without ObjectBegin"},
        {"WorldBegin ObjectInstance \"o\"", ":1:27: unknown object \"o\""},
        {"WorldBegin Include \"none.pbrt\"", "scene.pbrt:1:20: "},
        {"WorldBegin Include \"scene.pbrt\"", "includes itself"},
    };
    (void)state;
    ALL_BAD(rows);
}

static void test_transforms(void **state)
{
    static const struct row rows[] = {
        {"Translate 1 2", ":1:14: expected number 3 of 3, got the end of the file"},
        {"Translate 1 x 2", ":1:13: expected number 2 of 3, got x"},
        {"\nScale 1 0 1 Camera \"perspective\"", ":2:1: this transform has no inverse"},
        {"Rotate 30 0 0 0", ":1:1: Rotate wants an axis"},
        {"LookAt 1 1 1 1 1 1 0 1 0", ":1:1: LookAt: eye and target coincide"},
        {"LookAt 0 0 0 0 1 0 0 1 0", ":1:1: LookAt: eye and target coincide, or up"},
        {"Transform [1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1] Camera \"perspective\"",
         ":1:1: this transform has no inverse, and a perspective stands under it"},
        {"Transform [1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 5]", ":1:44: expected ], got 5"},
        {"CoordSysTransform \"camra\"", ":1:19: unknown coordinate system \"camra\""},
    };
    (void)state;
    ALL_BAD(rows);
}

static void test_options(void **state)
{
    static const struct row rows[] = {
        {"Camera \"perspectiv\"", ":1:8: unknown camera \"perspectiv\"; did you mean"},
        {"Camera \"realistic\"", ":1:8: camera \"realistic\" is not read yet"},
        {"Camera \"perspective\" \"float fov\" 180", ":1:8: fov 180 is not between"},
        {"Camera \"perspective\" \"float screenwindow\" [1 -1 -1 1]",
         ":1:22: \"float screenwindow\" wants x0 < x1"},
        {"Camera \"perspective\" \"float lensradius\" -1", ":1:8: lensradius"},
        {"Film \"image\" \"integer xresolution\" 0", ":1:1: a film of 0 x 720 pixels"},
        {"Film \"image\" \"float cropwindow\" [0 1]",
         ":1:14: \"float cropwindow\" wants 4"},
        {"Film \"imge\"", ":1:6: unknown film \"imge\"; did you mean \"image\"?"},
        {"Integrator \"bpdt\"", ":1:12: unknown integrator \"bpdt\"; did you mean"},
        {"Integrator \"path\" \"integer maxdepth\" -2", ":1:12: maxdepth -2 is out of"},
        {"PixelFilter \"bax\"", ":1:13: unknown filter \"bax\"; did you mean \"box\"?"},
    };
    (void)state;
    ALL_BAD(rows);
}

static void test_world(void **state)
{
#define IN(body) "WorldBegin\n" body "\nWorldEnd"
#define TWICE(name, part)                                              \
    "MakeNamedMaterial \"" name "\" \"string type\" \"mix\" \"string " \
    "materials\" [\"" part "\" \"" part "\"] "
    static const struct row rows[] = {
        {IN("Material \"mate\""), ":2:10: unknown material \"mate\"; did you mean"},
        {IN("Material \"mix\""), ":2:1: a mix wants \"string namedmaterial1\""},
        {IN("Material \"matte\" \"rgb Kd\" [1.5 0 0]"), ":2:"},
        {IN("Material \"matte\" \"texture Kd\" \"wood\""),
         ":2:18: unknown texture \"wood\""},
        {IN("Material \"glass\" \"float eta\" 0"), ":2:"},
        {IN("MakeNamedMaterial \"a\" \"rgb Kd\" [1 1 1]"),
         ":2:1: MakeNamedMaterial wants \"string type\""},
        {IN("MakeNamedMaterial \"Chrome\" \"string type\" \"mirror\" Material "
            "\"mix\" \"string namedmaterial1\" \"Crome\""),
         ":2:66: unknown named material \"Crome\"; did you mean \"Chrome\"?"},
        {IN("Material \"mix\" \"string materials\" [\"a\"]"),
         ":2:16: \"string materials\" of a mix holds 1 names, two are wanted"},
        {IN("Material \"mix\" \"string materials\" [\"a\" \"b\"]"),
         ":2:16: unknown named material \"a\""},
        {IN("MakeNamedMaterial \"1\" \"string type\" \"matte\" " TWICE("2", "1")
                TWICE("3", "2") TWICE("4", "3") TWICE("5", "4") TWICE("6", "5")
                    TWICE("7", "6") TWICE("8", "7") "\n" TWICE("9", "8")),
         ":3:23: blend: a blend of blends with 511 materials in all, the limit is 256"},
        {IN("Material \"matte\" \"string Kd\" [\"a\" \"b\"]"),
         ":2:35: expected one string here, this is another"},
        {IN("Texture \"t\" \"float\" \"imagemap\""),
         ":2:1: Texture \"imagemap\" wants \"string filename\""},
        {IN("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"/tmp\""),
         ":2:32: cannot read '/tmp': not a regular file but a directory"},
        {IN("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" "
            "\"string wrap\" \"repaet\""),
         ":2:58: unknown wrap \"repaet\"; did you mean \"repeat\"?"},
        {IN("Texture \"t\" \"flaot\" \"constant\""), ":2:13: unknown kind of texture"},
        {IN("Texture \"t\" \"float\" \"constant\" Material \"matte\" \"texture Kd\" "
            "\"t\""),
         ":2:49: texture \"t\" holds numbers, a colour is wanted"},
        {IN("AreaLightSource \"difuse\""), ":2:17: unknown area light \"difuse\""},
        {IN("LightSource \"distant\" \"point to\" [0 0 0]"),
         ":2:1: the light shines nowhere: from and to coincide"},
        {IN("LightSource \"pint\""), ":2:13: unknown light \"pint\"; did you mean"},
        {IN("Shape \"spher\""),
         ":2:7: unknown shape \"spher\"; did you mean \"sphere\"?"},
        {IN("Shape \"loopsubdiv\""), ":2:1: Shape \"loopsubdiv\" wants"},
        {IN("Shape \"loopsubdiv\" \"point P\" [0 0 0 1 0 0 0 1 0 0 0 1 1 1 1] "
            "\"integer indices\" [0 1 2 1 0 3 0 1 4]"),
         ":2:62: no surface: an edge of more than two triangles"},
        {IN("Shape \"sphere\" \"float radius\" 0"), ":2:1: the radius is not positive"},
        {IN("Shape \"cylinder\" \"float zmin\" 2"), ":2:1: zmin is not below zmax"},
        {IN("Shape \"plymesh\""), ":2:1: Shape \"plymesh\" wants \"string filename\""},
        {IN("Shape \"plymesh\" \"string filename\" \"no.ply\""), "scene.pbrt:2:17: "},
        {IN("Shape \"trianglemesh\" \"point P\" [0 0 0]"), ":2:1: Shape \"triangle"},
        {IN("Shape \"trianglemesh\" \"point P\" [0 0 0] \"integer indices\" [0 0]"),
         ":2:40: 2 indices make no whole triangles"},
        {IN("Shape \"trianglemesh\" \"point P\" [0 0 0] \"integer indices\" [0 0 1]"),
         ":2:40: index 1 is outside the mesh's 1 points"},
        {IN("Shape \"trianglemesh\" \"point P\" [0 0 0] \"integer indices\" [0 -1 0]"),
         ":2:40: index -1 is outside"},
        {IN("Shape \"trianglemesh\" \"point P\" [0 0 0] \"integer indices\" [0 0 0] "
            "\"normal N\" [0 0 1 0 0 1]"),
         ":2:66: 6 numbers do not fit the mesh's points, 3 are wanted"},
        {IN("AreaLightSource \"diffuse\" \"spectrum L\" [500 1 400 2]"),
         ":2:27: \"spectrum L\" wants pairs of a rising wavelength"},
        {IN("AreaLightSource \"diffuse\" \"spectrum L\" \"no.spd\""), ":2:27: "},
    };
    (void)state;
    ALL_BAD(rows);
}

static void test_endings(void **state)
{
    (void)state;
    import_test_bad("scene.xmll", "", "no kind of scene that is read: .yaml");
    struct err err = {0};
    assert_null(import_scene(import_test_path("absent.pbrt"), NULL, &err));
    import_test_error_is(&err, "absent.pbrt");
    assert_int_equal(err.code, ERR_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_structure), cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_options),   cmocka_unit_test(test_world),
        cmocka_unit_test(test_endings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
