/* import/mitsuba/mitsuba_material, _mixture, _coat, _texture and _light: what each kind
 * becomes.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "base/text.h"
#include "support/mitsuba_test.h"
#include "surface/fresnel.h"

static const char *kind_of(const struct scene_desc *desc, int shape)
{
    return desc->materials[desc->shapes[shape].material].type->name;
}

/* --- materials and lights ------------------------------------------------------------
 */

static void test_sides(void **state)
{
    (void)state;
    struct scene_desc *desc = good(NEW(
        "<bsdf type=\"diffuse\" id=\"b\"><rgb name=\"reflectance\" value=\".1 .2 .3\"/>"
        "</bsdf><bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>\n"
        "<shape type=\"disk\"><ref id=\"a\"/></shape>"
        "<shape type=\"disk\"><ref id=\"a\"/></shape>\n"
        "<shape type=\"disk\"><ref id=\"b\"/></shape>\n"
        "<shape type=\"disk\"><bsdf type=\"conductor\"/></shape>\n"
        "<shape type=\"disk\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
        "value=\"0\"/></bsdf></shape>"
        "<shape type=\"disk\"/><shape type=\"disk\"><emitter type=\"area\"/></shape>"
        "<shape type=\"disk\"><bsdf type=\"twosided\"><ref id=\"b\"/><bsdf "
        "type=\"phong\"/></bsdf></shape>"));
    assert_int_equal(desc->log.count, 0);
    assert_int_equal(desc->shapes[0].material, desc->shapes[1].material);
    assert_int_not_equal(desc->shapes[0].material, desc->shapes[2].material);
    rgb_is(front_param(desc, 2, "reflectance"), 0.1, 0.2, 0.3);
    assert_string_equal(kind_of(desc, 0), "diffuse");
    assert_string_equal(kind_of(desc, 2), "sides");
    assert_null(desc->materials[desc->shapes[2].material].child[1]);
    assert_string_equal(front(desc, 3)->type->name, "mirror"); /* Mitsuba 3's conductor */
    assert_string_equal(kind_of(desc, 4), "black");
    assert_string_equal(front(desc, 5)->type->name, "diffuse");
    assert_string_equal(kind_of(desc, 6), "black");
    assert_string_equal(kind_of(desc, 7), "sides");
    const struct bsdf *back = desc->materials[desc->shapes[7].material].child[1];
    assert_string_equal(back->type->name, "phong");
    scene_desc_destroy(desc);
}

/* Coats and the like: what each kind takes, and its defaults. */
static void test_coats(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"disk\"><bsdf type=\"plastic\"><boolean name=\"nonlinear\" "
            "value=\"true\"/><rgb name=\"diffuse_reflectance\" value=\".1 .2 .3\"/>"
            "</bsdf></shape><shape type=\"disk\"><bsdf type=\"roughplastic\"><float "
            "name=\"alpha\" value=\".3\"/><string name=\"distribution\" value=\"ggx\"/>"
            "<float name=\"int_ior\" value=\"1.6\"/><string name=\"ext_ior\" "
            "value=\"vacuum\"/></bsdf></shape><shape type=\"disk\"><bsdf "
            "type=\"thindielectric\"/></shape><shape type=\"disk\"><bsdf type=\"phong\">"
            "<float name=\"exponent\" value=\"50\"/></bsdf></shape>"));
    assert_int_equal(desc->log.count, 0);
    import_test_near(*front_param(desc, 0, "eta"), 1.49 / 1.000277, 1e-12);
    import_test_near(*front_param(desc, 0, "nonlinear"), 1.0, 0.0);
    rgb_is(front_param(desc, 0, "reflectance"), 0.1, 0.2, 0.3);
    rgb_is(front_param(desc, 0, "specular"), 1.0, 1.0, 1.0);
    import_test_near(*front_param(desc, 1, "eta"), 1.6, 1e-12);
    import_test_near(*front_param(desc, 1, "alpha_v"), 0.3, 1e-12);
    import_test_near(*front_param(desc, 1, "distribution"), 0.0, 0.0);
    assert_string_equal(kind_of(desc, 2), "thindielectric");
    import_test_near(*front_param(desc, 2, "eta"), 1.5046 / 1.000277, 1e-12);
    import_test_near(*front_param(desc, 3, "exponent"), 50.0, 0.0);
    rgb_is(front_param(desc, 3, "ks"), 0.2, 0.2, 0.2);
    scene_desc_destroy(desc);
}

static void test_mixtures(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"disk\"><bsdf type=\"mask\"><float name=\"opacity\" "
            "value=\".25\"/><bsdf type=\"phong\"/></bsdf></shape>"
            "<shape type=\"disk\"><bsdf type=\"blendbsdf\"><float name=\"weight\" "
            "value=\".75\"/><bsdf type=\"null\"/><bsdf type=\"dielectric\"/></bsdf>"
            "</shape>"));
    assert_int_equal(desc->log.count, 0);
    for (int i = 0; i < 2; i++) {
        const struct bsdf *bsdf = front(desc, i);
        assert_string_equal(bsdf->type->name, "blend");
        rgb_is(param_of(bsdf, "weight"), i ? 0.75 : 0.25, i ? 0.75 : 0.25,
               i ? 0.75 : 0.25);
        assert_string_equal(bsdf->child[0]->type->name, "null");
    }
    assert_string_equal(front(desc, 0)->child[1]->type->name, "sides");
    assert_string_equal(front(desc, 1)->child[1]->type->name, "dielectric");
    scene_desc_destroy(desc);
}

#define GREY(value) \
    "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" value "\"/></bsdf>"

static struct bsdf_value seen(const struct bsdf *bsdf, float cos_o, float cos_i)
{
    struct bsdf_value value;
    struct vec3 wo = {sqrtf(1.0f - cos_o * cos_o), 0.0f, cos_o};
    struct vec3 wi = {0.0f, sqrtf(1.0f - cos_i * cos_i), cos_i};
    bsdf_eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &value);
    return value;
}

/* The sum of the parts by their weights: .5 .2 + .3 .6 + .1 .8, whatever the order of
 * blends, and the rest is black. */
static void test_weights(void **state)
{
    (void)state;
    static const struct {
        const char *weights;
        double sum;
        size_t notes;
    } rows[] = {{"0.5, 0.3, 0.1", 0.36, 0},
                {"0 0 1", 0.8, 0},
                {"0.5 0.5 0", 0.4, 0},
                {"1 2 1", 0.55, 1},
                {"0.1 0 0", 0.02, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct text text = {0};
        text_append(&text,
                    SHAPE("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                          "value=\"%s\"/>" GREY("0.2") GREY("0.6") GREY("0.8") "</bsdf>"),
                    rows[i].weights);
        struct scene_desc *desc = good(text.data);
        assert_int_equal(desc->log.count, rows[i].notes);
        const struct bsdf *bsdf = &desc->materials[desc->shapes[0].material];
        import_test_near(seen(bsdf, 0.5f, 0.8f).f.g * 3.14159265358979, rows[i].sum,
                         1e-6);
        scene_desc_destroy(desc);
        free(text.data);
    }
}

/* Mitsuba's coat passes 1 - F both ways, and rho of the base in between. */
static void test_coating(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        SHAPE("<bsdf type=\"coating\"><float name=\"int_ior\" value=\"1.6\"/><float "
              "name=\"ext_ior\" value=\"1\"/>" GREY("0.7") "</bsdf>"));
    assert_int_equal(desc->log.count, 0);
    assert_string_equal(front(desc, 0)->type->name, "plastic");
    double beyond, pass = (1.0 - fresnel_dielectric(0.5, 1.6, &beyond)) *
                          (1.0 - fresnel_dielectric((double)0.8f, 1.6, &beyond));
    import_test_near(seen(front(desc, 0), 0.5f, 0.8f).f.g * 3.14159265358979,
                     pass * 0.7 / (1.6 * 1.6), 1e-6);
    scene_desc_destroy(desc);
    desc = good(SHAPE("<bsdf type=\"roughcoating\"><float name=\"alpha\" value=\"0.3\"/>"
                      "<bsdf type=\"diffuse\"/></bsdf>"));
    assert_int_equal(desc->log.count, 0);
    assert_string_equal(front(desc, 0)->type->name, "roughplastic");
    import_test_near(*front_param(desc, 0, "alpha_u"), 0.3, 1e-12);
    scene_desc_destroy(desc);
    desc = good(SHAPE("<bsdf type=\"coating\"><rgb name=\"sigma_a\" value=\"1\"/><bsdf "
                      "type=\"conductor\"/></bsdf>"));
    import_test_note(desc, "coats do not absorb", 1, 2);
    import_test_note(desc, "a coat over what is not diffuse is left out", 1, 2);
    assert_string_equal(front(desc, 0)->type->name, "mirror");
    scene_desc_destroy(desc);
}

static void texel_is(const struct texture *texture, double u, double v, double r,
                     double g, double b)
{
    struct rgb colour = texture_eval_uv(texture, u, v);
    rgb_is(&colour.r, r, g, b);
}

#define SCALED_BY_3 "<float name=\"scale\" value=\"3\"/>"

/* A map goes to the outermost node, through masks and sides. */
static void check_relief(const char *around[2], const char *map, double scale)
{
    struct text text = {0};
    text_append(&text,
                NEW("<shape type=\"rectangle\">%s<bsdf type=\"%s\"><texture "
                    "type=\"scale\"><float name=\"scale\" value=\"2\"/><texture "
                    "type=\"checkerboard\"/></texture><bsdf type=\"diffuse\"/>%s"
                    "</bsdf>%s</shape>"),
                around[0], map, scale == 1.0 ? "" : SCALED_BY_3, around[1]);
    struct scene_desc *desc = good(text.data);
    assert_int_equal(desc->log.count, 0);
    const struct bsdf *bsdf = &desc->materials[desc->shapes[0].material];
    assert_non_null(bsdf->relief.texture);
    assert_true(bsdf->relief.normals == text_equal(map, "normalmap"));
    double bright = 0.8 * scale, dark = 0.4 * scale;
    texel_is(bsdf->relief.texture, 0.25, 0.25, bright, bright, bright);
    texel_is(bsdf->relief.texture, 0.75, 0.25, dark, dark, dark);
    scene_desc_destroy(desc);
    free(text.data);
}

static void test_relief(void **state)
{
    (void)state;
    static const char *around[][2] = {
        {"", ""},
        {"<bsdf type=\"twosided\">", "</bsdf>"},
        {"<bsdf type=\"mask\">", "</bsdf>"},
        {"<bsdf type=\"twosided\">", "<bsdf type=\"phong\"/></bsdf>"},
        {"<bsdf type=\"blendbsdf\">", "<bsdf type=\"phong\"/></bsdf>"},
        {"<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1\"/>", "</bsdf>"},
        {"<bsdf type=\"coating\">", "</bsdf>"},
    };
    for (size_t i = 0; i < sizeof around / sizeof around[0]; i++) {
        check_relief(around[i], "bumpmap", 3.0);
        check_relief(around[i], "bumpmap", 1.0);
        check_relief(around[i], "normalmap", 1.0);
    }
}

/* Red over green on the left, blue over white on the right. */
static const unsigned char tga[] = {0,   0,   2, 0, 0, 0,   0,  0,    0,   0,
                                    0,   0,   2, 0, 2, 0,   24, 0x20, 0,   0,
                                    255, 255, 0, 0, 0, 255, 0,  255,  255, 255};

/* v goes down a picture; each field of a checkerboard is half of the unit square. */
static void test_textures(void **state)
{
    (void)state;
    import_test_write_bytes("four.tga", tga, sizeof tga);
    struct scene_desc *desc = good(NEW(
        "<texture type=\"bitmap\" id=\"t\"><string name=\"filename\" "
        "value=\"four.tga\"/></texture>\n"
        "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><ref id=\"t\" "
        "name=\"reflectance\"/></bsdf></shape>"
        "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture "
        "type=\"checkerboard\" name=\"reflectance\"><rgb name=\"color1\" value=\"1\"/>"
        "<transform name=\"to_uv\"><scale x=\"2\"/></transform></texture></bsdf>"
        "</shape>"
        "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture "
        "type=\"checkerboard\" name=\"reflectance\"><float name=\"uscale\" "
        "value=\"2\"/><ref name=\"color0\" id=\"t\"/></texture></bsdf></shape>\n"
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><ref id=\"t\" "
        "name=\"reflectance\"/></bsdf><emitter type=\"area\"><ref id=\"t\" "
        "name=\"radiance\"/></emitter></shape>"));
    const struct texture *t = front(desc, 0)->bound[0].texture;
    texel_is(t, 0.25, 0.25, 1.0, 0.0, 0.0);
    texel_is(t, 0.75, 0.25, 0.0, 0.0, 1.0);
    texel_is(t, 0.25, 0.75, 0.0, 1.0, 0.0);
    texel_is(t, 0.75, 0.75, 1.0, 1.0, 1.0);
    for (int i = 0; i < 2; i++) {
        t = front(desc, 1 + i)->bound[0].texture;
        double c = i ? 0.2 : 1.0;
        texel_is(t, 0.3, 0.25, c, c, c);
        texel_is(t, 0.1, 0.75, c, c, c);
    }
    t = front(desc, 1)->bound[0].texture;
    texel_is(t, 0.1, 0.25, 0.4, 0.4, 0.4);
    texel_is(t, 0.3, 0.75, 0.4, 0.4, 0.4);
    import_test_note(desc, "a textured sphere", 1, 4);
    rgb_is(&desc->shapes[3].radiance.r, 1.0, 1.0, 1.0);
    texel_is(desc->shapes[3].emission, 0.25, 0.25, 1.0, 0.0, 0.0);
    scene_desc_destroy(desc);
}

/* The way that light from the middle of a map's row or column comes, by its matrix. */
static void test_far_lights(void **state)
{
    (void)state;
    import_test_write_bytes("four.tga", tga, sizeof tga);
    struct scene_desc *desc = good(NEW(
        "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter>"
        "<emitter type=\"envmap\"><string name=\"filename\" value=\"four.tga\"/>"
        "<float name=\"scale\" value=\"2\"/></emitter>"
        "<emitter type=\"directional\"><vector name=\"direction\" value=\"0 -1 0\"/>"
        "<rgb name=\"irradiance\" value=\"4\"/></emitter>"
        "<emitter type=\"spot\"><transform name=\"to_world\"><lookat "
        "origin=\"0 5 0\" target=\"0 0 0\"/></transform></emitter>"));
    assert_int_equal(desc->log.count, 0);
    assert_int_equal(desc->light_count, 4);
    rgb_is(&desc->lights[0].intensity.r, 1.0, 2.0, 3.0);
    const struct light_desc *map = &desc->lights[1];
    assert_non_null(map->map);
    rgb_is(&map->intensity.r, 2.0, 2.0, 2.0);
    struct vec3 up = xform_vector(&map->to_world, vec3(0.0f, 0.0f, 1.0f));
    struct vec3 start = xform_vector(&map->to_world, vec3(1.0f, 0.0f, 0.0f));
    struct vec3 quarter = xform_vector(&map->to_world, vec3(0.0f, 1.0f, 0.0f));
    point_is(&up.x, 0.0, 1.0, 0.0);
    point_is(&start.x, 0.0, 0.0, -1.0);
    point_is(&quarter.x, 1.0, 0.0, 0.0);
    for (int i = 2; i < 4; i++) {
        struct vec3 axis = xform_vector(&desc->lights[i].to_world,
                                        vec3(0.0f, 0.0f, 1.0f));
        point_is(&axis.x, 0.0, -1.0, 0.0);
    }
    assert_true(desc->lights[3].outer == 20.0 && desc->lights[3].inner == 15.0);
    assert_true(desc->lights[3].linear);
    scene_desc_destroy(desc);
}

static void test_metals(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        OLD("<shape type=\"disk\"><bsdf type=\"roughconductor\"><string "
            "name=\"material\" value=\"Al\"/><string name=\"distribution\" "
            "value=\"ggx\"/><float name=\"alpha\" value=\".25\"/><float name=\"extEta\" "
            "value=\"2\"/></bsdf></shape>\n"
            "<shape type=\"disk\"><bsdf type=\"conductor\"><string name=\"extEta\" "
            "value=\"vacuum\"/></bsdf></shape>\n"
            "<shape type=\"disk\"><bsdf type=\"conductor\"><string name=\"material\" "
            "value=\"none\"/><spectrum name=\"specularReflectance\" value=\".7\"/>"
            "</bsdf></shape>\n"
            "<shape type=\"disk\"><bsdf type=\"roughconductor\"><string "
            "name=\"material\" value=\"Xx\"/><string name=\"distribution\" "
            "value=\"phong\"/></bsdf></shape>\n"
            "<shape type=\"disk\"><bsdf type=\"conductor\"><rgb name=\"eta\" "
            "value=\"1 2 3\"/><rgb name=\"k\" value=\"4\"/><float name=\"extEta\" "
            "value=\"1\"/></bsdf></shape>"));
    rgb_is(front_param(desc, 0, "eta"), 1.65746 / 2, 0.880369 / 2, 0.521229 / 2);
    rgb_is(front_param(desc, 0, "k"), 9.223869 / 2, 6.269523 / 2, 4.837001 / 2);
    import_test_near(*front_param(desc, 0, "alpha_u"), 0.25, 1e-12);
    import_test_near(*front_param(desc, 0, "distribution"), 0.0, 0.0);
    rgb_is(front_param(desc, 1, "k"), 3.912949, 2.452848, 2.142188);
    assert_string_equal(front(desc, 2)->type->name, "mirror");
    rgb_is(front_param(desc, 2, "reflectance"), 0.7, 0.7, 0.7);
    import_test_note(desc, "unknown metal \"Xx\": taken as copper", 1, 5);
    import_test_note(desc, "distribution \"phong\" is taken as \"beckmann\"", 1, 5);
    rgb_is(front_param(desc, 4, "eta"), 1.0, 2.0, 3.0);
    rgb_is(front_param(desc, 4, "k"), 4.0, 4.0, 4.0);
    scene_desc_destroy(desc);
}

static void test_glass(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"sphere\"><bsdf type=\"dielectric\"/></shape>"
            "<shape type=\"sphere\"><bsdf type=\"dielectric\"><string name=\"int_ior\" "
            "value=\"water\"/><string name=\"ext_ior\" value=\"vacuum\"/></bsdf>"
            "</shape><shape type=\"sphere\"><bsdf type=\"null\"/></shape>"));
    import_test_near(*import_test_param(desc, 0, "eta"), 1.5046 / 1.000277, 1e-12);
    import_test_near(*import_test_param(desc, 1, "eta"), 1.333, 1e-12);
    assert_int_equal(desc->shape_count, 2);
    import_test_note(desc, "\"null\" are left out", 1, 2);
    scene_desc_destroy(desc);
}

/* What holds one material says so if it is given two; a blend takes two of three. */
static void test_surplus(void **state)
{
    static const char *const types[] = {"mask", "coating", "roughcoating", "blendbsdf"};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        char *text = text_format(NEW("<shape type=\"disk\">\n<bsdf type=\"%s\">"
                                     "<bsdf type=\"diffuse\"/>%s\n"
                                     "<bsdf type=\"mirror\"/></bsdf></shape>"),
                                 types[i], i < 3 ? "" : "<bsdf type=\"diffuse\"/>");
        struct scene_desc *desc = good(text);
        import_test_note(desc, "unused <bsdf> of <bsdf type=", 1, 4);
        scene_desc_destroy(desc);
        mem_free(text);
    }
}

static void test_lights(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        OLD("<emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" value=\"1 2 3\"/>"
            "</emitter>\n<shape type=\"disk\"><ref id=\"lamp\"/></shape>\n"
            "<emitter type=\"point\"><point name=\"position\" x=\"1\" z=\"2\"/>"
            "<spectrum name=\"intensity\" value=\"5\"/></emitter>"
            "<emitter type=\"point\"><transform name=\"toWorld\"><translate y=\"4\"/>"
            "</transform></emitter>"));
    assert_true(desc->shapes[0].emits && !desc->shapes[0].two_sided);
    rgb_is(&desc->shapes[0].radiance.r, 1.0, 2.0, 3.0);
    assert_int_equal(desc->light_count, 2);
    import_test_near(desc->lights[0].to_world.m[2][3], 2.0, 0.0);
    rgb_is(&desc->lights[0].intensity.r, 5.0, 5.0, 5.0);
    import_test_near(desc->lights[1].to_world.m[1][3], 4.0, 0.0);
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sides),    cmocka_unit_test(test_coats),
        cmocka_unit_test(test_mixtures), cmocka_unit_test(test_relief),
        cmocka_unit_test(test_weights),  cmocka_unit_test(test_coating),
        cmocka_unit_test(test_textures), cmocka_unit_test(test_far_lights),
        cmocka_unit_test(test_metals),   cmocka_unit_test(test_glass),
        cmocka_unit_test(test_lights),   cmocka_unit_test(test_surplus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
