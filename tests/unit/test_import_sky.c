/* import/sky: sun and sky against what is known of them, the picture against its parts;
 * and how Mitsuba's and LuxRender's files ask for them. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "import/sky.h"
#include "scene/light.h"
#include "support/mitsuba_test.h"

static const double pi = 3.14159265358979323846;

static struct sky_options at(double degrees, double turbidity)
{
    double theta = degrees * pi / 180.0;
    return (struct sky_options){.sun = {sin(theta), 0.0, cos(theta)},
                                .turbidity = turbidity,
                                .sky_scale = 1.0,
                                .sun_scale = 1.0,
                                .sun_radius_scale = 1.0};
}

/* Irradiance of a plane across the sun's rays (direct) or of the ground, from the
 * picture. */
static struct rgb gather(const struct texture_image *image, const double *towards)
{
    struct rgb sum = rgb_grey(0.0);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            double theta = (y + 0.5) * pi / image->height;
            double phi = (x + 0.5) * 2.0 * pi / image->width;
            double cosine = sin(theta) * (cos(phi) * towards[0] + sin(phi) * towards[1]) +
                            cos(theta) * towards[2];
            double solid = 2.0 * pi / image->width *
                           (cos(y * pi / image->height) -
                            cos((y + 1) * pi / image->height));
            if (cosine > 0.0)
                sum = rgb_add(
                    sum, rgb_scale(texture_image_texel(image, x, y), cosine * solid));
        }
    return sum;
}

/* The sun of Mitsuba 0.5's own picture at 38.3 degrees from the zenith and turbidity 5
 * has the irradiance (1.106, .873, .669), of its texels' sum. */
static void test_sun(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct sky_options o = at(38.3203, 5.0);
    o.sky_scale = 0.0;
    for (double radius = 0.0; radius <= 4.0; radius += 2.0) {
        o.sun_radius_scale = radius;
        struct rgb e = gather(sky_picture(&set, &o), o.sun);
        import_test_near(e.r, 1.106, 0.02);
        import_test_near(e.g, 0.873, 0.02);
        import_test_near(e.b, 0.669, 0.02);
    }
    /* where the grid is finest: at the zenith */
    o = at(0.0, 5.0);
    o.sky_scale = 0.0;
    struct rgb radiance = sky_sun_radiance(&o);
    struct rgb e = gather(sky_picture(&set, &o), o.sun);
    import_test_near(e.g / radiance.g, 6.868e-5, 1e-6);
    texture_set_deinit(&set);
}

/* A low sun is red, and dimmer through haze. */
static void test_sunset(void **state)
{
    (void)state;
    struct sky_options noon = at(10.0, 3.0), evening = at(85.0, 3.0),
                       haze = at(10.0, 8.0);
    struct rgb a = sky_sun_radiance(&noon), b = sky_sun_radiance(&evening),
               c = sky_sun_radiance(&haze);
    assert_true(b.r / b.g > 1.5 * a.r / a.g && b.g < 0.5 * a.g && c.g < a.g);
}

/* The zenith has the luminance that the model's own formula gives: at turbidity 3, with
 * the sun at 45 degrees, (4.0453 T - 4.9710) tan((4/9 - T/120) pi/2) - .2155 T + 2.4192 =
 * 6.93 kcd/m^2; away from the sun it is blue, and black below the horizon. */
static void test_zenith(void **state)
{
    (void)state;
    struct texture_set set = {0};
    struct sky_options o = at(45.0, 3.0);
    o.sun_scale = 0.0;
    const struct texture_image *sky = sky_picture(&set, &o);
    struct rgb zenith = texture_image_texel(sky, 0, 0);
    double expected = (4.0453 * 3 - 4.9710) * tan((4.0 / 9.0 - 0.025) * pi / 2.0) -
                      0.2155 * 3 + 2.4192;
    double candelas = rgb_luminance(zenith) * 683.0 * 106.857;
    import_test_near(candelas / (1000.0 * expected), 1.0, 0.02);
    struct rgb away = texture_image_texel(sky, sky->width / 2, sky->height / 4);
    assert_true(away.b > 1.2 * away.r);
    assert_true(rgb_is_black(texture_image_texel(sky, 5, sky->height / 2 + 1)));
    o.ground = true;
    sky = sky_picture(&set, &o);
    assert_false(rgb_is_black(texture_image_texel(sky, 5, sky->height - 1)));
    texture_set_deinit(&set);
}

/* At the solstice's noon the sun stands over the tropic, but for the equation of time;
 * six hours later it sets in the west-north-west. */
static void test_time(void **state)
{
    (void)state;
    double sun[3];
    struct sky_time noon = {2010, 6, 21, 12.0, 0.0, 23.44, 0.0};
    sky_sun_direction(&noon, sun);
    assert_true(sun[2] > cos(0.6 * pi / 180.0));
    struct sky_time evening = {2010, 6, 21, 20.0, 2.0, 23.44, 0.0}; /* two hours fast */
    sky_sun_direction(&evening, sun);
    assert_true(sun[0] < -0.85 && sun[1] > 0.2 && fabs(sun[2]) < 0.2);
    struct sky_time south = {2010, 12, 21, 12.0, 0.0, 51.5, 0.0}; /* London: 15.1 high */
    sky_sun_direction(&south, sun);
    import_test_near(asin(sun[2]) * 180.0 / pi, 15.1, 0.2);
    assert_true(sun[1] < -0.9);
}

/* Where the brightest texel of an environment lies, in the world. */
static void brightest(const struct scene_desc *desc, double out[3])
{
    const struct light_desc *light = &desc->lights[0];
    assert_ptr_equal(light->type, &light_environment);
    const struct texture_image *map = light->map;
    double best = -1.0, d[3] = {0};
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            double value = texture_image_texel(map, x, y).g;
            double theta = (y + 0.5) * pi / map->height,
                   phi = (x + 0.5) * 2.0 * pi / map->width;
            if (value <= best)
                continue;
            best = value;
            d[0] = sin(theta) * cos(phi);
            d[1] = sin(theta) * sin(phi);
            d[2] = cos(theta);
        }
    for (int i = 0; i < 3; i++)
        out[i] = light->to_world.m[i][0] * d[0] + light->to_world.m[i][1] * d[1] +
                 light->to_world.m[i][2] * d[2];
}

static void sun_is(const char *name, const char *text, double x, double y, double z)
{
    double d[3], length = sqrt(x * x + y * y + z * z);
    struct scene_desc *desc = import_test_good(name, text);
    brightest(desc, d);
    import_test_near(d[0], x / length, 0.01);
    import_test_near(d[1], y / length, 0.01);
    import_test_near(d[2], z / length, 0.01);
    scene_desc_destroy(desc);
}

/* The sun shines from where the file says, in each format's axes. */
static void test_formats(void **state)
{
    (void)state;
    sun_is("scene.xml",
           NEW("<emitter type=\"sunsky\"><vector name=\"sun_direction\" x=\"1\" y=\"2\" "
               "z=\"3\"/></emitter>"),
           1, 2, 3);
    sun_is("scene.xml",
           OLD("<emitter type=\"sunsky\"><vector name=\"sunDirection\" x=\"1\" y=\"3\" "
               "z=\"2\"/></emitter>"),
           1, 3, 2);
    sun_is("scene.xml",
           OLD("<emitter type=\"sun\"><vector name=\"sunDirection\" x=\"1\" y=\"3\" "
               "z=\"2\"/><transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/>"
               "</transform></emitter>"),
           1, -2, 3);
    /* Tokyo, 10 July, 15:00: by the declination of 22.25 degrees and the hour angle of
     * 48.37 (equation of time -5.3 min) east, up and south are as here */
    sun_is("scene.xml", OLD("<emitter type=\"sunsky\"/>"), -0.692, 0.720, 0.051);
    sun_is(
        "scene.lxs",
        "LookAt 0 0 5 0 0 0 0 1 0\nCamera \"perspective\" \"float focaldistance\" [0]\n"
        "Film \"multiimage\" \"integer xresolution\" [32]\nWorldBegin\n"
        "LightSource \"sunsky\" \"vector sundir\" [0 .3 1] \"float gain\" [2]\n"
        "WorldEnd\n",
        0, 0.3, 1);
    sun_is("scene.lxs",
           "WorldBegin\nRotate 90 1 0 0\n"
           "LightSource \"sun\" \"vector sundir\" [0 .3 1]\nWorldEnd\n",
           0, -1, 0.3);
}

/* Which parts there are, and how bright. */
static void test_parts(void **state)
{
    (void)state;
#define AT "<vector name=\"sunDirection\" x=\"1\" y=\"3\" z=\"2\"/>"
    static const char *const texts[] = {
        OLD("<emitter type=\"sunsky\">" AT "</emitter>"),
        OLD("<emitter type=\"sun\">" AT "</emitter>"),
        OLD("<emitter type=\"sky\">" AT "</emitter>"),
        OLD("<emitter type=\"sky\">" AT "<float name=\"scale\" value=\"3\"/></emitter>"),
        OLD("<emitter type=\"sunsky\">" AT "<float name=\"skyScale\" value=\"0\"/>"
            "<float name=\"sunScale\" value=\"2\"/></emitter>")};
    double green[5];
    for (int i = 0; i < 5; i++) {
        struct scene_desc *desc = good(texts[i]);
        import_test_note(desc, "Preetham's model", 1, 2);
        green[i] = gather(desc->lights[0].map, (double[3]){0.0, 0.0, 1.0}).g;
        scene_desc_destroy(desc);
    }
    import_test_near(green[0], green[1] + green[2], 1e-4);
    import_test_near(green[3], 3.0 * green[2], 1e-4);
    import_test_near(green[4], 2.0 * green[1], 1e-4);
    assert_true(green[1] > green[2] && green[2] > 0.05);
}

static void test_lux_parts(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.lxs", "Camera \"perspective\" \"float focaldistance\" [0]\n"
                     "Film \"multiimage\" \"integer xresolution\" [32]\nWorldBegin\n"
                     "LightSource \"sky\" \"float gain\" [2] \"float turbidity\" [4]\n"
                     "LightSource \"sun\"\nWorldEnd\n");
    assert_int_equal(desc->light_count, 2);
    assert_int_equal(desc->width, 32);
    import_test_near(desc->lights[0].intensity.g, 2.0, 1e-12);
    import_test_note(desc, "the film \"multiimage\" is read for its size alone", 1, 2);
    import_test_note(desc, "light \"sky\" is a picture of Preetham's sky", 1, 4);
    scene_desc_destroy(desc);
}

static void test_bad(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {"<emitter type=\"sunsky\"><vector name=\"sun_direction\" z=\"-1\"/></emitter>",
         "scene.xml:2:1: the sun is below the horizon"},
        {"<emitter type=\"sunsky\"><vector name=\"sun_direction\"/></emitter>",
         "the sun's direction is none"},
        {"<emitter type=\"sky\"><float name=\"turbidity\" value=\"0\"/></emitter>",
         "the turbidity 0 is not within 1 and 30"},
        {"<emitter type=\"sky\"><float name=\"sky_scale\" value=\"-1\"/></emitter>",
         "a scale of sun or sky is negative"},
        {"<emitter type=\"sky\"><integer name=\"month\" value=\"13\"/></emitter>",
         "is no date"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[400];
        snprintf(text, sizeof text, NEW("%s"), rows[i][0]);
        import_test_bad("scene.xml", text, rows[i][1]);
    }
    char many[17 * 32 + 1] = "";
    for (int i = 0; i < 17; i++)
        strcat(many, "<emitter type=\"sky\"/>\n");
    char text[sizeof many + 64];
    snprintf(text, sizeof text, NEW("%s"), many);
    import_test_bad("scene.xml", text, "scene.xml:18:1: more than 16 skies");
    import_test_bad("scene.lxs",
                    "WorldBegin\nLightSource \"sunsky\" \"vector sundir\" [0 0 -1]\n",
                    "scene.lxs:2:1: the sun is below the horizon");
    import_test_bad("scene.pbrt", "WorldBegin\nLightSource \"sunsky\"\n",
                    "unknown light \"sunsky\"");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sun),       cmocka_unit_test(test_sunset),
        cmocka_unit_test(test_zenith),    cmocka_unit_test(test_time),
        cmocka_unit_test(test_formats),   cmocka_unit_test(test_parts),
        cmocka_unit_test(test_lux_parts), cmocka_unit_test(test_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
