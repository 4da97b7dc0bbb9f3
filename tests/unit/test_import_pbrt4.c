/* import/pbrt: what pbrt v4 has that v3 has not, and what it means otherwise. Values are
 * those of the format's page, or follow from it. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "scene/light.h"
#include "support/import_test.h"

#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define PI     3.14159265358979323846
#define SPHERE "Shape \"sphere\"\n"

static struct scene_desc *scene_of(const char *before, const char *body, const char *end)
{
    struct text text = {0};
    text_append(&text, "%s\nWorldBegin\n%s\n%s", before, body, end);
    struct scene_desc *desc = import_test_good("scene.pbrt", text.data);
    mem_free(text.data);
    return desc;
}

static struct scene_desc *v4(const char *body)
{
    return scene_of("Camera \"perspective\" Film \"rgb\" PixelFilter \"box\"", body, "");
}

static struct scene_desc *v3(const char *body)
{
    return scene_of("Camera \"perspective\" Film \"image\"", body, "WorldEnd");
}

static void is_rgb(struct rgb value, double r, double g, double b, double tolerance)
{
    import_test_near(value.r, r, tolerance);
    import_test_near(value.g, g, tolerance);
    import_test_near(value.b, b, tolerance);
}

static const double *of_first(const struct scene_desc *desc, const char *name)
{
    return import_test_param(desc, desc->shapes[0].material, name);
}

static const char *kind_of_first(const struct scene_desc *desc)
{
    return desc->materials[desc->shapes[0].material].type->name;
}

/* v4's world ends with its file; where nothing tells the version, a v3 material does. */
static void test_end(void **state)
{
    (void)state;
    struct scene_desc *desc = v4(SPHERE SPHERE);
    assert_int_equal(desc->shape_count, 2);
    scene_desc_destroy(desc);
    desc = scene_of("", SPHERE, "");
    assert_int_equal(desc->shape_count, 1);
    scene_desc_destroy(desc);
    import_test_bad(
        "scene.pbrt", "Film \"image\"\nWorldBegin\n" SPHERE,
        ":4:1: the file ends before the WorldEnd of the WorldBegin in line 2");
    import_test_bad("scene.pbrt", "WorldBegin\nMaterial \"matte\"",
                    ":2:17: the file ends before the WorldEnd");
    import_test_bad("scene.pbrt", "Film \"rgb\" WorldBegin\n AttributeBegin\n" SPHERE,
                    ":2:2: this Begin is still open at the end of the file");
}

static void test_settings(void **state)
{
    (void)state;
    struct scene_desc *desc = scene_of(
        "Option \"bool disablepixeljitter\" true\n"
        "Option \"integer seed\" 3 ColorSpace \"rec2020\"\n"
        "Option \"bool forcediffuse\" false\n"
        "Film \"rgb\"",
        SPHERE, "");
    import_test_note(desc, "the option \"disablepixeljitter\" is not used", 1, 1);
    assert_int_equal(desc->log.count, 3); /* and no camera */
    scene_desc_destroy(desc);
    import_test_bad("scene.pbrt", "Option \"bool disablepixeljiter\" true WorldBegin",
                    ":1:8: unknown option \"disablepixeljiter\"; did you mean");
    import_test_bad("scene.pbrt", "Option WorldBegin",
                    ":1:1: Option wants one parameter");
    import_test_bad("scene.pbrt", "ColorSpace \"rgb\" WorldBegin",
                    ":1:12: unknown colour space \"rgb\"");
    import_test_bad("scene.pbrt", "Attribute \"shap\" WorldBegin",
                    ":1:11: unknown kind of Attribute \"shap\"; did you mean \"shape\"");
}

/* Its parameters serve what follows, in its block, unless that says otherwise. */
static void test_attribute(void **state)
{
    (void)state;
    struct scene_desc *desc = v4(
        "AttributeBegin Attribute \"shape\" \"float radius\" 3\n"
        "Attribute \"material\" \"rgb reflectance\" [.1 .2 .3] Material \"diffuse\"\n"
        "Attribute \"shape\" \"float radius\" 4 \"string unknown\" \"x\"\n" SPHERE
        "Shape \"sphere\" \"float radius\" 5 AttributeEnd " SPHERE);
    assert_true(desc->shapes[0].radius == 4.0 && desc->shapes[1].radius == 5.0);
    assert_true(desc->shapes[2].radius == 1.0);
    assert_true(of_first(desc, "reflectance")[1] == 0.2);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* v3 scopes names to blocks, v4 does not. */
static void test_scope(void **state)
{
    static const char body[] =
        "AttributeBegin MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string "
        "namedmaterial1\" \"a\" \"string namedmaterial2\" \"a\" AttributeEnd\n"
        "NamedMaterial \"m\" " SPHERE;
    static const char made[] = "MakeNamedMaterial \"a\" \"string type\" \"mirror\"\n";
    char text[600];
    (void)state;
    snprintf(text, sizeof text, "%s%s", made, body);
    struct scene_desc *desc = v3(text);
    import_test_note(desc, "unknown named material \"m\"", 1, 5);
    scene_desc_destroy(desc);
    desc = v4(text);
    assert_string_equal(kind_of_first(desc), "blend");
    scene_desc_destroy(desc);
}

/* Import leaves the state as it was, Include does not. */
static void test_import_of_files(void **state)
{
    (void)state;
    import_test_write("part.pbrt", "Translate 5 0 0 Material \"conductor\" " SPHERE);
    struct scene_desc *desc = v4("Import \"part.pbrt\" " SPHERE "Include \"part.pbrt\" "
                                 "Import \"part.pbrt\"");
    static const double x[] = {5.0, 0.0, 5.0, 10.0};
    assert_int_equal(desc->shape_count, 4);
    for (int i = 0; i < 4; i++)
        assert_true(desc->shapes[i].to_world.m[0][3] == x[i]);
    assert_string_equal(desc->materials[desc->shapes[1].material].type->name, "diffuse");
    scene_desc_destroy(desc);
    import_test_write("open.pbrt", "AttributeBegin " SPHERE);
    import_test_bad("scene.pbrt", "Film \"rgb\" WorldBegin\n Import \"open.pbrt\"",
                    ":2:2: the imported file closes a Begin that it did not open, or");
}

static void test_packed_include(void **state)
{
    (void)state;
    gzFile f = gzopen(import_test_path("part.pbrt.gz"), "wb");
    assert_non_null(f);
    for (int i = 0; i < 3; i++)
        assert_true(gzputs(f, SPHERE) > 0);
    assert_int_equal(gzclose(f), Z_OK);
    struct scene_desc *desc = v4("Include \"part.pbrt.gz\"\n" SPHERE);
    assert_int_equal(desc->shape_count, 4);
    assert_int_equal(desc->shapes[2].place.line, 3);
    scene_desc_destroy(desc);
    import_test_write("bad.pbrt.gz", SPHERE);
    import_test_bad("scene.pbrt", "WorldBegin Include \"bad.pbrt.gz\"",
                    ":1:20: cannot unpack '");
}

/* What the scene's folder has not is sought in the current one. */
static void test_current_folder(void **state)
{
    char before[512];
    (void)state;
    assert_non_null(getcwd(before, sizeof before));
    import_test_write("here.pbrt", SPHERE);
    mkdir(import_test_path("sub"), 0777);
    const char *path = import_test_write("sub/scene.pbrt",
                                         "Film \"rgb\" WorldBegin Include \"here.pbrt\"");
    struct err err = {0};
    assert_null(import_scene(path, NULL, &err));
    assert_int_equal(chdir(import_test_path("")), 0);
    struct scene_desc *desc = import_scene(path, NULL, &err);
    assert_int_equal(chdir(before), 0);
    assert_non_null(desc);
    assert_int_equal(desc->shape_count, 1);
    scene_desc_destroy(desc);
}

/* Nothing moves: what holds at the start of the shutter counts. */
static void test_motion(void **state)
{
    (void)state;
    struct scene_desc *desc = scene_of(
        "TransformTimes 0 1 Film \"rgb\"",
        "AttributeBegin ActiveTransform EndTime Translate 1 0 0 Identity Scale 2 2 2\n"
        "ActiveTransform StartTime Translate 0 1 0\n"
        "ActiveTransform All Translate 0 0 1 " SPHERE "AttributeEnd " SPHERE,
        "");
    double(*m)[4] = desc->shapes[0].to_world.m;
    assert_true(m[0][3] == 0.0 && m[1][3] == 1.0 && m[2][3] == 1.0 && m[0][0] == 1.0);
    assert_true(desc->shapes[1].to_world.m[2][3] == 0.0);
    import_test_note(desc, "a transform of EndTime is left out", 3, 3);
    scene_desc_destroy(desc);
    import_test_bad("scene.pbrt", "ActiveTransform \"All\"",
                    ":1:17: expected StartTime, EndTime or All, got \"All\"");
    import_test_bad("scene.pbrt", "TransformTimes 1", ":1:17: expected number 2 of 2");
}

/* A matrix without an inverse is an error where something stands under it, only. */
static void test_singular(void **state)
{
    (void)state;
    struct scene_desc *desc = v3(
        "AttributeBegin Scale 1 0 1 AttributeEnd TransformBegin Transform [0 0 0 0 0 0 0 "
        "0 0 0 0 0 0 0 0 1] Translate 1 1 1 TransformEnd\n" SPHERE
        "Scale 0 0 0 Identity " SPHERE);
    assert_int_equal(desc->shape_count, 2);
    scene_desc_destroy(desc);
    import_test_bad(
        "scene.pbrt", "WorldBegin\n Scale 1 0 1\nTranslate 1 1 1\n" SPHERE,
        ":2:2: this transform has no inverse, and a sphere stands under it in "
        "line 4");
    import_test_bad("scene.pbrt",
                    "WorldBegin ConcatTransform [1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1]\n"
                    "LightSource \"point\"",
                    ":1:12: this transform has no inverse");
}

static void test_media(void **state)
{
    (void)state;
    struct scene_desc *desc = v3(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
        "MediumInterface \"fog\" \"\" " SPHERE "MediumInterface \"fog\" " SPHERE);
    assert_int_equal(desc->shape_count, 2);
    import_test_note(desc, "media are left out", 3, 3);
    scene_desc_destroy(desc);
}

static struct rgb intensity(const char *parameters)
{
    char text[400];
    snprintf(text, sizeof text, "LightSource \"infinite\" %s", parameters);
    struct scene_desc *desc = v4(text);
    struct rgb value = desc->lights[0].intensity;
    scene_desc_destroy(desc);
    return value;
}

/* Spectra of lights are scaled to luminance 1, colours are not. */
static void test_light_colours(void **state)
{
    (void)state;
    is_rgb(intensity("\"rgb L\" [2 3 4] \"float scale\" 2"), 4, 6, 8, 1e-12);
    is_rgb(intensity("\"spectrum L\" \"stdillum-D65\" \"float scale\" .5"), .5, .5, .5,
           1e-3);
    is_rgb(intensity("\"blackbody L\" 6500"), 1, 1, 1, 0.06);
    import_test_near(rgb_luminance(intensity("\"blackbody L\" [2700]")), 1.0, 1e-4);
    assert_true(intensity("\"blackbody L\" 2700").r > 3.0 * intensity("\"blackbody L\" "
                                                                      "2700")
                                                                .b);
    import_test_near(rgb_luminance(intensity("\"spectrum L\" [300 7 900 7]")), 1.0, 1e-4);
    assert_true(intensity("\"spectrum L\" \"stdillum-A\"").b < 0.35);
    struct scene_desc *cold = v4("LightSource \"infinite\" \"blackbody L\" 1e-300");
    import_test_note(cold, "a light of no intensity", 1, 3);
    scene_desc_destroy(cold);
    struct scene_desc *desc = v3("LightSource \"infinite\" \"spectrum L\" [300 7 900 7]");
    import_test_near(rgb_luminance(desc->lights[0].intensity), 7.0, 0.01);
    scene_desc_destroy(desc);
}

/* A constant reflectance is grey in v4 and the white of equal energy in v3. */
static void test_neutral_white(void **state)
{
    static const char body[] =
        "Material \"diffuse\" \"spectrum reflectance\" [400 .5 700 .5] " SPHERE;
    (void)state;
    struct scene_desc *desc = v4(body);
    const double *v = of_first(desc, "reflectance");
    is_rgb(rgb(v[0], v[1], v[2]), 0.5, 0.5, 0.5, 1e-12);
    scene_desc_destroy(desc);
    desc = v3(body);
    v = of_first(desc, "reflectance");
    is_rgb(rgb(v[0], v[1], v[2]), 0.6024, 0.4741, 0.4545, 0.01);
    scene_desc_destroy(desc);
}

/* rec2020's red lies outside of Rec. 709; whites stay white. ACES's white is warmer, as
 * light, and white as a reflectance. */
static void test_colour_space(void **state)
{
    (void)state;
    struct scene_desc *desc = v4(
        "ColorSpace \"rec2020\" LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
        "LightSource \"infinite\" \"rgb L\" [1 0 0]\n"
        "ColorSpace \"aces2065-1\" LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] " SPHERE);
    is_rgb(desc->lights[0].intensity, 1, 1, 1, 1e-3);
    is_rgb(desc->lights[1].intensity, 1.6605, 0, 0, 1e-3); /* ITU-R BT.2087 */
    assert_true(desc->lights[2].intensity.r > 1.03 && desc->lights[2].intensity.b < 0.95);
    const double *v = of_first(desc, "reflectance");
    is_rgb(rgb(v[0], v[1], v[2]), 0.5, 0.5, 0.5, 1e-12);
    scene_desc_destroy(desc);
}

static double radiance(const char *light, const char *shape)
{
    char text[500];
    snprintf(text, sizeof text, "AreaLightSource \"diffuse\" %s Shape %s", light, shape);
    struct scene_desc *desc = v4(text);
    double value = desc->shapes[0].radiance.g;
    scene_desc_destroy(desc);
    return value;
}

static double measured(const char *light)
{
    char text[500];
    snprintf(text, sizeof text, "LightSource %s", light);
    struct scene_desc *desc = v4(text);
    double value = desc->lights[0].intensity.g;
    scene_desc_destroy(desc);
    return value;
}

/* "power" is the flux, "illuminance" what a patch that faces the light gets; rgb and
 * scale remain factors. */
static void test_power(void **state)
{
    (void)state;
    import_test_near(measured("\"point\" \"float power\" 12 \"rgb I\" [2 2 2]"),
                     2.0 * 12.0 / (4.0 * PI), 1e-9);
    import_test_near(measured("\"goniometric\" \"float power\" 12"), 12.0 / (4.0 * PI),
                     1e-9);
    double edge = 0.5 * (cos(PI / 9.0) + cos(PI / 6.0));
    import_test_near(measured("\"spot\" \"float power\" 12 \"float conedeltaangle\" 10"),
                     12.0 / (2.0 * PI * (1.0 - edge)), 1e-9);
    import_test_near(measured("\"distant\" \"float illuminance\" 3 \"float scale\" 2"),
                     6.0, 1e-12);
    import_test_near(measured("\"infinite\" \"float illuminance\" 3"), 3.0 / PI, 1e-12);
    import_test_near(radiance("\"float power\" 8", "\"sphere\" \"float radius\" 2"),
                     8.0 / (PI * 16.0 * PI), 1e-9);
    import_test_near(radiance("\"float power\" 8 \"bool twosided\" true",
                              "\"disk\" \"float radius\" 2"),
                     8.0 / (2.0 * PI * 4.0 * PI), 1e-9);
    import_test_near(radiance("\"float power\" 8", "\"trianglemesh\" \"point3 P\" "
                                                   "[0 0 0 2 0 0 0 1 0]"),
                     8.0 / PI, 1e-6);
    struct scene_desc *desc = v3("LightSource \"point\" \"float power\" 12");
    import_test_note(desc, "unused parameter \"float power\"", 1, 3);
    scene_desc_destroy(desc);
}

/* A v4 point light's `from` is in the light's own space. */
static void test_from(void **state)
{
    (void)state;
    struct scene_desc *desc = v4("Scale 2 2 2 Translate 1 0 0 LightSource \"point\" "
                                 "\"point3 from\" [0 1 0] LightSource \"spot\"");
    struct vec3 p = xform_point(&desc->lights[0].to_world, vec3(0, 0, 0));
    assert_true(p.x == 2.0f && p.y == 2.0f);
    assert_true(desc->lights[1].smooth);
    scene_desc_destroy(desc);
}

/* A white picture. */
static void write_map(const char *name, int width, int height)
{
    struct text text = {0};
    text_append(&text, "PF\n%d %d\n-1\n", width, height);
    for (int i = 0; i < width * height * 3; i++) {
        const float one = 1.0f;
        unsigned char bytes[sizeof one];
        memcpy(bytes, &one, sizeof one);
        text.data = mem_grow(text.data, &text.capacity, text.length + 5, 1);
        memcpy(text.data + text.length, bytes, sizeof one);
        text.length += sizeof one;
    }
    import_test_write_bytes(name, text.data, text.length);
    mem_free(text.data);
}

static void test_maps(void **state)
{
    (void)state;
    write_map("square.pfm", 64, 64);
    write_map("wide.pfm", 8, 4);
    struct scene_desc *desc = v4(
        "LightSource \"infinite\" \"string filename\" \"square.pfm\"\n"
        "LightSource \"infinite\" \"string filename\" \"wide.pfm\"\n"
        "LightSource \"infinite\" \"string mapname\" \"square.pfm\"\n"
        "LightSource \"infinite\" \"string filename\" \"square.pfm\" \"float "
        "illuminance\" 2\n");
    assert_true(desc->lights[0].map && desc->lights[0].octahedral);
    assert_true(desc->lights[1].map && !desc->lights[1].octahedral);
    assert_true(desc->lights[2].map && !desc->lights[2].octahedral);
    import_test_note(desc, "a map of 8 x 4 is read as longitude and latitude", 1, 4);
    import_test_near(desc->lights[3].intensity.g, 2.0 / PI, 0.003);
    scene_desc_destroy(desc);
}

/* A picture's own: inverted, of another encoding, on a lamp. */
static void test_pictures(void **state)
{
    (void)state;
    write_map("white.pfm", 2, 2);
    struct scene_desc *desc = v4(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"white.pfm\" "
        "\"bool invert\" true \"float scale\" .25 \"string encoding\" \"gamma 2\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
        "AreaLightSource \"diffuse\" \"string filename\" \"white.pfm\" \"float scale\" "
        "3 " SPHERE);
    const struct texture *texture = desc->materials[0].bound[0].texture;
    assert_non_null(texture);
    import_test_near(texture_eval_uv(texture, 0.3, 0.6).g, 0.75, 1e-6);
    import_test_near(desc->shapes[0].radiance.g, 3.0, 1e-6);
    import_test_near(
        radiance("\"string filename\" \"white.pfm\" \"float power\" 8", "\"disk\""),
        8.0 / (PI * PI), 1e-6);
    import_test_note(desc, "the encoding \"gamma 2\" of a picture is taken", 1, 3);
    assert_non_null(desc->shapes[0].emission);
    import_test_near(texture_eval_uv(desc->shapes[0].emission, 0.3, 0.6).g, 1.0, 1e-6);
    scene_desc_destroy(desc);
}

static double luminance_eta(const char *eta)
{
    char text[300];
    snprintf(text, sizeof text, "Material \"dielectric\" %s " SPHERE, eta);
    struct scene_desc *desc = v4(text);
    double value = *of_first(desc, "eta");
    scene_desc_destroy(desc);
    return value;
}

/* Catalogues give n at 546 and 588 nm; the eye's mean is between. */
static void test_glasses(void **state)
{
    (void)state;
    import_test_near(luminance_eta(""), 1.5, 1e-12);
    import_test_near(luminance_eta("\"float eta\" 1.7"), 1.7, 1e-12);
    import_test_near(luminance_eta("\"spectrum eta\" [200 3.5 900 3.3]"), 3.4, 0.01);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-BK7\""), 1.5180, 7e-4);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-BAF10\""), 1.6725, 3e-3);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-FK51A\""), 1.4876, 1e-3);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-LASF9\""), 1.854, 4e-3);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-F5\""), 1.676, 3e-3);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-F10\""), 1.732, 4e-3);
    import_test_near(luminance_eta("\"spectrum eta\" \"glass-F11\""), 1.790, 5e-3);
    struct scene_desc *desc = v4("Material \"dielectric\" \"spectrum eta\" "
                                 "\"glass-BK7\" " SPHERE);
    import_test_note(desc, "dispersion is left out", 1, 3);
    scene_desc_destroy(desc);
    import_test_bad("scene.pbrt",
                    "Film \"rgb\" WorldBegin\nMaterial \"dielectric\" \"spectrum eta\" "
                    "\"glass-BK8\"",
                    ":2:23: cannot open");
}

/* Straight-on reflectances of the metals, by colour; published ones of these data. */
static void test_metals(void **state)
{
    static const struct {
        const char *name;
        double r, g, b;
    } rows[] = {{"Ag", 0.97, 0.96, 0.93},     {"Al", 0.91, 0.915, 0.92},
                {"Au", 0.97, 0.79, 0.35},     {"Cu", 0.95, 0.65, 0.54},
                {"CuZn", 0.90, 0.77, 0.44},   {"MgO", 0.073, 0.074, 0.076},
                {"TiO2", 0.235, 0.243, 0.265}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[300];
        snprintf(
            text, sizeof text,
            "Material \"conductor\" \"spectrum eta\" \"metal-%s-eta\" \"spectrum k\" "
            "\"metal-%s-k\" " SPHERE,
            rows[i].name, rows[i].name);
        struct scene_desc *desc = v4(text);
        const double *eta = of_first(desc, "eta"), *k = of_first(desc, "k");
        const double expected[] = {rows[i].r, rows[i].g, rows[i].b};
        for (int c = 0; c < 3; c++) {
            double below = (eta[c] + 1.0) * (eta[c] + 1.0) + k[c] * k[c];
            import_test_near(1.0 - 4.0 * eta[c] / below, expected[c], 0.03);
        }
        scene_desc_destroy(desc);
    }
    struct scene_desc *desc = v4("Material \"conductor\" " SPHERE);
    import_test_near(of_first(desc, "eta")[0], 0.15, 0.1); /* copper */
    scene_desc_destroy(desc);
}

static void test_materials(void **state)
{
    (void)state;
    struct scene_desc *desc = v4(
        "Material \"conductor\" \"rgb reflectance\" [.5 .25 .04] " SPHERE);
    import_test_near(of_first(desc, "eta")[2], 1.0, 1e-12);
    /* k^2 / (4 + k^2) = .25 */
    import_test_near(of_first(desc, "k")[1], sqrt(4.0 / 3.0), 1e-9);
    scene_desc_destroy(desc);
    desc = v4("Material \"coatedconductor\" \"rgb conductor.eta\" [3 3 3] \"rgb "
              "conductor.k\" [6 6 6] \"float interface.roughness\" .04 \"float "
              "conductor.roughness\" .01 \"float interface.eta\" 1.5 " SPHERE);
    assert_string_equal(kind_of_first(desc), "roughconductor");
    import_test_near(*of_first(desc, "eta"), 2.0, 1e-9);
    import_test_near(*of_first(desc, "k"), 4.0, 1e-9);
    /* alphas .1 and .2: 2.25 .01 + .125 .04 */
    import_test_near(*of_first(desc, "alpha_u"), sqrt(0.0275), 1e-6);
    import_test_note(desc, "material \"coatedconductor\" is taken as its metal", 1, 3);
    assert_int_equal(desc->log.count, 1);
    scene_desc_destroy(desc);
    desc = v4("Material \"diffusetransmission\" \"rgb reflectance\" [.2 .4 .6] \"float "
              "scale\" .5 " SPHERE);
    assert_string_equal(kind_of_first(desc), "translucent");
    assert_true(of_first(desc, "reflectance")[2] == 0.3);
    assert_true(of_first(desc, "transmittance")[2] == 0.125);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
    desc = v4("Material \"measured\" \"string filename\" \"x.bsdf\" " SPHERE);
    import_test_note(desc, "material \"measured\" is taken as diffuse", 1, 3);
    scene_desc_destroy(desc);
    desc = v4("Material \"interface\" " SPHERE "Material \"coateddiffuse\" " SPHERE);
    assert_int_equal(desc->shape_count, 1);
    assert_string_equal(kind_of_first(desc), "plastic");
    import_test_note(desc, "the coat of a \"coateddiffuse\" absorbs nothing", 1, 4);
    scene_desc_destroy(desc);
}

/* Exposure: the time that the shutter is open, times iso / 100; v3 knows none. */
static void test_film(void **state)
{
    static const char lit[] = "LightSource \"point\"";
    (void)state;
    struct scene_desc *desc = scene_of(
        "Camera \"perspective\" \"float shutteropen\" 1 \"float shutterclose\" 1.5\n"
        "Film \"rgb\" \"float iso\" 400 \"string sensor\" \"canon_eos_5d\" \"float "
        "whitebalance\" 5000 \"float maxcomponentvalue\" 10 \"integer xresolution\" 100 "
        "\"integer yresolution\" 50 \"integer pixelbounds\" [10 30 0 50]\n"
        "PixelFilter \"gaussian\" \"float xradius\" 2 \"float sigma\" 1",
        lit, "");
    assert_true(desc->lights[0].intensity.g == 2.0);
    import_test_note(desc, "the sensor \"canon_eos_5d\" is taken", 1, 2);
    import_test_note(desc, "whitebalance is not used", 1, 2);
    import_test_note(desc, "maxcomponentvalue is not used", 1, 2);
    import_test_note(desc, "the filter \"gaussian\" is not used", 1, 3);
    assert_int_equal(desc->log.count, 4);
    assert_true(ceil(desc->camera.crop[0] * 100.0) == 10.0);
    assert_true(ceil(desc->camera.crop[1] * 100.0) == 30.0);
    assert_true(ceil(desc->camera.crop[3] * 50.0) == 50.0);
    scene_desc_destroy(desc);
    desc = scene_of("Camera \"perspective\" \"float shutterclose\" .5 Film \"image\"",
                    lit, "WorldEnd");
    assert_true(desc->lights[0].intensity.g == 1.0);
    scene_desc_destroy(desc);
    import_test_bad("scene.pbrt",
                    "Camera \"perspective\" \"float shutteropen\" 1 Film \"rgb\" "
                    "WorldBegin",
                    ":1:8: the shutter does not open");
    import_test_bad("scene.pbrt", "Film \"rgb\" \"float iso\" 0 WorldBegin",
                    ":1:1: iso and exposuretime must be positive");
    import_test_bad("scene.pbrt",
                    "Film \"rgb\" \"integer pixelbounds\" [1 2 3] WorldBegin",
                    ":1:12: \"integer pixelbounds\" wants 4 numbers");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_end),
        cmocka_unit_test(test_settings),
        cmocka_unit_test(test_attribute),
        cmocka_unit_test(test_scope),
        cmocka_unit_test(test_import_of_files),
        cmocka_unit_test(test_packed_include),
        cmocka_unit_test(test_current_folder),
        cmocka_unit_test(test_motion),
        cmocka_unit_test(test_singular),
        cmocka_unit_test(test_media),
        cmocka_unit_test(test_light_colours),
        cmocka_unit_test(test_neutral_white),
        cmocka_unit_test(test_colour_space),
        cmocka_unit_test(test_power),
        cmocka_unit_test(test_from),
        cmocka_unit_test(test_maps),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_glasses),
        cmocka_unit_test(test_metals),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
