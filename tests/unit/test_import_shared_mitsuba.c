/* Mitsuba scenes that others made, where they are present: exact counts, materials,
 * lights, camera and notes. Skipped (77) without them. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "import/spectrum.h"
#include "support/import_test.h"
#include "support/shared_scenes.h"

static struct scene_desc *load(const char *path)
{
    struct err err = {0};
    struct scene_desc *desc = import_scene(path, NULL, &err);
    if (!desc)
        print_message("%s:%d:%d: %s\n", err.file, err.line, err.col, err.message);
    assert_non_null(desc);
    return desc;
}

static void counts_are(const struct scene_desc *desc, size_t shapes, long triangles,
                       int emitters)
{
    long sum = 0;
    int lamps = 0;
    for (size_t i = 0; i < desc->shape_count; i++) {
        sum += desc->shapes[i].mesh ? (long)desc->shapes[i].mesh->triangle_count : 0;
        lamps += desc->shapes[i].emits;
    }
    assert_int_equal(desc->shape_count, shapes);
    assert_int_equal(sum, triangles);
    assert_int_equal(lamps, emitters);
}

static const struct bsdf *material_of(const struct scene_desc *desc, int shape)
{
    return &desc->materials[desc->shapes[shape].material];
}

/* Where the camera stands and looks to. */
static void camera_is(const struct scene_desc *desc, const double eye[3],
                      const double gaze[3])
{
    const double(*m)[4] = desc->camera.to_world.m;
    for (int i = 0; i < 3; i++) {
        import_test_near(m[i][3], eye[i], 1e-4);
        import_test_near(m[i][2], gaze[i], 1e-4);
    }
    assert_true(xform_swaps_handedness(&desc->camera.to_world));
    assert_int_equal(desc->camera.fov_axis, FOV_X);
}

static void common_notes(const struct scene_desc *desc)
{
    import_test_note(desc, "unknown integrator \"path_guiding_integrator\"", 1,
                     desc->max_depth == 3 ? 8 : 10);
    import_test_note(desc, "the filter \"tent\" is not used", 1,
                     desc->max_depth == 3 ? 24 : 26);
}

static void test_peer_box(void **state)
{
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "peer-box/glass.xml");
    counts_are(desc, 5, 24, 1);
    camera_is(desc, (const double[]){0, 1, 6.8}, (const double[]){0, 0, -1});
    assert_int_equal(desc->log.count, 0);
    assert_int_equal(desc->max_depth, 6);
    assert_true(desc->shapes[3].radiance.r == 17.0 && !desc->shapes[3].mesh->n);
    assert_string_equal(material_of(desc, 3)->type->name, "black");
    assert_string_equal(material_of(desc, 4)->type->name, "dielectric");
    scene_desc_destroy(desc);
}

static void test_veach_bidir(void **state)
{
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "veach-bidir-mitsuba/scene.xml");
    counts_are(desc, 14, 11544, 2);
    camera_is(desc, (const double[]){16.2155, 4.05167, 0.0114864},
              (const double[]){-0.999977, -0.00467011, -0.00502464});
    common_notes(desc);
    assert_int_equal(desc->log.count, 2);
    assert_true(desc->width == 1024 && desc->height == 1024 && desc->max_depth == 7);
    assert_string_equal(material_of(desc, 0)->type->name, "roughconductor");
    assert_true(!desc->shapes[0].mesh->n && desc->shapes[4].mesh->n);
    assert_true(desc->shapes[3].radiance.b == 6196.21);
    scene_desc_destroy(desc);
}

static void test_veach_ajar(void **state)
{
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "veach-ajar-mitsuba/scene.xml");
    counts_are(desc, 22, 382628, 1);
    camera_is(desc, (const double[]){4.05402, 1.61647, -2.30652},
              (const double[]){-0.990015, -0.0322983, -0.137213});
    common_notes(desc);
    import_test_note(desc, "degenerate triangle", 62, 157);
    assert_int_equal(desc->log.count, 3);
    assert_true(desc->width == 1280 && desc->height == 720 && desc->max_depth == 13);
    assert_int_equal(desc->textures.image_count, 3);
    assert_non_null(material_of(desc, 1)->bound[0].texture);
    scene_desc_destroy(desc);
}

static void test_veach_mis(void **state)
{
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "veach-mis-mitsuba/scene.xml");
    counts_are(desc, 9, 52, 3);
    camera_is(desc, (const double[]){28.2792, 3.5, 0}, (const double[]){-1, 0, 0});
    common_notes(desc);
    assert_int_equal(desc->log.count, 2);
    assert_true(desc->shapes[5].radius == 1.0 && desc->shapes[7].radius == 0.05);
    assert_true(import_test_param(desc, desc->shapes[2].material, "alpha_u")[0] == 0.1);
    scene_desc_destroy(desc);
}

/* The metals' table against the measured spectra that it stands for; another observer
 * makes up to a hundredth. */
static void test_metals(void **state)
{
    static const char *const metals[] = {"Ag", "Al"}, *const params[] = {"eta", "k"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct text text = {0};
        text_append(&text,
                    "<scene version=\"3.0\"><shape type=\"disk\"><bsdf "
                    "type=\"twosided\"><bsdf type=\"conductor\"><string "
                    "name=\"material\" value=\"%s\"/></bsdf></bsdf></shape></scene>",
                    metals[i]);
        struct scene_desc *desc = import_test_good("metal.xml", text.data);
        for (int j = 0; j < 2; j++) {
            char path[128];
            struct rgb from_file;
            struct err err = {0};
            const double *v = import_test_param(desc, 0, params[j]);
            snprintf(path, sizeof path, SHARED_SCENES "breakfast-pbrt3/spds/%s.%s.spd",
                     metals[i], params[j]);
            assert_true(import_test_spectrum(path, NULL, &from_file, &err));
            import_test_near(v[0] / from_file.r, 1.0, 0.01);
            import_test_near(v[1] / from_file.g, 1.0, 0.01);
            import_test_near(v[2] / from_file.b, 1.0, 0.01);
        }
        scene_desc_destroy(desc);
        free(text.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_peer_box),   cmocka_unit_test(test_veach_bidir),
        cmocka_unit_test(test_veach_ajar), cmocka_unit_test(test_veach_mis),
        cmocka_unit_test(test_metals),
    };
    return shared_scenes_there() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
}
