/* Scenes that others made, where they are present: exact counts, bounds, materials,
 * lights and camera. Skipped (77) without them. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/clock.h"
#include "support/import_test.h"
#include "support/shared_scenes.h"

static struct scene_desc *load(const char *path)
{
    struct err err = {0};
    double start = clock_wall();
    struct scene_desc *desc = import_scene(path, NULL, &err);
    if (!desc)
        print_message("%s:%d:%d: %s\n", err.file, err.line, err.col, err.message);
    assert_non_null(desc);
    print_message("%s: %.3f s\n", path, clock_wall() - start);
    return desc;
}

static long triangles(const struct scene_desc *desc)
{
    long sum = 0;
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].mesh)
            sum += (long)desc->shapes[i].mesh->triangle_count;
    return sum;
}

static int emitters(const struct scene_desc *desc)
{
    int sum = 0;
    for (size_t i = 0; i < desc->shape_count; i++)
        sum += desc->shapes[i].emits;
    return sum;
}

static void bounds_are(const struct scene_desc *desc, const double low[3],
                       const double high[3])
{
    float min[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
    float max[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
    for (size_t s = 0; s < desc->shape_count; s++) {
        const struct mesh *mesh = desc->shapes[s].mesh;
        for (size_t v = 0; mesh && v < 3 * (size_t)mesh->vertex_count; v++) {
            min[v % 3] = fminf(min[v % 3], mesh->p[v]);
            max[v % 3] = fmaxf(max[v % 3], mesh->p[v]);
        }
    }
    for (int i = 0; i < 3; i++) {
        import_test_near((double)min[i], low[i], 1e-5);
        import_test_near((double)max[i], high[i], 1e-5);
    }
}

static const struct bsdf *material_of(const struct scene_desc *desc, int shape)
{
    return &desc->materials[desc->shapes[shape].material];
}

static void test_coffee(void **state)
{
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "coffee-pbrt3/scene.pbrt");
    assert_int_equal(desc->shape_count, 23);
    assert_int_equal(emitters(desc), 3);
    /* 235 271 in the files, 226 of them without an area. */
    assert_int_equal(triangles(desc), 235045);
    import_test_note(desc, "degenerate triangle", 226, 33);
    import_test_note(desc, "the filter \"triangle\" is not used", 1, 4);
    assert_int_equal(desc->log.count, 2);
    assert_true(desc->width == 800 && desc->height == 1000 && desc->max_depth == 18);
    assert_string_equal(material_of(desc, 0)->type->name, "substrate");
    assert_string_equal(material_of(desc, 2)->type->name, "dielectric");
    assert_string_equal(material_of(desc, 4)->type->name, "mirror");
    assert_string_equal(material_of(desc, 20)->type->name, "black");
    const double *kd = import_test_param(desc, desc->shapes[3].material, "kd");
    assert_true(kd[0] == 1.0 && kd[1] == 0.378676 && kd[2] == 0.013473);
    assert_true(import_test_param(desc, desc->shapes[3].material, "alpha_u")[0] == 0.001);
    assert_true(import_test_param(desc, desc->shapes[0].material, "alpha_v")[0] == 0.1);
    assert_true(desc->shapes[20].radiance.g == 2.0);
    /* The file's camera is a rotation; it stands where the matrix puts the origin. */
    struct vec3 eye = xform_point(&desc->camera.to_world, vec3(0, 0, 0));
    double scale;
    assert_true(xform_is_similarity(&desc->camera.to_world, &scale));
    import_test_near(scale, 1.0, 1e-4);
    import_test_near((double)eye.x, -0.00301, 1e-4);
    import_test_near((double)eye.y, 0.1983, 1e-3);
    import_test_near((double)eye.z, 0.8281, 1e-3);
    assert_true(desc->camera.fov == 25.0 && desc->camera.fov_axis == FOV_SMALLER);
    scene_desc_destroy(desc);
}

static void test_cornell_box(void **state)
{
    static const double low[3] = {-1.0, -2.98023e-8, -1.0}, high[3] = {1.0, 2.0, 1.0};
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "cornell-box-pbrt3/scene.pbrt");
    assert_int_equal(desc->shape_count, 8);
    assert_int_equal(triangles(desc), 36);
    assert_int_equal(emitters(desc), 1);
    bounds_are(desc, low, high);
    assert_true(desc->shapes[7].emits && desc->shapes[7].radiance.r == 17.0);
    assert_true(import_test_param(desc, desc->shapes[4].material, "reflectance")[0] ==
                0.63);
    /* World to camera is (x, y - 1, 6.8 - z): at z = 6.8, looking along -z. */
    struct vec3 eye = xform_point(&desc->camera.to_world, vec3(0, 0, 0));
    struct vec3 look = xform_vector(&desc->camera.to_world, vec3(0, 0, 1));
    import_test_near((double)eye.y, 1.0, 1e-6);
    import_test_near((double)eye.z, 6.8, 1e-6);
    assert_true(look.z == -1.0f);
    scene_desc_destroy(desc);
}

static void test_peer_box(void **state)
{
    static const double low[3] = {-1.0, 0.0, -1.0}, high[3] = {1.0, 2.0, 1.0};
    (void)state;
    struct scene_desc *desc = load(SHARED_SCENES "peer-box/diffuse.pbrt");
    assert_int_equal(desc->shape_count, 4);
    assert_int_equal(triangles(desc), 36);
    bounds_are(desc, low, high);
    assert_int_equal(desc->log.count, 0);
    assert_true(desc->width == 256 && desc->max_depth == 6);
    struct vec3 right = xform_vector(&desc->camera.to_world, vec3(1, 0, 0));
    import_test_near((double)right.x, 1.0, 1e-6);
    scene_desc_destroy(desc);
    desc = load(SHARED_SCENES "peer-box/glass.pbrt");
    assert_int_equal(desc->shape_count, 5);
    assert_int_equal(triangles(desc), 24);
    assert_int_equal(desc->log.count, 0);
    assert_true(desc->shapes[3].kind == SHAPE_SPHERE && desc->shapes[3].radius == 0.35);
    assert_false(desc->shapes[3].reverse_orientation);
    assert_string_equal(material_of(desc, 3)->type->name, "dielectric");
    struct vec3 centre = xform_point(&desc->shapes[3].to_world, vec3(0, 0, 0));
    assert_true(centre.x == 0.35f && centre.y == 0.45f && centre.z == 0.3f);
    scene_desc_destroy(desc);
}

/* The larger ones: what is in them, and how many kinds of notes they leave. */
static void test_rooms(void **state)
{
    static const struct {
        const char *path;
        size_t shapes, lights, notes, pictures;
        int emitters;
        long triangles;
    } rows[] = {
        {"living-room-pbrt3/scene.pbrt", 65, 1, 2, 5, 0, 142973},
        {"contemporary-bathroom-pbrt3/contemporary-bathroom.pbrt", 874, 0, 9, 5, 5,
         601374},
        {"breakfast-pbrt3/breakfast.pbrt", 51, 1, 1, 2, 0, 533260},
        {"breakfast-pbrt3/breakfast-lamps.pbrt", 53, 0, 1, 2, 2, 533260},
        {"lux-luxtime/luxtime.lxs", 24, 0, 8, 3, 4, 185362},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char path[128];
        snprintf(path, sizeof path, SHARED_SCENES "%s", rows[i].path);
        struct scene_desc *desc = load(path);
        log_print(&desc->log, stdout);
        assert_int_equal(desc->shape_count, rows[i].shapes);
        assert_int_equal(desc->light_count, rows[i].lights);
        assert_int_equal(desc->textures.image_count, rows[i].pictures);
        assert_int_equal(emitters(desc), rows[i].emitters);
        assert_int_equal(triangles(desc), rows[i].triangles);
        assert_int_equal(desc->log.count, rows[i].notes);
        scene_desc_destroy(desc);
    }
}

/* The lamp's normals point down in all three, so that it shines into the room. */
static void test_lamps_shine_down(void **state)
{
    static const char *const paths[] = {SHARED_SCENES "peer-box/diffuse.pbrt",
                                        SHARED_SCENES "cornell-box-pbrt3/scene.pbrt"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct scene_desc *desc = load(paths[i]);
        const struct shape_desc *lamp = &desc->shapes[desc->shape_count - 1];
        const float *p = lamp->mesh->p;
        struct vec3 a = vec3(p[0], p[1], p[2]), b = vec3(p[3], p[4], p[5]);
        struct vec3 c = vec3(p[6], p[7], p[8]);
        float winding = vec3_cross(vec3_sub(b, a), vec3_sub(c, a)).y;
        float side = lamp->mesh->n ? lamp->mesh->n[1] : winding;
        assert_true(lamp->emits && !lamp->reverse_orientation && side < 0.0f);
        scene_desc_destroy(desc);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coffee),           cmocka_unit_test(test_cornell_box),
        cmocka_unit_test(test_peer_box),         cmocka_unit_test(test_rooms),
        cmocka_unit_test(test_lamps_shine_down),
    };
    return shared_scenes_there() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
}
