/* scene_build: what it refuses, what it notes, the emission scale, the needs; and the
 * scene description's own bookkeeping. */

#include "math/warp.h"
#include "support/scene_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/near.h"

static struct scene_desc *lit(void)
{
    struct scene_desc *desc = fixture_desc();
    fixture_mesh(desc, mesh_box());
    fixture_point_light(desc);
    return desc;
}

static void assert_refused(struct scene_desc *desc, enum err_code code, const char *says)
{
    struct err err = {0};
    struct scene_options options = {.threads = 1};
    assert_null(scene_build(desc, &options, &err));
    assert_int_equal(err.code, code);
    if (!strstr(err.message, says))
        fail_msg("\"%s\" does not say \"%s\"", err.message, says);
}

static void refusals(void **state)
{
    (void)state;
    struct scene_desc *desc = lit();
    desc->width = 0;
    assert_refused(desc, ERR_VALUE, "0 x 6");
    desc = lit();
    desc->camera.fov = 0.0;
    assert_refused(desc, ERR_VALUE, "no camera");
    desc = lit();
    desc->light_count = 0;
    assert_refused(desc, ERR_VALUE, "no emitter");
    desc = lit();
    desc->lights[0].intensity = rgb_grey(0.0);
    assert_refused(desc, ERR_VALUE, "no emitter");
    desc = lit();
    desc->shapes[0].mesh->p[4] = NAN;
    assert_refused(desc, ERR_VALUE, "vertex 1");
    desc = lit();
    desc->shapes[0].material = 1;
    assert_refused(desc, ERR_VALUE, "material 1");
    desc = lit();
    desc->shapes[0].material = -1;
    assert_refused(desc, ERR_VALUE, "material -1");
    desc = lit();
    desc->lights[0].intensity.g = (double)NAN;
    assert_refused(desc, ERR_VALUE, "intensity");
    desc = lit();
    desc->lights[0].to_world.m[1][3] = (double)INFINITY;
    assert_refused(desc, ERR_VALUE, "position");
    desc = lit();
    desc->shapes[0].emits = true;
    desc->shapes[0].radiance.b = (double)INFINITY;
    assert_refused(desc, ERR_VALUE, "radiance");
    desc = lit();
    desc->camera.to_world.m[0][0] = (double)NAN;
    assert_refused(desc, ERR_VALUE, "camera's transform");
    desc = lit();
    desc->camera.to_world.m[0][3] = 1e20;
    assert_refused(desc, ERR_VALUE, "the camera lies 1e+20 units");
    desc = lit();
    desc->lights[0].to_world.m[2][3] = -1e13;
    assert_refused(desc, ERR_VALUE, "a light lies 1e+13 units");
    desc = lit();
    desc->camera.fov = 1e-300;
    assert_refused(desc, ERR_VALUE, "too narrow");
    desc = lit();
    mesh_destroy(desc->shapes[0].mesh);
    desc->shapes[0].mesh = NULL;
    assert_refused(desc, ERR_VALUE, "mesh");
}

static long note_count(const struct scene *scene, const char *says)
{
    long sum = 0;
    for (size_t i = 0; i < scene->desc->log.count; i++)
        if (strstr(scene->desc->log.notes[i].text, says))
            sum += scene->desc->log.notes[i].count;
    return sum;
}

/* A lamp without power is no light, but the shape stays; a mesh whose triangles are all
 * degenerate is no obstacle. */
static void lights_without_power_go(void **state)
{
    (void)state;
    struct scene_desc *desc = lit();
    desc->shapes[0].emits = true;
    static const float line[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    struct shape_desc *thin = fixture_triangle(desc, line);
    thin->emits = true;
    thin->radiance = rgb_grey(1.0);
    struct light_desc negative = {.to_world = xform_identity(),
                                  .intensity = {-1.0, 0.0, 2.0}};
    scene_desc_add_light(desc, &negative);
    struct scene *scene = fixture_build(desc);
    assert_int_equal(scene->light_count, 2);
    assert_int_equal(scene->shapes[0].light, -1);
    assert_int_equal(scene->shapes[1].light, -1);
    assert_int_equal(note_count(scene, "without power"), 2);
    assert_int_equal(note_count(scene, "negative"), 1);
    assert_int_equal(note_count(scene, "degenerate"), 1);
    assert_true(scene->lights[1].radiance.r == 0.0);
    assert_near(scene->bounds_max.y, 1.0, 1e-6);
    scene_destroy(scene);
}

/* The largest component ends in [1,2), and every light is divided by the same power of
 * two: the rest of the program sees the same bits. */
/* A light too weak beside another to be chosen at all is told of. */
static void add_sky(struct scene_desc *desc, double radiance, bool map)
{
    struct light_desc light = {.type = &light_environment,
                               .intensity = rgb_grey(radiance),
                               .to_world = xform_identity()};
    if (map) {
        struct texture_image *image = texture_image_create(&desc->textures, 2, 1);
        for (int i = 0; i < 6; i++)
            image->floats[i] = 1.0f;
        light.map = image;
    }
    scene_desc_add_light(desc, &light);
}

/* Whatever the order; a light that stands between them keeps its place. */
static void the_brightest_environment_stays(void **state)
{
    (void)state;
    static const double radiance[][3] = {{1, 5, 2}, {5, 1, 2}, {1, 2, 5}};
    static const long notes[][2] = {{1, 1}, {2, 0}, {0, 2}}; /* the first, the second */
    for (int k = 0; k < 3; k++) {
        struct scene_desc *desc = lit();
        for (int i = 0; i < 3; i++)
            add_sky(desc, radiance[k][i], i != 1);
        struct scene *scene = fixture_build(desc);
        assert_int_equal(scene->light_count, 2);
        assert_ptr_equal(scene->environment, &scene->lights[1]);
        assert_ptr_equal(scene->lights[0].type, &light_point);
        double kept = scene->environment->radiance.g * scene->emission_scale;
        assert_near(kept, 5.0, 1e-12);
        assert_int_equal(scene->environment->environment.has_map, k != 0);
        assert_int_equal(note_count(scene, "kept, the first"), notes[k][0]);
        assert_int_equal(note_count(scene, "kept, the second"), notes[k][1]);
        scene_destroy(scene);
    }
}

static void light_never_sampled(void **state)
{
    (void)state;
    struct scene_desc *desc = lit();
    fixture_point_light(desc);
    desc->lights[0].intensity = rgb_grey(1.0);
    desc->lights[1].intensity = rgb_grey(1e-15);
    struct scene *scene = fixture_build(desc);
    assert_int_equal(note_count(scene, "never sampled"), 0);
    scene_destroy(scene);
    desc = lit();
    fixture_point_light(desc);
    desc->lights[0].intensity = rgb_grey(1.0);
    desc->lights[1].intensity = rgb_grey(1e-17);
    scene = fixture_build(desc);
    assert_int_equal(scene->light_count, 2);
    assert_int_equal(note_count(scene, "never sampled"), 1);
    scene_destroy(scene);
}

static void emission_scale_is_a_power_of_two(void **state)
{
    (void)state;
    static const double factors[] = {0x1p-100, 0x1p-3, 1.0, 0x1p99};
    for (size_t i = 0; i < 4; i++) {
        struct scene_desc *desc = lit();
        desc->lights[0].intensity = rgb(0.3 * factors[i], 17.3 * factors[i], 1e-3);
        desc->lights[0].intensity.b *= factors[i];
        struct scene *scene = fixture_build(desc);
        assert_true(scene->emission_scale == 16.0 * factors[i]);
        assert_true(scene->lights[0].radiance.r == 0.3 / 16.0);
        assert_true(scene->lights[0].radiance.g == 17.3 / 16.0);
        assert_true(scene->lights[0].radiance.b == 1e-3 / 16.0);
        scene_destroy(scene);
    }
    struct scene_desc *desc = lit();
    desc->lights[0].intensity = rgb_grey(8.0);
    struct scene *scene = fixture_build(desc);
    assert_true(scene->emission_scale == 8.0);
    scene_destroy(scene);
}

static void options_set_the_size(void **state)
{
    (void)state;
    struct scene_options options = {.width = 20, .height = 10, .threads = 1};
    struct scene *scene = scene_build(lit(), &options, NULL);
    assert_non_null(scene);
    assert_int_equal(scene->camera.width, 20);
    assert_int_equal(scene->camera.height, 10);
    assert_near(scene->camera.dx / scene->camera.dy, -2.0, 1e-12);
    scene_destroy(scene);
}

static void needs_of_a_plain_scene(void **state)
{
    (void)state;
    struct scene *scene = fixture_build(lit());
    struct needs n = scene->needs;
    assert_true(n.point_lights && n.rough_bsdfs && n.camera_connections &&
                n.light_connections);
    assert_false(n.area_lights || n.two_sided_lights || n.lens || n.delta_bsdfs ||
                 n.transmission || n.shading_normals || n.quadrics || n.robust ||
                 n.light_hits || n.uv || n.keep_all);
    char text[400];
    needs_left_out(&n, text, sizeof text);
    assert_non_null(strstr(text, "lens"));
    assert_null(strstr(text, "point lights"));
    char cut[8];
    needs_left_out(&n, cut, sizeof cut);
    assert_true(strlen(cut) < sizeof cut);
    scene_destroy(scene);
}

static void needs_of_a_rich_scene(void **state)
{
    (void)state;
    struct scene_desc *desc = lit();
    int glass = fixture_material(desc, "dielectric");
    struct shape_desc *sphere = fixture_quadric(desc, SHAPE_SPHERE, xform_identity());
    sphere->material = glass;
    struct shape_desc *lampshade = fixture_mesh(desc, mesh_rectangle());
    lampshade->emits = lampshade->two_sided = true;
    lampshade->radiance = rgb_grey(1.0);
    static const float needle[9] = {0, 0, 0, 1, 0, 0, 0.5f, 1e-5f, 0};
    fixture_triangle(desc, needle);
    desc->camera.lens_radius = 0.1;
    desc->camera.focus_distance = 1.0;
    struct scene *scene = fixture_build(desc);
    struct needs n = scene->needs;
    assert_true(n.area_lights && n.two_sided_lights && n.lens && n.delta_bsdfs &&
                n.transmission && n.lobes && n.quadrics && n.robust && n.light_hits);
    scene_destroy(scene);
}

/* Every flag has its row, and keep_all sets them all. */
static void rows_cover_all_flags(void **state)
{
    (void)state;
    struct scene_options options = {.keep_all = true, .threads = 1};
    struct scene *scene = scene_build(lit(), &options, NULL);
    assert_non_null(scene);
    size_t rows = 0;
    for (const struct needs_row *row = needs_rows; row->name; row++) {
        assert_int_equal(row->offset, rows * sizeof(bool));
        assert_true(needs_get(&scene->needs, row));
        rows++;
    }
    assert_int_equal(rows + 1, sizeof(struct needs) / sizeof(bool)); /* keep_all */
    assert_true(scene->needs.keep_all);
    char text[40];
    needs_left_out(&scene->needs, text, sizeof text);
    assert_string_equal(text, "nothing");
    scene_destroy(scene);
}

static void desc_keeps_what_it_is_given(void **state)
{
    (void)state;
    struct scene_desc *desc = scene_desc_create("a/b.pbrt");
    char name[] = "c.pbrt";
    const char *kept = scene_desc_keep(desc, name);
    assert_ptr_not_equal(kept, name);
    for (int i = 0; i < 100; i++) {
        char other[16];
        snprintf(other, sizeof other, "%d", i);
        scene_desc_keep(desc, other);
    }
    assert_ptr_equal(scene_desc_keep(desc, "c.pbrt"), kept);
    assert_null(scene_desc_keep(desc, NULL));
    struct place at = {name, 4, 2};
    scene_desc_add_setting(desc, "chains", "12", &at);
    name[0] = 'x';
    assert_string_equal(desc->settings[0].key, "chains");
    assert_string_equal(desc->settings[0].value, "12");
    assert_string_equal(desc->settings[0].place.file, "c.pbrt");
    assert_string_equal(desc->path, "a/b.pbrt");
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refusals),
        cmocka_unit_test(lights_without_power_go),
        cmocka_unit_test(the_brightest_environment_stays),
        cmocka_unit_test(light_never_sampled),
        cmocka_unit_test(emission_scale_is_a_power_of_two),
        cmocka_unit_test(options_set_the_size),
        cmocka_unit_test(needs_of_a_plain_scene),
        cmocka_unit_test(needs_of_a_rich_scene),
        cmocka_unit_test(rows_cover_all_flags),
        cmocka_unit_test(desc_keeps_what_it_is_given),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
