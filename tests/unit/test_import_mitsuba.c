/* import/mitsuba/import_mitsuba: what of the format is read, and the notes on what is
 * not. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/mitsuba_test.h"
#include "support/serialized_make.h"

/* --- grammar -------------------------------------------------------------------------
 */

static void test_default(void **state)
{
    (void)state;
    struct scene_desc *desc = good(NEW(
        "<default name=\"w\" value=\"6\"/><default name=\"w\" value=\"9\"/>\n"
        "<default name=\"wide\" value=\"$w$w\"/><default name=\"kind\" value=\"film\"/>\n"
        "<sensor type=\"perspective\"><float name=\"fov\" value=\"30\"/>\n"
        "<film type=\"hdr$kind\"><integer name=\"width\" value=\"$wide\"/>\n"
        "<integer name=\"height\" value=\"$w\"/><rfilter type=\"box\"/></film>"
        "</sensor>\n"));
    assert_int_equal(desc->width, 66);
    assert_int_equal(desc->height, 6);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

static void test_include(void **state)
{
    (void)state;
    import_test_write("part.xml", "<scene version=\"3.0.0\">\n<bsdf type=\"diffuse\" "
                                  "id=\"a\">\n<rgb name=\"reflectance\" value=\"$v\"/>"
                                  "</bsdf>\n</scene>");
    import_test_write("one.xml", "<shape type=\"sphere\"><ref id=\"a\"/></shape>");
    struct scene_desc *desc = good(
        NEW("<default name=\"v\" value=\".25\"/><include filename=\"part.xml\"/>\n"
            "<include filename=\"one.xml\"/><shape type=\"cube\"><ref id=\"a\"/>"
            "</shape>\n"));
    assert_int_equal(desc->shape_count, 2);
    assert_int_equal(desc->material_count, 1);
    rgb_is(front_param(desc, 0, "reflectance"), 0.25, 0.25, 0.25);
    assert_true(text_ends_with(desc->shapes[0].place.file, "one.xml"));
    assert_int_equal(desc->shapes[0].place.line, 1);
    scene_desc_destroy(desc);
}

/* A scene of 0.6 and the same of 3. */
static void test_cases(void **state)
{
    (void)state;
    static const char *const texts[] = {
        OLD("<shape type=\"cylinder\"><transform name=\"toWorld\"><scale value=\"2\"/>"
            "</transform><boolean name=\"flipNormals\" value=\"true\"/>"
            "<bsdf type=\"roughdielectric\"><float name=\"intIOR\" value=\"1.7\"/>"
            "<float name=\"extIOR\" value=\"1\"/><float name=\"alphaU\" value=\".3\"/>"
            "<spectrum name=\"specularTransmittance\" value=\".5\"/></bsdf></shape>"),
        NEW("<shape type=\"cylinder\"><transform name=\"to_world\"><scale value=\"2\"/>"
            "</transform><boolean name=\"flip_normals\" value=\"True\"/>"
            "<bsdf type=\"roughdielectric\"><float name=\"int_ior\" value=\"1.7\"/>"
            "<float name=\"ext_ior\" value=\"1\"/><float name=\"alpha_u\" value=\".3\"/>"
            "<rgb name=\"specular_transmittance\" value=\".5\"/></bsdf></shape>")};
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = good(texts[i]);
        assert_int_equal(desc->log.count, 0);
        import_test_near(desc->shapes[0].to_world.m[2][2], 2.0, 1e-12);
        assert_true(desc->shapes[0].reverse_orientation);
        import_test_near(*import_test_param(desc, 0, "eta"), 1.7, 1e-12);
        import_test_near(*import_test_param(desc, 0, "alpha_u"), 0.3, 1e-12);
        import_test_near(*import_test_param(desc, 0, "alpha_v"), 0.1, 1e-12);
        import_test_near(*import_test_param(desc, 0, "distribution"), 1.0, 0.0);
        rgb_is(import_test_param(desc, 0, "transmittance"), 0.5, 0.5, 0.5);
        scene_desc_destroy(desc);
    }
}

static void test_colours(void **state)
{
    (void)state;
    static const struct {
        const char *element;
        double r, g, b;
    } rows[] = {
        {"<rgb name=\"reflectance\" value=\".1, .2 ,.3\"/>", 0.1, 0.2, 0.3},
        {"<rgb name=\"reflectance\" value=\".1\"/>", 0.1, 0.1, 0.1},
        {"<rgb name=\"reflectance\" value=\"#ff8000\"/>", 1.0, 0.2158605, 0.0},
        {"<srgb name=\"reflectance\" value=\"#FF8000\"/>", 1.0, 0.2158605, 0.0},
        {"<srgb name=\"reflectance\" value=\".5 1 0\"/>", 0.2140411, 1.0, 0.0},
        {"<spectrum name=\"reflectance\" value=\".3\"/>", 0.3, 0.3, 0.3},
        {"<spectrum name=\"reflectance\" value=\".3 .4 .5\"/>", 0.3, 0.4, 0.5},
        {"<float name=\"reflectance\" value=\".3\"/>", 0.3, 0.3, 0.3},
        {"<rgb name=\"reflectance\" value=\"-1 .4 .5\"/>", 0.0, 0.4, 0.5},
        {"<spectrum name=\"reflectance\" value=\"300:.1, 900:.1\"/>", 0.1, 0.1, 0.1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[400];
        snprintf(text, sizeof text, SHAPE("<bsdf type=\"diffuse\">%s</bsdf>"),
                 rows[i].element);
        struct scene_desc *desc = good(text);
        const double *v = front_param(desc, 0, "reflectance");
        double tolerance = strchr(rows[i].element, ':') ? 1e-3 : 1e-6;
        import_test_near(v[0], rows[i].r, tolerance);
        import_test_near(v[1], rows[i].g, tolerance);
        import_test_near(v[2], rows[i].b, tolerance);
        scene_desc_destroy(desc);
    }
}

/* --- transforms: each step after those before it -------------------------------------
 */

static void test_transform(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        SHAPE("<transform name=\"to_world\"><translate x=\"1\"/><scale y=\"3\"/>"
              "<rotate z=\"1\" angle=\"90\"/><matrix value=\"1 0 0 10 0 1 0 0 0 0 1 0 "
              "0 0 0 1\"/><matrix value=\"1 0 0 0 1 0 0 0 2\"/></transform>"));
    /* (-1,-1,0) -> (0,-1,0) -> (0,-3,0) -> (3,0,0) -> (13,0,0) */
    point_is(desc->shapes[0].mesh->p, 13.0, 0.0, 0.0);
    scene_desc_destroy(desc);
    desc = good(NEW("<sensor type=\"perspective\"><transform name=\"to_world\">"
                    "<lookat origin=\"1, 2, 3\" target=\"1 2 8\" up=\"0,1,0\"/>"
                    "<translate value=\"0, 0, 1\"/></transform></sensor>"));
    const struct xform *camera = &desc->camera.to_world;
    import_test_near(camera->m[2][3], 4.0, 1e-12);
    import_test_near(camera->m[2][2], 1.0, 1e-12);
    import_test_near(camera->m[1][1], 1.0, 1e-12);
    /* Towards +z, up +y: in a right-handed world right is -x. */
    import_test_near(camera->m[0][0], -1.0, 1e-12);
    scene_desc_destroy(desc);
    desc = good(SHAPE("<transform name=\"to_world\"><lookat origin=\"0,0,0\" "
                      "target=\"0,2,0\"/></transform>"));
    for (size_t i = 0; i < 4; i++) /* the rectangle's +z is +y now */
        import_test_near((double)desc->shapes[0].mesh->p[3 * i + 1], 0.0, 1e-6);
    scene_desc_destroy(desc);
}

/* --- sensor, film, integrator --------------------------------------------------------
 */

static void test_sensor(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum fov_axis axis;
    } rows[] = {{"x", FOV_X},
                {"y", FOV_Y},
                {"diagonal", FOV_DIAGONAL},
                {"smaller", FOV_SMALLER},
                {"larger", FOV_LARGER}};
    char text[400];
    for (int i = 0; i < 5; i++) {
        snprintf(text, sizeof text,
                 OLD("<sensor type=\"thinlens\"><float name=\"fov\" value=\"35\"/>"
                     "<string name=\"fovAxis\" value=\"%s\"/><float "
                     "name=\"apertureRadius\" value=\".5\"/><float "
                     "name=\"focusDistance\" value=\"7\"/></sensor>"),
                 rows[i].name);
        struct scene_desc *desc = good(text);
        assert_int_equal(desc->camera.fov_axis, rows[i].axis);
        assert_true(desc->camera.fov == 35.0 && desc->camera.lens_radius == 0.5);
        assert_true(desc->camera.focus_distance == 7.0);
        assert_int_equal(desc->width, 768);
        assert_int_equal(desc->height, 576);
        assert_int_equal(desc->max_depth, 64);
        import_test_note(desc, "\"gaussian\" (Mitsuba's default)", 1, 2);
        scene_desc_destroy(desc);
    }
    struct scene_desc *desc = good(
        NEW("<sensor type=\"perspective\"><float name=\"fov\" value=\"35\"/></sensor>"));
    assert_int_equal(desc->camera.fov_axis, FOV_X);
    assert_true(desc->camera.lens_radius == 0.0);
    scene_desc_destroy(desc);
    desc = good(NEW("<sensor type=\"perspective\"/>"));
    assert_int_equal(desc->camera.fov_axis, FOV_DIAGONAL); /* of a 50 mm lens */
    import_test_near(desc->camera.fov, 46.79, 0.01);
    scene_desc_destroy(desc);
}

/* The pixels of a crop are those of the whole film, whatever its size. */
static void test_crop(void **state)
{
    (void)state;
    char text[600];
    for (int width = 1; width <= 130; width += 3) {
        int x = width / 3, w = width / 2 > 0 ? width / 2 : 1;
        snprintf(text, sizeof text,
                 NEW("<sensor type=\"perspective\"><float name=\"fov\" value=\"35\"/>"
                     "<film type=\"hdrfilm\"><integer name=\"width\" value=\"%d\"/>"
                     "<integer name=\"height\" value=\"7\"/><integer "
                     "name=\"crop_offset_x\" value=\"%d\"/><integer name=\"crop_width\" "
                     "value=\"%d\"/><integer name=\"crop_offset_y\" value=\"2\"/>"
                     "<rfilter type=\"box\"/></film></sensor>"),
                 width, x, w);
        struct scene_desc *desc = good(text);
        struct camera camera, whole;
        struct err err = {0};
        assert_int_equal(desc->log.count, 0);
        assert_true(camera_build(&desc->camera, width, 7, &camera, &err));
        assert_int_equal(camera.width, w);
        assert_int_equal(camera.height, 5);
        desc->camera.crop[0] = desc->camera.crop[2] = 0.0;
        desc->camera.crop[1] = desc->camera.crop[3] = 1.0;
        assert_true(camera_build(&desc->camera, width, 7, &whole, &err));
        import_test_near(camera.x0, whole.x0 + whole.dx * x / width, 1e-12);
        import_test_near(camera.y0, whole.y0 + whole.dy * 2 / 7, 1e-12);
        scene_desc_destroy(desc);
    }
}

static void depth_is(const char *body, int depth, const char *note)
{
    char text[400];
    snprintf(text, sizeof text, NEW("%s"), body);
    struct scene_desc *desc = good(text);
    assert_int_equal(desc->max_depth, depth);
    assert_int_equal(desc->log.count, note ? 1 : 0);
    if (note)
        import_test_note(desc, note, 1, 2);
    scene_desc_destroy(desc);
}

static void test_depth(void **state)
{
    (void)state;
    depth_is("<integrator type=\"path\"/>", 64, NULL);
    depth_is("<integrator type=\"path\"><integer name=\"max_depth\" value=\"-1\"/>"
             "</integrator>",
             64, NULL);
    depth_is("<integrator type=\"bdpt\"><integer name=\"maxDepth\" value=\"5\"/>"
             "</integrator>",
             5, NULL);
    depth_is("<integrator type=\"aov\"><integrator type=\"volpath\"><integer "
             "name=\"max_depth\" value=\"7\"/></integrator></integrator>",
             7, NULL);
    depth_is("<integrator type=\"path\"><integer name=\"max_depth\" value=\"100\"/>"
             "</integrator>",
             64, "max_depth 100 is taken as 64");
    depth_is("<integrator type=\"direct\"/>", 2, "\"direct\" is taken as a depth limit");
    depth_is("<integrator type=\"pathh\"><integer name=\"max_depth\" value=\"3\"/>"
             "</integrator>",
             3, "unknown integrator \"pathh\" (did you mean \"path\"?)");
}

static void test_hidden_emitters(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        bool hidden;
    } rows[] = {
        {"", false},
        {"<boolean name=\"hide_emitters\" value=\"true\"/>", true},
        {"<boolean name=\"hideEmitters\" value=\"true\"/>", true},
        {"<boolean name=\"hide_emitters\" value=\"false\"/>", false},
        {"<integrator type=\"bdpt\"><boolean name=\"hide_emitters\" value=\"true\"/>"
         "</integrator>",
         true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[500];
        snprintf(text, sizeof text, NEW("<integrator type=\"aov\">%s</integrator>"),
                 rows[i].body);
        struct scene_desc *desc = good(text);
        assert_true(desc->hide_emitters == rows[i].hidden);
        assert_int_equal(desc->log.count, 0);
        scene_desc_destroy(desc);
    }
}

/* --- shapes --------------------------------------------------------------------------
 */

/* Of triangle i: its winding's normal times the side that the description takes. */
static void side_is(const struct scene_desc *desc, int shape, double x, double y,
                    double z)
{
    const struct shape_desc *s = &desc->shapes[shape];
    const float *p = s->mesh->p;
    double e[2][3], sign = s->reverse_orientation ? -1.0 : 1.0;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            e[i][k] = (double)p[3 * s->mesh->index[i + 1] + (uint32_t)k] -
                      (double)p[3 * s->mesh->index[0] + (uint32_t)k];
    double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1],
                   e[0][2] * e[1][0] - e[0][0] * e[1][2],
                   e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    assert_true(sign * (n[0] * x + n[1] * y + n[2] * z) > 0.0);
}

#define MIRROR "<transform name=\"to_world\"><scale x=\"-1\"/></transform>"
#define FLIP   "<boolean name=\"flip_normals\" value=\"true\"/>"

static void test_builtin(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"rectangle\"/><shape type=\"rectangle\">" MIRROR "</shape>"
            "<shape type=\"rectangle\">" FLIP "</shape><shape type=\"cube\"/>"
            "<shape type=\"cube\">" MIRROR "</shape>"
            "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/>"
            "<float name=\"radius\" value=\"4\"/><transform name=\"to_world\"><scale "
            "value=\"2\"/></transform></shape>"
            "<shape type=\"disk\"/><shape type=\"cylinder\"><point name=\"p0\" "
            "value=\"1, 1, 1\"/><point name=\"p1\" x=\"1\" y=\"4\" z=\"1\"/><float "
            "name=\"radius\" value=\".5\"/></shape>"));
    assert_int_equal(desc->log.count, 0);
    assert_true(!desc->shapes[0].mesh->n && !desc->shapes[3].mesh->n);
    side_is(desc, 0, 0.0, 0.0, 1.0);
    side_is(desc, 1, 0.0, 0.0, 1.0); /* outside stays outside */
    side_is(desc, 2, 0.0, 0.0, -1.0);
    for (int i = 3; i <= 4; i++) { /* the first corner of a cube points outwards */
        const float *p = desc->shapes[i].mesh->p;
        side_is(desc, i, (double)p[0], (double)p[1], (double)p[2]);
    }
    const struct shape_desc *s = desc->shapes + 5;
    assert_true(s->kind == SHAPE_SPHERE && s->radius == 4.0);
    import_test_near(s->to_world.m[0][0], 2.0, 1e-12);
    import_test_near(s->to_world.m[2][3], 6.0, 1e-12);
    assert_true(s[1].kind == SHAPE_DISK && s[1].radius == 1.0 && s[1].height == 0.0);
    assert_true(s[2].kind == SHAPE_CYLINDER && s[2].radius == 0.5);
    import_test_near(s[2].z_max - s[2].z_min, 3.0, 1e-12);
    struct vec3 top = xform_point(&s[2].to_world, vec3(0.0f, 0.0f, (float)s[2].z_max));
    import_test_near((double)top.y, 4.0, 1e-6);
    import_test_near((double)top.x, 1.0, 1e-6);
    scene_desc_destroy(desc);
}

/* u and v of some corners of Mitsuba's cube. */
static void test_cube_uv(void **state)
{
    (void)state;
    static const struct {
        double p[3], normal[3], u, v;
    } rows[] = {
        {{1, -1, -1}, {0, -1, 0}, 0, 1}, {{-1, -1, 1}, {0, -1, 0}, 1, 0},
        {{-1, 1, -1}, {0, 1, 0}, 1, 1},  {{1, 1, 1}, {0, 1, 0}, 0, 0},
        {{1, 1, -1}, {1, 0, 0}, 1, 1},   {{1, 1, 1}, {1, 0, 0}, 1, 0},
        {{1, 1, 1}, {0, 0, 1}, 1, 1},    {{-1, 1, 1}, {0, 0, 1}, 1, 0},
        {{-1, -1, 1}, {-1, 0, 0}, 0, 1}, {{-1, 1, -1}, {-1, 0, 0}, 1, 0},
        {{1, 1, -1}, {0, 0, -1}, 0, 1},  {{1, -1, -1}, {0, 0, -1}, 1, 1},
    };
    struct scene_desc *desc = good(NEW("<shape type=\"cube\"/>"));
    const struct mesh *mesh = desc->shapes[0].mesh;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int found = 0;
        for (size_t v = 0; v < 24; v++) {
            const float *p = mesh->p + 3 * v, *face = mesh->p + 12 * (v / 4);
            double side = 0.0, same = 0.0;
            for (size_t k = 0; k < 3; k++) {
                same += rows[i].p[k] == (double)p[k];
                for (size_t j = 0; j < 4; j++)
                    side += rows[i].normal[k] * (double)face[3 * j + k];
            }
            if (same < 3.0 || side < 4.0)
                continue;
            found++;
            import_test_near((double)mesh->uv[2 * v], rows[i].u, 0.0);
            import_test_near((double)mesh->uv[2 * v + 1], rows[i].v, 0.0);
        }
        assert_int_equal(found, 1);
    }
    scene_desc_destroy(desc);
}

#define RIDGE                                                                  \
    "v 0 0 0\nv 0 0 1\nv 1 -1 0\nv -1 -1 0\nvt 0 .25\nvt 1 1\nf 1/1 2/2 3/2\n" \
    "f 1/1 4/2 2/2\n"

/* Normals of a mesh: smooth unless told otherwise; its v turned round. */
static void test_normals(void **state)
{
    (void)state;
    import_test_write("ridge.obj", RIDGE);
    import_test_write("own.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -2\nf 1//1 2//1 "
                                 "3//1\n");
#define OBJ(file) "<shape type=\"obj\"><string name=\"filename\" value=\"" file "\"/>"
#define FACES     "<boolean name=\"face_normals\" value=\"true\"/>"
    struct scene_desc *desc = good(
        NEW(OBJ("ridge.obj") "</shape>" OBJ("ridge.obj") FACES "</shape>" OBJ(
            "own.obj") "</shape>" OBJ("own.obj") FACES "</shape>" OBJ("own.obj") MIRROR
            "</shape>" OBJ("ridge.obj") "<boolean name=\"flip_tex_coords\" "
                                        "value=\"false\"/></shape>"));
    const struct mesh *mesh = desc->shapes[0].mesh;
    struct err err = {0};
    assert_non_null(mesh->n);
    assert_true(mesh_check(desc->shapes[0].mesh, NULL, &desc->log, &err));
    point_is(mesh->n, 0.0, 1.0, 0.0);
    point_is(mesh->n + 6, sqrt(0.5), sqrt(0.5), 0.0);
    import_test_near((double)mesh->uv[1], 0.75, 1e-6);
    assert_null(desc->shapes[1].mesh->n);
    assert_non_null(desc->shapes[2].mesh->n);
    assert_null(desc->shapes[3].mesh->n);
    side_is(desc, 3, 0.0, 0.0, 1.0);
    point_is(desc->shapes[4].mesh->n, 0.0, 0.0, -1.0);
    import_test_near((double)desc->shapes[5].mesh->uv[1], 0.25, 1e-6);
    scene_desc_destroy(desc);
}

/* Weights are angles: a corner cut into many slivers counts as one. */
static void test_angles(void **state)
{
    (void)state;
    import_test_write("fan.obj", "v 0 0 0\nv 1 0 0\nv 0.7071068 0.7071068 0\nv 0 1 0\n"
                                 "v 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n");
    struct scene_desc *desc = good(NEW(OBJ("fan.obj") "</shape>"));
    struct err err = {0};
    assert_true(mesh_check(desc->shapes[0].mesh, NULL, &desc->log, &err));
    double third = sqrt(1.0 / 3.0);
    point_is(desc->shapes[0].mesh->n, third, third, third);
    scene_desc_destroy(desc);
}

static void test_serialized(void **state)
{
    struct serialized file = {.size = 0};
    size_t offsets[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct serialized body = {.size = 0};
        serialized_square(&body, 4, i ? 0x1018 : 0x1000, i);
        offsets[i] = serialized_add(&file, 4, &body);
    }
    serialized_end(&file, 4, offsets, 2);
    import_test_write_bytes("m.serialized", file.data, file.size);
#define SER \
    "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/>"
    struct scene_desc *desc = good(
        OLD(SER "</shape>\n" SER "<integer name=\"shapeIndex\" value=\"1\"/></shape>"));
    assert_int_equal(desc->shape_count, 2);
    assert_non_null(desc->shapes[0].mesh->n);
    assert_null(desc->shapes[1].mesh->n); /* its flags say faces */
    import_test_near((double)desc->shapes[1].mesh->p[2], 1.0, 0.0);
    import_test_note(desc, "colours of vertices are not used", 1, 3);
    scene_desc_destroy(desc);
}

/* --- what is not read: one counted note and the nearest meaning ----------------------
 */

static void test_notes(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        NEW("<shape type=\"dissk\"/>\n<shape type=\"hair\"/>\n"
            "<emitter type=\"lamp\"/>\n<medium type=\"homogeneous\"/>\n"
            "<shape type=\"disk\"><bsdf type=\"difuse\"/><float name=\"size\" "
            "value=\"1\"/></shape>\n<shapes/>stray\n"
            "<shape type=\"disk\"><bsdf type=\"ward\"/></shape>\n<shape "
            "type=\"disk\"><bsdf type=\"ward\"/></shape>"));
    import_test_note(desc, "unknown shape \"dissk\" (did you mean \"disk\"?): left out",
                     1, 2);
    import_test_note(desc, "shape \"hair\" is not read yet", 1, 3);
    import_test_note(desc, "unknown emitter \"lamp\": left out", 1, 4);
    import_test_note(desc, "<medium> is not read", 1, 5);
    import_test_note(desc, "unknown bsdf \"difuse\" (did you mean \"diffuse\"?)", 1, 6);
    import_test_note(desc, "unused <float> \"size\" of <shape type=\"disk\">", 1, 6);
    import_test_note(desc, "<shapes> is not read; did you mean <shape>?", 1, 7);
    import_test_note(desc, "text between elements", 1, 7);
    import_test_note(desc, "bsdf \"ward\" is not read as it is", 2, 8);
    assert_int_equal(desc->shape_count, 3);
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_default),
        cmocka_unit_test(test_include),
        cmocka_unit_test(test_cases),
        cmocka_unit_test(test_colours),
        cmocka_unit_test(test_transform),
        cmocka_unit_test(test_sensor),
        cmocka_unit_test(test_crop),
        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_hidden_emitters),
        cmocka_unit_test(test_builtin),
        cmocka_unit_test(test_cube_uv),
        cmocka_unit_test(test_normals),
        cmocka_unit_test(test_angles),
        cmocka_unit_test(test_serialized),
        cmocka_unit_test(test_notes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
