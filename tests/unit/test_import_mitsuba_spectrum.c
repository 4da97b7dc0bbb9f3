/* import/mitsuba/mitsuba_rgb, mitsuba_spectrum, mitsuba_metal: what spectra and metals
 * become in RGB, by the rule of each version. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "scene/light.h"
#include "support/mitsuba_test.h"

#define DIFFUSE(colour) \
    "<shape type=\"rectangle\"><bsdf type=\"diffuse\">" colour "</bsdf></shape>"
#define LAMP(colour) "<emitter type=\"constant\">" colour "</emitter>"

static void near_rgb(const double *v, double r, double g, double b, double relative)
{
    import_test_near(v[0], r, relative * fabs(r));
    import_test_near(v[1], g, relative * fabs(g));
    import_test_near(v[2], b, relative * fabs(b));
}

static void reflectance_is(const char *text, double r, double g, double b)
{
    struct scene_desc *desc = good(text);
    near_rgb(front_param(desc, 0, "reflectance"), r, g, b, 2e-3);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

static void radiance_is(const char *text, double r, double g, double b)
{
    struct scene_desc *desc = good(text);
    assert_int_equal(desc->light_count, 1);
    near_rgb(&desc->lights[0].intensity.r, r, g, b, 0.01);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* A constant reflectance: neutral where it is seen under D65, as of Mitsuba 3.0.2, else
 * the colour of equal energy (CIE: 1.2048, .9483, .9088). */
static void test_white(void **state)
{
    (void)state;
#define HALF "<spectrum name=\"reflectance\" value=\"300:.5, 900:.5\"/>"
    reflectance_is(NEW(DIFFUSE(HALF)), 0.5, 0.5, 0.5);
    reflectance_is("<scene version=\"2.0.0\">" DIFFUSE(HALF) "</scene>", 0.5, 0.5, 0.5);
    struct scene_desc *desc = good(OLD(DIFFUSE(HALF)));
    near_rgb(front_param(desc, 0, "reflectance"), 0.6024, 0.47415, 0.4544, 0.01);
    scene_desc_destroy(desc);
    /* no more than all, in Mitsuba 3 */
    reflectance_is(
        NEW(DIFFUSE("<spectrum name=\"reflectance\" value=\"300:2, 900:2\"/>")), 1, 1, 1);
}

/* Emission is not weighted; a constant is purple but for Mitsuba 0.6. */
static void test_emission(void **state)
{
    (void)state;
    radiance_is(NEW(LAMP("<spectrum name=\"radiance\" value=\"300:2, 900:2\"/>")), 2.4096,
                1.8966, 1.8178);
    radiance_is(NEW(LAMP("<spectrum name=\"radiance\" value=\"2\"/>")), 2.4096, 1.8966,
                1.8178);
    radiance_is(OLD(LAMP("<spectrum name=\"radiance\" value=\"2\"/>")), 2, 2, 2);
    radiance_is(NEW(LAMP("<float name=\"radiance\" value=\"2\"/>")), 2, 2, 2);
}

/* Beyond its ends a spectrum is 0: half a spectrum, and the other half, are the whole. */
static void test_ends(void **state)
{
    (void)state;
    double sum[3] = {0};
    static const char *const parts[] = {"350:.2, 549.5:.2", "549.6:.2, 900:.2"};
    for (int i = 0; i < 2; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 NEW(DIFFUSE("<spectrum name=\"reflectance\" value=\"%s\"/>")), parts[i]);
        struct scene_desc *desc = good(text);
        for (int k = 0; k < 3; k++)
            sum[k] += fmax(0.0, front_param(desc, 0, "reflectance")[k]);
        scene_desc_destroy(desc);
    }
    import_test_near(sum[1], 0.2, 0.03); /* clamped parts make up for the rest */
    assert_true(sum[0] < 0.4 && sum[2] < 0.3);
}

/* Plugins: objects where a colour or a texture may stand, also by reference. */
static void test_plugins(void **state)
{
    (void)state;
    radiance_is(NEW(LAMP("<spectrum name=\"radiance\" type=\"d65\"><float name=\"scale\" "
                         "value=\"2\"/></spectrum>")),
                2, 2, 2);
    radiance_is(NEW(LAMP("<texture name=\"radiance\" type=\"d65\"><rgb name=\"color\" "
                         "value=\"1 2 3\"/></texture>")),
                1, 2, 3);
    radiance_is(NEW(LAMP("<spectrum name=\"radiance\" type=\"uniform\"><float "
                         "name=\"value\" value=\"3\"/></spectrum>")),
                3, 3, 3);
    radiance_is(NEW(LAMP("<spectrum name=\"radiance\" type=\"irregular\"><string "
                         "name=\"wavelengths\" value=\"300, 900\"/><string "
                         "name=\"values\" value=\"2, 2\"/></spectrum>")),
                2.4096, 1.8966, 1.8178);
    reflectance_is(
        NEW(DIFFUSE("<spectrum name=\"reflectance\" type=\"irregular\"><string "
                    "name=\"wavelengths\" value=\"300, 500, 900\"/><string "
                    "name=\"values\" value=\".3 .3 .3\"/></spectrum>")),
        0.3, 0.3, 0.3);
    reflectance_is(NEW(DIFFUSE("<spectrum name=\"reflectance\" type=\"regular\"><float "
                               "name=\"wavelength_min\" value=\"300\"/><float "
                               "name=\"wavelength_max\" value=\"900\"/><string "
                               "name=\"values\" value=\".3 .3 .3\"/></spectrum>")),
                   0.3, 0.3, 0.3);
    reflectance_is(NEW(DIFFUSE("<spectrum name=\"reflectance\" type=\"regular\"><string "
                               "name=\"range\" value=\"300, 900\"/><string "
                               "name=\"values\" value=\".3 .3\"/></spectrum>")),
                   0.3, 0.3, 0.3);
    reflectance_is(NEW("<texture type=\"srgb\" id=\"c\"><rgb name=\"color\" "
                       "value=\".1 .2 .3\"/></texture>" DIFFUSE(
                           "<ref name=\"reflectance\" id=\"c\"/>")),
                   0.1, 0.2, 0.3);
}

/* <spectrum> may hold a texture's plugin, whose parts may be spectra. */
static void test_texture(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW(DIFFUSE("<spectrum name=\"reflectance\" type=\"checkerboard\"><rgb "
                    "name=\"color0\" value=\".1\"/><spectrum name=\"color1\" "
                    "type=\"uniform\"><float name=\"value\" value=\".8\"/></spectrum>"
                    "</spectrum>")));
    const struct texture *texture = front(desc, 0)->bound[0].texture;
    assert_non_null(texture);
    import_test_near(texture_eval_uv(texture, 0.25, 0.25).g, 0.1, 1e-12);
    import_test_near(texture_eval_uv(texture, 0.75, 0.25).g, 0.8, 1e-12);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* Radiance of a black body, W/(m^2 sr nm), near its luminance's wavelength: Planck's law
 * at 555 nm and 5000 K is 12.7 kW; and both ways to write it. */
static void test_blackbody(void **state)
{
    (void)state;
    double green[2];
    static const char *const texts[] = {
        NEW(LAMP("<spectrum name=\"radiance\" type=\"blackbody\"><float "
                 "name=\"temperature\" value=\"5000\"/></spectrum>")),
        OLD(LAMP("<blackbody name=\"radiance\" temperature=\"5000K\" scale=\"2\"/>"))};
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = good(texts[i]);
        struct rgb v = desc->lights[0].intensity;
        assert_true(v.r > v.g && v.g > v.b);
        green[i] = rgb_luminance(v);
        assert_int_equal(desc->log.count, 0);
        scene_desc_destroy(desc);
    }
    import_test_near(green[0], 12.7e3, 0.3e3);
    import_test_near(green[1] / green[0], 2.0, 1e-9);
}

static void test_bad(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {DIFFUSE("<spectrum name=\"reflectance\" type=\"irregular\"><string "
                 "name=\"wavelengths\" value=\"300 900\"/><string name=\"values\" "
                 "value=\"1\"/></spectrum>"),
         "2 wavelengths for 1 values"},
        {DIFFUSE("<spectrum name=\"reflectance\" type=\"irregular\"/>"),
         "wants a list \"wavelengths\""},
        {DIFFUSE("<spectrum name=\"reflectance\" type=\"irregular\"><string "
                 "name=\"wavelengths\" value=\"900 300\"/><string name=\"values\" "
                 "value=\"1 1\"/></spectrum>"),
         "wants pairs of a rising wavelength"},
        {DIFFUSE("<spectrum name=\"reflectance\" type=\"regular\"><string "
                 "name=\"range\" value=\"900 300\"/><string name=\"values\" value=\"1 "
                 "1\"/></spectrum>"),
         "are no range"},
        {DIFFUSE("<spectrum name=\"reflectance\" type=\"regular\"><string "
                 "name=\"range\" value=\"300 900\"/><string name=\"values\" value=\"1\"/>"
                 "</spectrum>"),
         "wants two values or more"},
        {LAMP("<spectrum name=\"radiance\" type=\"blackbody\"/>"),
         "wants a positive temperature"},
        {LAMP("<blackbody name=\"radiance\" temperature=\"hot\"/>"),
         "wants a temperature like"},
        {LAMP("<spectrum name=\"radiance\" type=\"d65\" id=\"a\"><ref name=\"color\" "
              "id=\"a\"/></spectrum>"),
         "refers to itself"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[800];
        snprintf(text, sizeof text, NEW("%s"), rows[i][0]);
        import_test_bad("scene.xml", text, rows[i][1]);
    }
}

/* --- metals --------------------------------------------------------------------------
 */

static void metal_is(const char *name, const char *parameter, double r, double g,
                     double b)
{
    char text[400];
    snprintf(text, sizeof text,
             NEW("<shape type=\"disk\"><bsdf type=\"conductor\"><string "
                 "name=\"material\" value=\"%s\"/></bsdf></shape>"),
             name);
    struct scene_desc *desc = good(text);
    near_rgb(front_param(desc, 0, parameter), r, g, b, 0.02);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* The published measurement of TiN, integrated here, is what the table holds; an index is
 * reduced under equal energy, whatever the version. */
static void test_metal_measured(void **state)
{
    (void)state;
    struct scene_desc *desc = good(OLD(DIFFUSE(
        "<spectrum name=\"reflectance\" value=\"309.95:.227, 354.23:.214, 413.27:.174, "
        "495.92:.12, 619.9:.132, 826.53:.182\"/>")));
    double eta[3];
    for (int k = 0; k < 3; k++)
        eta[k] = 10.0 * front_param(desc, 0, "reflectance")[k];
    scene_desc_destroy(desc);
    metal_is("TiN", "eta", eta[0], eta[1], eta[2]);
}

static void test_metal_names(void **state)
{
    (void)state;
    static const char *const names[] = {
        "a-C",      "Ag",       "Al",     "AlAs", "AlSb", "Au",       "Be",       "Cr",
        "CsI",      "Cu",       "Cu2O",   "CuO",  "d-C",  "Hg",       "HgTe",     "Ir",
        "K",        "Li",       "MgO",    "Mo",   "Nb",   "Na_palik", "Ni_palik", "Rh",
        "Se-e",     "Se",       "SiC",    "SnTe", "Ta",   "Te-e",     "Te",       "ThF4",
        "TiC",      "TiN",      "TiO2-e", "TiO2", "VC",   "V_palik",  "VN",       "W",
        "Cu_palik", "Se_palik", "K_palik"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        static const char *const kinds[] = {"conductor", "roughconductor"};
        for (int k = 0; k < 2; k++) {
            char text[400];
            snprintf(text, sizeof text,
                     OLD("<shape type=\"disk\"><bsdf type=\"%s\"><string "
                         "name=\"material\" value=\"%s\"/></bsdf></shape>"),
                     kinds[k], names[i]);
            struct scene_desc *desc = good(text);
            assert_int_equal(desc->log.count, 0);
            scene_desc_destroy(desc);
        }
    }
    metal_is("W", "eta", 4.3707, 3.3003, 2.9983);
    metal_is("W", "k", 3.5007, 2.6049, 2.2732);
    metal_is("a-C", "eta", 2.9441, 2.2272, 1.9682);
    metal_is("Cu_palik", "eta", 0.2127, 0.92, 1.1024);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white),       cmocka_unit_test(test_emission),
        cmocka_unit_test(test_ends),        cmocka_unit_test(test_plugins),
        cmocka_unit_test(test_texture),     cmocka_unit_test(test_blackbody),
        cmocka_unit_test(test_bad),         cmocka_unit_test(test_metal_measured),
        cmocka_unit_test(test_metal_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
