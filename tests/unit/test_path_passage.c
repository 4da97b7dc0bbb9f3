/* What edges pass: path/passage.h. Values are known in closed form: at normal incidence a
 * pane of index n lets 2n / (n^2 + 1) through (the two faces' reflections summed).
 *
 * All statements are exact up to rounding: no false alarms. */

#include "math/warp.h"
#include "path/connect.h"
#include "path/estimate.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define ETA    1.5
#define PASSES (2.0 * ETA / (ETA * ETA + 1.0))

/* Numbers that stay where they are. */
struct fixed_stream {
    struct ustream stream; /* must be first */
    double value[64];
    long taken;
};

static const double *fixed_take(struct ustream *self, int place, int count)
{
    struct fixed_stream *s = (struct fixed_stream *)self;
    s->taken += count;
    return s->value + place;
}

static struct fixed_stream fixed(double value)
{
    struct fixed_stream s = {.stream = {fixed_take}};
    for (int i = 0; i < 64; i++)
        s.value[i] = value;
    return s;
}

/* Sheets between z = 1 and 2, floor at z = 0, seen from z = 3 along -z. */
static void add_sheets(struct scene_desc *desc, int material, int count)
{
    for (int i = 0; i < count; i++)
        test_quad(desc, vec3(0, 0, 1.0f + (float)(i + 1) / (float)(count + 1)),
                  vec3(4, 0, 0), vec3(0, 4, 0), material, rgb_grey(0.0));
}

static struct scene_desc *floor_desc(void)
{
    double up[3] = {0.0, 1.0, 0.0}, eye[3] = {0.0, 0.0, 3.0}, target[3] = {0.0};
    struct scene_desc *desc = test_desc(vec3(0, 1, 3), vec3(0, 1, 0), 20.0, 1);
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    test_quad(desc, vec3(0, 0, 0), vec3(4, 0, 0), vec3(0, 4, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    return desc;
}

static int pane(struct scene_desc *desc)
{
    return test_material(desc, "thindielectric", NULL, rgb_grey(1.0), "eta", ETA);
}

/* A point light beside the camera lights the middle of the floor through `count` panes,
 * which the camera ray passes with the chance T^count and weight 1. */
static double middle_of_floor(int count)
{
    enum { LOBES = 4000 };
    struct scene_desc *desc = floor_desc();
    struct subpaths paths;
    struct contrib out;
    double sum = 0.0;
    add_sheets(desc, pane(desc), count);
    test_point_light(desc, vec3(0, 0, 3), rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    struct fixed_stream camera = fixed(0.5), other = fixed(0.5);
    struct numbers numbers = {&camera.stream, &other.stream, &other.stream};
    subpaths_init(&paths, scene, 2);
    contrib_init(&out, estimate_splats(2));
    for (int i = 0; i < LOBES; i++) {
        camera.value[DIMS_CAMERA_VERTEX] = (i + 0.5) / LOBES;
        estimate_pt(&paths, &numbers, &out);
        sum += out.target / LOBES * scene->emission_scale;
    }
    contrib_deinit(&out);
    subpaths_deinit(&paths);
    scene_destroy(scene);
    return sum;
}

static void test_irradiance_times_transmittance(void **state)
{
    (void)state;
    /* rho / pi I / d^2, by the number of panes on the way there and on the way back. */
    double bare = 0.5 / MATH_PI / 9.0;
    for (int count = 0; count <= 3; count++) {
        double exact = bare * pow(PASSES, 2 * count), got = middle_of_floor(count);
        printf("%d panes: %.8f, exact %.8f\n", count, got, exact);
        assert_true(fabs(got / exact - 1.0) < 1e-3);
    }
    assert_true(fabs(middle_of_floor(0) / bare - 1.0) < 1e-6);
}

/* The camera's t = 1 and the inner connections: the same sub-paths in a scene with two
 * tinted filters and in one without, whose values differ by both tints. */
static const struct rgb tint = {0.25, 0.5, 0.75};

static struct scene *filtered(bool filters)
{
    struct scene_desc *desc = floor_desc();
    int null = test_material(desc, "null", "transmittance", tint, NULL, 0.0);
    int wall = test_diffuse(desc, 0.5, 0.5, 0.5);
    if (filters)
        add_sheets(desc, null, 2);
    test_quad(desc, vec3(0, 0, 2.5f), vec3(0.02f, 0, 0), vec3(0, 0.02f, 0), wall,
              rgb_grey(0.0));
    test_point_light(desc, vec3(1, 0.5f, 0.5f), rgb_grey(1.0));
    return test_build(desc, false);
}

static void assert_tinted(struct rgb with, struct rgb without)
{
    struct rgb two = rgb_mul(tint, tint), expected = rgb_mul(without, two);
    assert_true(!rgb_is_black(without));
    assert_true(fabs(with.r - expected.r) <= 1e-9 * expected.r &&
                fabs(with.g - expected.g) <= 1e-9 * expected.g &&
                fabs(with.b - expected.b) <= 1e-9 * expected.b);
}

/* Light vertex 1 on the floor, beside what the camera sees of the wall: seen by the
 * camera beside the wall, and connected to the wall's lower side. */
static void test_connections_pass(void **state)
{
    (void)state;
    struct connection camera[2], surfaces[2];
    for (int i = 0; i < 2; i++) {
        struct scene *scene = filtered(i == 1);
        struct subpaths paths;
        struct fixed_stream numbers = fixed(0.5);
        subpaths_init(&paths, scene, 4);
        walk_camera(&paths, &numbers.stream, 2, HIT_ANY);
        assert_int_equal(paths.camera_count, 2);
        struct vertex y = {.kind = VERTEX_SURFACE,
                           .connectible = true,
                           .end_chance = 1.0,
                           .prev_connects = 1.0,
                           .adjoint = 1.0,
                           .throughput = rgb_grey(1.0),
                           .pdf_fwd = 1.0};
        struct ray_endpoint above = {.p = {0.3f, 0.3f, 0.5f}};
        assert_true(accel_intersect(scene, &above, vec3(0, 0, -1), &y.hit));
        y.wo = y.wo_local = vec3(0, 0, 1);
        y.cos_wo = 1.0f;
        assert_int_equal(connect_camera(&paths, &y, &camera[i]), FAILURE_NONE);
        /* The wall is seen from behind: its lower side is that of a second vertex. */
        struct vertex z = paths.camera[1];
        z.wo = vec3(0, 0, -1);
        z.wo_local.z = -z.wo_local.z;
        z.cos_wo = -z.cos_wo;
        assert_int_equal(connect_surfaces(&paths, &y, &z, &surfaces[i]), FAILURE_NONE);
        subpaths_deinit(&paths);
        scene_destroy(scene);
    }
    assert_tinted(camera[1].value, camera[0].value);
    assert_tinted(surfaces[1].value, surfaces[0].value);
    assert_int_equal(camera[0].pixel, camera[1].pixel);
}

/* A card of which a share a is there, over a floor of which a share b is a mirror: one
 * number decides about both, and each outcome has its share of it. Pure null takes none.
 */
static void test_one_number_decides(void **state)
{
    (void)state;
    enum { LOBES = 10000 };
    const double passes = 0.3;
    struct scene_desc *desc = floor_desc();
    struct rgb dark = {0.0, 0.0, 0.0};
    int card = test_material(desc, "uber", "opacity", rgb_grey(1.0 - passes), "kr", 0.0);
    int mixed = test_material(desc, "uber", "kr", rgb_grey(0.8), NULL, 0.0);
    int null = test_material(desc, "null", NULL, dark, NULL, 0.0);
    test_quad(desc, vec3(0, 0, 0.1f), vec3(4, 0, 0), vec3(0, 4, 0), mixed, dark);
    add_sheets(desc, card, 1);
    add_sheets(desc, null, 4);
    test_point_light(desc, vec3(0, 0, 1.2f), rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    double chance = desc->materials[card].param[23]; /* of passing: bsdf_uber.c */
    double mirror = desc->materials[mixed].param[26];
    struct subpaths paths;
    struct fixed_stream numbers = fixed(0.5);
    int passed = 0, mirrored = 0;
    subpaths_init(&paths, scene, 3);
    for (int i = 0; i < LOBES; i++) {
        numbers.value[DIMS_CAMERA_VERTEX] = (i + 0.5) / LOBES;
        numbers.taken = 0;
        walk_camera(&paths, &numbers.stream, 3, HIT_ANY);
        /* Film; lobe and direction; the lobe of vertex 2 if the card is on its way. */
        assert_true(numbers.taken == 2 + 3 || numbers.taken == 2 + 3 + 1);
        assert_true(paths.camera_count >= 2);
        const struct vertex *v = &paths.camera[1];
        bool at_floor = v->hit.at.p.z < 0.5f;
        passed += at_floor;
        mirrored += at_floor && v->delta_event;
        assert_true(v->end_chance == (at_floor ? 1.0 : 1.0 - chance));
    }
    printf("passed %d of %d, mirrored %d\n", passed, LOBES, mirrored);
    assert_true(fabs(passed - chance * LOBES) <= 1.0);
    assert_true(fabs(mirrored - chance * mirror * LOBES) <= 2.0);
    subpaths_deinit(&paths);
    scene_destroy(scene);
}

/* An edge passes PASSAGE_MOST surfaces; with one more it is cut and counted, by walks and
 * by connections. */
static void test_bound(void **state)
{
    (void)state;
    for (int more = 0; more < 2; more++) {
        struct scene_desc *desc = floor_desc();
        int null = test_material(desc, "null", NULL, rgb_grey(0.0), NULL, 0.0);
        add_sheets(desc, null, PASSAGE_MOST + more);
        test_point_light(desc, vec3(1, 1, 2.5f), rgb_grey(1.0));
        struct scene *scene = test_build(desc, false);
        struct subpaths paths;
        struct fixed_stream numbers = fixed(0.5);
        struct connection x;
        const double u[3] = {0.5, 0.5, 0.5};
        subpaths_init(&paths, scene, 3);
        walk_camera(&paths, &numbers.stream, 2, HIT_ANY);
        assert_int_equal(paths.camera_count, 2 - more);
        assert_int_equal(*scene->edges_cut, more);
        struct vertex z = {.kind = VERTEX_SURFACE, .end_chance = 1.0};
        struct ray_endpoint above = {.p = {0.3f, 0.3f, 0.5f}};
        assert_true(accel_intersect(scene, &above, vec3(0, 0, -1), &z.hit));
        z.wo = z.wo_local = vec3(0, 0, 1);
        z.cos_wo = 1.0f;
        z.throughput = rgb_grey(1.0);
        z.pdf_fwd = 1.0;
        assert_int_equal(connect_light(&paths, u, &z, MIS_BIDIRECTIONAL, &x, NULL),
                         more ? FAILURE_BLOCKED : FAILURE_NONE);
        assert_int_equal(*scene->edges_cut, 2 * more);
        subpaths_deinit(&paths);
        scene_destroy(scene);
    }
}

/* A lamp that light could pass stays a vertex and blocks connections. */
static void test_lamps_are_vertices(void **state)
{
    (void)state;
    struct scene_desc *desc = floor_desc();
    int null = test_material(desc, "null", NULL, rgb_grey(0.0), NULL, 0.0);
    test_quad(desc, vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0), null, rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    struct subpaths paths;
    struct fixed_stream numbers = fixed(0.5);
    assert_false(scene->needs.straight);
    assert_true(scene->needs.delta_bsdfs);
    subpaths_init(&paths, scene, 3);
    walk_camera(&paths, &numbers.stream, 3, HIT_ANY);
    assert_int_equal(paths.camera_count, 3);
    assert_non_null(paths.camera[1].light);
    assert_true(paths.camera[1].delta_event);
    subpaths_deinit(&paths);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_irradiance_times_transmittance),
        cmocka_unit_test(test_connections_pass),
        cmocka_unit_test(test_one_number_decides),
        cmocka_unit_test(test_bound),
        cmocka_unit_test(test_lamps_are_vertices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
