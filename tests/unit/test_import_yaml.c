/* import/yaml/scene_yaml: every key by what it leaves in the description, every error by
 * its place, and the example of scenes/README.md. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <glob.h>

#include "base/mem.h"
#include "scene/scene.h"
#include "support/import_test.h"

#define FRAME \
    "camera: {position: [0, 0, 5], target: [0, 0, 0]}\nfilm: {width: 8, height: 4}\n"
#define MATTE "materials: {m: {type: diffuse}, lamp: {type: black}}\n"

static struct scene_desc *good(const char *text)
{
    return import_test_good("scene.yaml", text);
}

static void test_camera(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        "camera: {position: [1, 2, 6], target: [1, 2, 0], fov: 30, fov_axis: x,\n"
        "  lens_radius: 0.1, focus_distance: 4}\n"
        "film: {width: 8, height: 4, crop: [0, 0.5, 0.25, 1]}\nmax_depth: 9\n"
        "hide_emitters: true\n");
    const struct camera_desc *c = &desc->camera;
    /* Right-handed world: looking along -z, +x is to the right. */
    assert_true(xform_point(&c->to_world, vec3(0, 0, 0)).z == 6.0f);
    import_test_near((double)xform_vector(&c->to_world, vec3(1, 0, 0)).x, 1.0, 1e-6);
    import_test_near((double)xform_vector(&c->to_world, vec3(0, 1, 0)).y, 1.0, 1e-6);
    import_test_near((double)xform_vector(&c->to_world, vec3(0, 0, 1)).z, -1.0, 1e-6);
    assert_true(c->fov == 30.0 && c->fov_axis == FOV_X && c->lens_radius == 0.1);
    assert_true(c->focus_distance == 4.0 && c->crop[1] == 0.5 && c->crop[2] == 0.25);
    assert_true(desc->width == 8 && desc->height == 4 && desc->max_depth == 9);
    assert_true(desc->hide_emitters);
    scene_desc_destroy(desc);
    desc = good("camera: {matrix: [1,0,0,7, 0,1,0,8, 0,0,1,9, 0,0,0,1]}\n"
                "film: {width: 8, height: 4}\n");
    assert_true(xform_point(&desc->camera.to_world, vec3(0, 0, 0)).y == 8.0f);
    assert_true(desc->max_depth == 0 && desc->camera.crop[3] == 1.0);
    assert_false(desc->hide_emitters);
    scene_desc_destroy(desc);
}

static void test_settings_and_lights(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        FRAME "settings: {large_step_probability: auto, sigma: 0.02}\n"
              "lights: [{type: point, position: [1, 2, 3], intensity: 5},\n"
              "  {type: point, position: [0, 0, 0], intensity: [-1, 0, 2]},\n"
              "  {type: point, position: [0, 0, 0], intensity: 0}]\n");
    assert_int_equal(desc->setting_count, 2);
    assert_string_equal(desc->settings[1].key, "sigma");
    assert_string_equal(desc->settings[1].value, "0.02");
    assert_int_equal(desc->settings[1].place.line, 3);
    assert_int_equal(desc->light_count, 2);
    assert_true(xform_point(&desc->lights[0].to_world, vec3(0, 0, 0)).y == 2.0f);
    assert_true(desc->lights[0].intensity.b == 5.0);
    assert_true(desc->lights[1].intensity.r == 0.0 && desc->lights[1].intensity.b == 2.0);
    assert_int_equal(desc->lights[1].place.line, 5);
    import_test_note(desc, "a light of no intensity", 1, 6);
    scene_desc_destroy(desc);
}

static void test_materials(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        FRAME
        "materials:\n  a: {type: roughconductor, alpha: 0.2, distribution: beckmann,"
        " k: 3, eta: [1, 2, 3]}\n  b: {type: dielectric, eta: 1.7}\n");
    assert_int_equal(desc->material_count, 2);
    assert_true(import_test_param(desc, 0, "alpha")[0] == 0.2);
    assert_true(import_test_param(desc, 0, "distribution")[0] == 1.0);
    assert_true(import_test_param(desc, 0, "k")[2] == 3.0);
    assert_true(import_test_param(desc, 0, "eta")[1] == 2.0);
    assert_true(import_test_param(desc, 1, "eta")[0] == 1.7);
    assert_true(import_test_param(desc, 1, "transmittance")[0] == 1.0);
    scene_desc_destroy(desc);
}

static void test_quadrics(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        FRAME MATTE
        "shapes:\n"
        "  - {type: sphere, material: m, radius: 2, reverse: true}\n"
        "  - {type: disk, material: lamp, height: 3, emission: 4, two_sided: true}\n"
        "  - {type: cylinder, material: m, z_min: -2, transform: {scale: [1, -1, 1]}}\n");
    const struct shape_desc *s = desc->shapes;
    assert_true(s[0].kind == SHAPE_SPHERE && s[0].radius == 2.0);
    assert_true(s[0].reverse_orientation && !s[0].emits && s[0].material == 0);
    assert_true(s[1].kind == SHAPE_DISK && s[1].height == 3.0 && s[1].radius == 1.0);
    assert_true(s[1].emits && s[1].two_sided && s[1].radiance.g == 4.0);
    assert_true(s[1].material == 1 && s[1].place.line == 6 && s[1].place.col == 5);
    assert_true(s[2].kind == SHAPE_CYLINDER && s[2].z_min == -2.0 && s[2].z_max == 1.0);
    assert_false(s[2].reverse_orientation);
    scene_desc_destroy(desc);
}

/* Steps happen in the order written: (1,0,0) doubled, turned to +y, lifted. */
static void test_transform_order(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        FRAME MATTE "shapes:\n  - type: sphere\n    material: m\n    transform:\n"
                    "      - scale: 2\n"
                    "      - rotate: {axis: [0, 0, 1], degrees: 90}\n"
                    "      - translate: [0, 0, 3]\n"
                    "      - matrix: [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n");
    struct vec3 p = xform_point(&desc->shapes[0].to_world, vec3(1, 0, 0));
    import_test_near((double)p.x, 5.0, 1e-6);
    import_test_near((double)p.y, 2.0, 1e-6);
    import_test_near((double)p.z, 3.0, 1e-6);
    scene_desc_destroy(desc);
    desc = good(FRAME MATTE "shapes: [{type: disk, material: m, transform: {look_at: "
                            "{position: [0, 5, 0], target: [0, 0, 0], up: [0, 0, 1]}}}]");
    struct vec3 n = xform_normal(&desc->shapes[0].to_world, vec3(0, 0, 1));
    assert_true(n.y < -0.999f); /* a disk's light falls on the target */
    assert_false(xform_swaps_handedness(&desc->shapes[0].to_world));
    scene_desc_destroy(desc);
}

static double signed_volume(const struct mesh *mesh)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        struct vec3 v[3];
        for (int i = 0; i < 3; i++)
            memcpy(&v[i], mesh->p + 3 * (size_t)mesh->index[3 * t + (uint32_t)i],
                   sizeof v[i]);
        sum += (double)vec3_dot(v[0], vec3_cross(v[1], v[2])) / 6.0;
    }
    return sum;
}

static void test_meshes(void **state)
{
    (void)state;
    import_test_write("tri.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    struct scene_desc *desc = good(
        FRAME MATTE
        "shapes:\n"
        "  - {type: rectangle, material: m, transform: {translate: [0, 0, 2]}}\n"
        "  - {type: box, material: m, transform: {scale: [-0.5, 1, 1]}}\n"
        "  - {type: lathe, material: m, segments: 200,"
        " profile: [[0, 0], [1, 0], [1, 2], [0, 2]]}\n"
        "  - {type: mesh, material: m, file: tri.ply, transform: {scale: 3}}\n");
    const struct shape_desc *s = desc->shapes;
    assert_int_equal(s[0].mesh->triangle_count, 2);
    assert_true(s[0].mesh->p[2] == 2.0f);
    /* Mirrored: the vertices wind inward, and the flag says so. */
    import_test_near(signed_volume(s[1].mesh), -4.0, 1e-6);
    assert_true(s[1].reverse_orientation != (s[1].mesh->n != NULL));
    import_test_near(signed_volume(s[2].mesh), 2.0 * 3.14159265358979, 0.01);
    assert_non_null(s[2].mesh->n);
    assert_true(s[3].mesh->p[3] == 3.0f);
    scene_desc_destroy(desc);
}

/* Objects may name objects that follow. */
static void test_objects(void **state)
{
    (void)state;
    struct scene_desc *desc = good(
        FRAME MATTE
        "objects:\n"
        "  pair:\n"
        "    instances:\n"
        "      - {object: ball}\n"
        "      - {object: ball, transform: {translate: [2, 0, 0]}}\n"
        "  ball:\n"
        "    shapes: [{type: sphere, material: m, transform: {scale: 2}}]\n"
        "shapes: [{type: box, material: m}]\n"
        "instances:\n"
        "  - {object: pair, transform: [{translate: [0, 1, 0]}, {scale: -1}]}\n");
    assert_int_equal(desc->object_count, 2);
    assert_int_equal(desc->shape_count, 2);
    assert_int_equal(desc->shapes[0].object, 2);
    assert_int_equal(desc->shapes[1].object, 0);
    assert_int_equal(desc->instances.count, 3);
    const struct instance_desc *i = desc->instances.list;
    assert_int_equal(i[0].object, 2);
    assert_int_equal(i[0].parent, 1);
    assert_true(i[1].to_world.m[0][3] == 2.0);
    assert_int_equal(i[1].place.line, 8);
    assert_int_equal(i[2].object, 1);
    assert_int_equal(i[2].parent, 0);
    assert_true(i[2].to_world.m[1][3] == -1.0);
    scene_desc_destroy(desc);
}

struct row {
    const char *text, *expected;
};

#define SHAPE(body) FRAME MATTE "shapes:\n  - " body "\n"

static void test_bad_scene(void **state)
{
    static const struct row rows[] = {
        {"[1]", "scene.yaml:1:1: a scene wants keys and values"},
        {"camera: {}\nfilm: {}\nshape: []", "scene.yaml:3:1: "},
        {"film: {width: 8, height: 4}", ":1:1: \"camera\" is missing here"},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0]}", "\"film\" is missing"},
        {"camera: {target: [0, 0, 0]}\nfilm: {width: 8, height: 4}",
         ":1:9: \"position\" is missing here"},
        {"camera: {position: [0, 0, 0], target: [0, 0, 0]}\nfilm: {width: 8, height: 4}",
         ":1:9: position and target coincide"},
        {"camera: {position: [0, 0], target: [0, 0, 0]}\nfilm: {width: 8, height: 4}",
         ":1:20: "},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0], fov_axis: z}\n"
         "film: {width: 8, height: 4}",
         ":1:60: unknown fov_axis \"z\""},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 0}\n"
         "film: {width: 8, height: 4}",
         ":1:9: fov 0 is not between"},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0], lens_radius: 1}\n"
         "film: {width: 8, height: 4}",
         ":1:9: a lens wants a focus_distance"},
        {"camera: {matrix: [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]}\n"
         "film: {width: 8, height: 4}",
         ":1:18: the matrix has no inverse"},
        {"camera: {matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], up: [0, 1, 0]}\n"
         "film: {width: 8, height: 4}",
         ":1:18: a matrix leaves no room"},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0]}\nfilm: {width: 0, height: 4}",
         ":2:15: width must lie between 1 and 65536, not 0"},
        {"camera: {position: [0, 0, 5], target: [0, 0, 0]}\n"
         "film: {width: 8, height: 4, crop: [0, 1, 1, 0]}",
         ":2:35: crop wants"},
        {FRAME "max_depth: 0", ":3:12: max_depth must lie between 1"},
        {FRAME "hide_emitters: 1", ":3:16: "},
        {FRAME "settings: [1]", ":3:11: settings wants keys and values"},
        {FRAME "lights: [{type: spot}]", ":3:17: unknown type of light \"spot\""},
        {FRAME "lights: [{type: point, intensity: 1}]", ":3:10: \"position\" is missing"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        import_test_bad("scene.yaml", rows[i].text, rows[i].expected);
}

static void test_bad_things(void **state)
{
    static const struct row rows[] = {
        {FRAME "materials: {a: {type: difuse}}",
         ":3:23: unknown type of material \"difuse\"; did you mean \"diffuse\"?"},
        {FRAME "materials: {a: {reflectance: 1}}", ":3:16: \"type\" is missing here"},
        {FRAME "materials: {a: {type: diffuse, reflectence: 1}}", ":3:32: "},
        {FRAME "materials: {a: {type: diffuse, reflectance: 1.5}}", ":3:45: "},
        {FRAME "materials: {a: {type: diffuse, reflectance: [1, 1]}}", ":3:45: "},
        {FRAME "materials: {a: {type: roughconductor, distribution: gxx}}", ":3:53: "},
        {FRAME "objects: [1]", ":3:10: objects wants names and objects"},
        {FRAME "objects: {a: {shape: []}}", ":3:15: unknown key"},
        {FRAME "objects: {a: 1}", ":3:14: an object wants keys and values"},
        {FRAME "instances: {}", ":3:12: instances wants a list"},
        {FRAME "instances: [{object: a}]", ":3:22: unknown object \"a\" (known: none)"},
        {FRAME "objects: {tree: {}}\ninstances: [{object: tre}]",
         ":4:22: unknown object \"tre\"; did you mean \"tree\"?"},
        {FRAME "objects: {a: {}}\ninstances: [{transform: []}]",
         ":4:13: \"object\" is missing here"},
        {FRAME "materials: {a: 1}", ":3:16: a material wants keys and values"},
        {SHAPE("{type: sphere, material: n}"),
         ":5:30: unknown material \"n\" (known: m, lamp)"},
        {SHAPE("{type: sphere, material: lanp}"), "did you mean \"lamp\"?"},
        {SHAPE("{type: sphere}"), ":5:5: \"material\" is missing here"},
        {SHAPE("{type: spher, material: m}"),
         ":5:12: unknown type of shape \"spher\"; did you mean \"sphere\"?"},
        {SHAPE("{type: sphere, material: m, radios: 2}"), ":5:33: "},
        {SHAPE("{type: sphere, material: m, file: a.ply}"), ":5:33: "},
        {SHAPE("{type: sphere, material: m, radius: -1}"), ":5:5: the radius -1 is not"},
        {SHAPE("{type: sphere, material: m, radius: .nan}"), ":5:41: "},
        {SHAPE("{type: cylinder, material: m, z_min: 1}"), ":5:5: z_min is not below"},
        {SHAPE("{type: disk, material: m, two_sided: true}"), ":5:5: two_sided is said"},
        {SHAPE("{type: lathe, material: m}"), ":5:5: \"profile\" is missing"},
        {SHAPE("{type: lathe, material: m, profile: [[1, 0]]}"), ":5:41: a profile is"},
        {SHAPE("{type: lathe, material: m, profile: [[1, 0], [-1, 1]]}"),
         ":5:50: a radius of the profile is negative"},
        {SHAPE("{type: lathe, material: m, profile: [[1, 0], [1]]}"), ":5:50: "},
        {SHAPE("{type: lathe, material: m, segments: 2, profile: [[1, 0], [1, 1]]}"),
         ":5:42: segments must lie between 3 and 4096, not 2"},
        {SHAPE("{type: mesh, material: m, file: a.obj}"), ":5:37: mesh files are read"},
        {SHAPE("{type: mesh, material: m, file: a.ply}"), "scene.yaml:5:37: "},
        {SHAPE("{type: box, material: m, transform: {scale: 0}}"),
         ":5:49: a scale of 0 has no inverse"},
        {SHAPE("{type: box, material: m, transform: {scale: 1, translate: [0, 0, 0]}}"),
         ":5:41: one step is one key"},
        {SHAPE("{type: box, material: m, transform: [{rotat: 1}]}"), ":5:43: "},
        {SHAPE("{type: box, material: m, transform: {rotate: {axis: [0, 0, 0], degrees: "
               "3}}}"),
         ":5:57: the axis is zero"},
        {SHAPE("{type: box, material: m, transform: {matrix: [1, 0, 0, 0]}}"), ":5:50: "},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        import_test_bad("scene.yaml", rows[i].text, rows[i].expected);
}

/* The documentation's example is a scene. */
static void test_example_of_readme(void **state)
{
    size_t size;
    struct err err = {0};
    (void)state;
    char *page = text_read_file("scenes/README.md", &size, NULL, &err);
    if (!page) {
        print_message("scenes/README.md is not there: run from the repository\n");
        skip();
    }
    char *begin = strstr(page, "```yaml\n");
    assert_non_null(begin);
    begin += strlen("```yaml\n");
    char *end = strstr(begin, "```");
    assert_non_null(end);
    *end = '\0';
    import_test_write("teapot.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    struct scene_desc *desc = good(begin);
    assert_int_equal(desc->shape_count, 9);
    assert_int_equal(desc->object_count, 2);
    assert_int_equal(desc->instances.count, 4);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
    mem_free(page);
}

/* Every scene of scenes/ loads and builds, and neither says a word: what is published as
 * a good scene has nothing left out, no two surfaces that rays cannot tell apart, and a
 * lamp.
 */
static void test_our_scenes(void **state)
{
    glob_t found;
    (void)state;
    if (glob("scenes/*/*.yaml", 0, NULL, &found) != 0) {
        print_message("scenes/ is not there: run from the repository\n");
        skip();
    }
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct err err = {0};
        struct scene_options options = {.width = 16, .height = 10, .threads = 1};
        struct scene_desc *desc = import_scene(found.gl_pathv[i], NULL, &err);
        struct scene *scene = desc ? scene_build(desc, &options, &err) : NULL;
        if (!scene)
            fail_msg("%s:%d:%d: %s", found.gl_pathv[i], err.line, err.col, err.message);
        if (scene->desc->log.count > 0)
            fail_msg("%s: %d notes; `etalon info` shows them", found.gl_pathv[i],
                     (int)scene->desc->log.count);
        assert_true(scene->light_count > 0);
        scene_destroy(scene);
    }
    globfree(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_settings_and_lights),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_quadrics),
        cmocka_unit_test(test_transform_order),
        cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_objects),
        cmocka_unit_test(test_bad_scene),
        cmocka_unit_test(test_bad_things),
        cmocka_unit_test(test_example_of_readme),
        cmocka_unit_test(test_our_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
