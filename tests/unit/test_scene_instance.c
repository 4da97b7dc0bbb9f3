/* scene/placement, instance: what rays find on instances is what they find on copies, and
 * on the object itself through the transform; lamps, memory, bad input. */
#include "base/machine.h"
#include "math/rng.h"
#include "math/warp.h"
#include "scene/memory.h"
#include "support/instance_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define RAYS 40000

/* All that hits tell of is there: flat and smooth meshes, with parameters, bumps and
 * frames along them, masks, quadrics. */
static struct parts all_parts(void)
{
    static const double profile[] = {0.5, 0.0, 1.0, 0.6, 0.4, 1.2};
    struct parts parts = {.count = 0};
    struct xform at[] = {instance_way(0.5, 0.4, 0.3, 10.0, -1.5, 0.0, 0.0),
                         instance_way(0.6, 0.6, 0.6, 30.0, 0.0, 0.5, 0.0),
                         instance_way(0.5, 0.5, 0.5, 50.0, 1.5, 0.0, 0.2),
                         instance_way(0.6, 0.6, 0.6, 70.0, 0.0, -1.2, 0.4),
                         instance_way(0.3, 0.3, 0.5, 90.0, -1.2, -1.0, 0.8),
                         instance_way(0.6, 0.6, 0.6, 20.0, 1.2, 1.1, -0.7)};
    parts_add(&parts, mesh_box(), SHAPE_MESH, &at[0], INSTANCE_BUMPED);
    parts_add(&parts, mesh_lathe(profile, 3, 24, true, 60.0), SHAPE_MESH, &at[1],
              INSTANCE_BRUSHED);
    parts_add(&parts, NULL, SHAPE_SPHERE, &at[2], INSTANCE_GLASS);
    parts_add(&parts, NULL, SHAPE_DISK, &at[3], INSTANCE_BRUSHED);
    parts_add(&parts, NULL, SHAPE_CYLINDER, &at[4], INSTANCE_BRUSHED);
    parts_add(&parts, mesh_rectangle(), SHAPE_MESH, &at[5], INSTANCE_MASKED)
        ->reverse_orientation = true;
    return parts;
}

static struct scene *scene_of(bool copied, const struct xform *inner, int inner_count,
                              const struct xform *outer, int outer_count)
{
    struct scene_desc *desc = fixture_desc();
    struct parts parts = all_parts();
    instance_materials(desc);
    fixture_point_light(desc);
    parts_put(desc, copied, &parts, inner, inner_count, outer, outer_count);
    parts_deinit(&parts);
    return fixture_build(desc);
}

static struct ray_endpoint random_ray(struct rng *rng, const struct scene *scene,
                                      struct vec3 *w)
{
    struct vec3 lo = scene->bounds_min, size = vec3_sub(scene->bounds_max, lo);
    double u[2] = {rng_double(rng), rng_double(rng)};
    struct vec3 p = {lo.x + size.x * (float)rng_double(rng),
                     lo.y + size.y * (float)rng_double(rng),
                     lo.z + size.z * (float)rng_double(rng)};
    *w = warp_sphere(u);
    return (struct ray_endpoint){.p = p};
}

static double apart(struct vec3 a, struct vec3 b)
{
    return (double)vec3_max_abs(vec3_sub(a, b));
}

/* Shapes are some units wide, at most 20 from the origin, and the ray 30 long: places are
 * rounded to 2^-24 of that, at most a thousandth as exact across a grazing ray. Along the
 * normal, the two agree within their offsets. Normals come from corners rounded to 2^-20,
 * of edges no shorter than .1. */
static bool agree(const struct hit *a, const struct hit *b)
{
    struct vec3 between = vec3_sub(a->at.p, b->at.p);
    double along = fabs((double)vec3_dot(between, b->at.ng));
    return along <= (double)(a->at.offset + b->at.offset) &&
           apart(a->at.p, b->at.p) < 2e-3 && apart(a->at.ng, b->at.ng) < 1e-4 &&
           apart(a->shading.n, b->shading.n) < 2e-3 &&
           apart(a->shading.s, b->shading.s) < 5e-3 &&
           apart(a->shading.t, b->shading.t) < 5e-3 &&
           fabs((double)(a->u - b->u)) < 2e-3 && fabs((double)(a->v - b->v)) < 2e-3;
}

/* Of rays that pass an edge within rounding each scene may say something else: one hit in
 * a thousand. */
static void same_hits(const struct scene *a, const struct scene *b, uint64_t seed)
{
    struct rng rng;
    rng_init(&rng, seed, RNG_TEST, 0);
    int hits = 0, other = 0;
    for (int i = 0; i < RAYS; i++) {
        struct hit ha, hb;
        struct vec3 w;
        struct ray_endpoint from = random_ray(&rng, b, &w);
        bool in_a = accel_intersect(a, &from, w, &ha),
             in_b = accel_intersect(b, &from, w, &hb);
        bool same = in_a == in_b && (!in_a || ha.bsdf->type == hb.bsdf->type);
        hits += in_b;
        if (same && in_a)
            same = agree(&ha, &hb);
        other += !same;
        struct ray_endpoint to = {.p = vec3_mad(from.p, 30.0f, w)};
        other += accel_visible(a, &from, &to) != accel_visible(b, &from, &to);
    }
    printf("    %d hits, %d differ\n", hits, other);
    assert_true(hits > RAYS / 20);
    assert_true(other <= hits / 1000);
}

static void hits_equal_those_of_copies(void **state)
{
    (void)state;
    const struct xform even[] = {instance_way(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0),
                                 instance_way(2.0, 2.0, 2.0, 40.0, 7.0, 1.0, 2.0),
                                 instance_way(-0.5, 0.5, 0.5, 140.0, 1.0, -6.0, 2.0)};
    const struct xform inner[] = {instance_way(1.0, 1.0, 1.0, 25.0, 2.0, 0.0, 0.0),
                                  instance_way(0.5, -0.5, 0.5, 0.0, -2.0, 1.0, 0.0)};
    struct scene *instances = scene_of(false, NULL, 0, even, 3);
    struct scene *copies = scene_of(true, NULL, 0, even, 3);
    assert_int_equal(instances->instance_count, 3);
    assert_int_equal(instances->desc->shape_count, 6);
    assert_int_equal(copies->instance_count, 0);
    assert_int_equal(copies->desc->shape_count, 18);
    same_hits(instances, copies, 1);
    scene_destroy(instances);
    scene_destroy(copies);
    instances = scene_of(false, inner, 2, even, 3);
    copies = scene_of(true, inner, 2, even, 3);
    assert_int_equal(instances->instance_count, 6);
    assert_int_equal(instances->desc->shape_count, 6);
    same_hits(instances, copies, 2);
    scene_destroy(instances);
    scene_destroy(copies);
}

/* --- through the transform --------------------------------------------------------- */

static struct vec3 unit(double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    return vec3((float)(x / length), (float)(y / length), (float)(z / length));
}

/* n by the inverse transpose, in doubles, by hand. */
static struct vec3 through(const struct xform *way, struct vec3 n)
{
    double m[3];
    for (int i = 0; i < 3; i++)
        m[i] = way->inv[0][i] * (double)n.x + way->inv[1][i] * (double)n.y +
               way->inv[2][i] * (double)n.z;
    return unit(m[0], m[1], m[2]);
}

/* Sheared, uneven, mirrored: what a ray finds is what its counterpart finds on the object
 * in its own space. Frames along parameters: s is dp/du less what of it lies along n. No
 * bumps here, which are measured in the world. */
static void hits_go_through_the_transform(void **state)
{
    (void)state;
    struct xform shear;
    const double m[16] = {1.0, 0.7, 0.0, 1.0, 0.0, -0.4, 0.3, 2.0,
                          0.2, 0.0, 2.0, 3.0, 0.0, 0.0,  0.0, 1.0};
    assert_true(xform_from_matrix(m, &shear));
    const struct xform ways[2] = {shear,
                                  instance_way(1.0, 1.0, 1.0, 0.0, 500.0, 0.0, 0.0)};
    const struct xform one = xform_identity();
    struct scene *placed = scene_of(false, NULL, 0, ways, 2);
    struct scene *object = scene_of(true, NULL, 0, &one, 1);
    assert_int_equal(placed->instance_count, 2);
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    int hits = 0, other = 0;
    for (int i = 0; i < RAYS; i++) {
        struct hit a, b;
        struct vec3 w;
        struct ray_endpoint inside = random_ray(&rng, object, &w);
        struct vec3 out = xform_vector(&shear, w);
        struct ray_endpoint from = {.p = xform_point(&shear, inside.p)};
        out = unit((double)out.x, (double)out.y, (double)out.z);
        bool in_a = accel_intersect(placed, &from, out, &a),
             in_b = accel_intersect(object, &inside, w, &b);
        if (in_a && vec3_max_abs(a.at.p) > 100.0f)
            continue; /* the other instance */
        bool same = in_a == in_b && (!in_a || a.bsdf->type == b.bsdf->type);
        hits += in_b;
        if (same && in_a && !b.bsdf->relief.texture) {
            struct vec3 n = through(&shear, b.shading.n), ng = through(&shear, b.at.ng);
            if (vec3_dot(n, ng) < 0.0f)
                ng = vec3_neg(ng);
            same = apart(a.at.p, xform_point(&shear, b.at.p)) < 1e-3 &&
                   apart(a.at.ng, ng) < 1e-4 && apart(a.shading.n, n) < 1e-3 &&
                   fabs((double)(a.u - b.u)) < 1e-3 && fabs((double)(a.v - b.v)) < 1e-3;
        }
        other += !same;
    }
    printf("    %d hits, %d differ\n", hits, other);
    assert_true(hits > RAYS / 20);
    assert_true(other <= hits / 1000);
    scene_destroy(placed);
    scene_destroy(object);
}

/* On a flat mesh and on quadrics, copies say the same of uneven transforms, frames and
 * bumps too. */
static void uneven_hits_equal_those_of_copies(void **state)
{
    (void)state;
    struct parts parts = all_parts();
    mesh_destroy(parts.part[1].mesh);
    parts.part[1] = parts.part[--parts.count];
    const struct xform ways[] = {instance_way(1.0, 0.4, 2.0, 0.0, 0.0, 0.0, 0.0),
                                 instance_way(2.0, -0.7, 1.0, 40.0, 7.0, 1.0, 2.0)};
    struct scene *scene[2];
    for (int copied = 0; copied < 2; copied++) {
        struct scene_desc *desc = fixture_desc();
        instance_materials(desc);
        fixture_point_light(desc);
        parts_put(desc, copied, &parts, NULL, 0, ways, 2);
        scene[copied] = fixture_build(desc);
    }
    assert_int_equal(scene[0]->instance_count, 2);
    same_hits(scene[0], scene[1], 4);
    scene_destroy(scene[0]);
    scene_destroy(scene[1]);
    parts_deinit(&parts);
}

/* --- lamps, memory ----------------------------------------------------------------- */

static void lamps_are_copied(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    struct parts parts = {.count = 0};
    const struct xform one = xform_identity();
    struct shape_desc *lamp = parts_add(&parts, mesh_rectangle(), SHAPE_MESH, &one, 0);
    lamp->emits = true;
    lamp->radiance = rgb_grey(1.0);
    parts_add(&parts, mesh_box(), SHAPE_MESH, &one, 0);
    const struct xform ways[] = {instance_way(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 5.0),
                                 instance_way(2.0, 3.0, -1.0, 0.0, 9.0, 0.0, 0.0)};
    parts_put(desc, false, &parts, NULL, 0, ways, 2);
    parts_deinit(&parts);
    struct scene *scene = fixture_build(desc);
    assert_int_equal(scene->light_count, 2);
    assert_int_equal(scene->instance_count, 2);
    assert_int_equal(scene->desc->shape_count, 3);
    assert_float_equal(scene->lights[0].area, 4.0, 1e-5);
    assert_float_equal(scene->lights[1].area, 24.0, 1e-5);
    for (int i = 0; i < 2; i++) {
        const double u[2] = {0.3, 0.6};
        struct ray_endpoint point;
        scene->lights[i].type->sample_point(scene, &scene->lights[i], u, &point);
        /* It shone up; where the transform mirrors z, down. */
        assert_float_equal(point.ng.z, i == 0 ? 1.0f : -1.0f, 1e-6f);
        assert_float_equal(point.p.z, i == 0 ? 5.0f : 0.0f, 1e-5f);
    }
    scene_destroy(scene);
}

/* An object that lies in the scene once is moved: no ray pays for an instance. */
static void single_objects_are_moved(void **state)
{
    (void)state;
    const struct xform way = instance_way(1.0, 1.0, 1.0, 0.0, 3.0, 0.0, 0.0);
    struct scene *scene = scene_of(false, &way, 1, &way, 1);
    assert_int_equal(scene->instance_count, 0);
    assert_int_equal(scene->objects[0].shape_count, 6);
    assert_true((double)scene->bounds_min.x > 3.0);
    scene_destroy(scene);
}

/* AUTO: boxes of 12 triangles, and 16 for the shape. */
static void few_triangles_are_copied(void **state)
{
    (void)state;
    for (int many = 0; many < 2; many++) {
        const int most = 131072 / 28;
        struct scene_desc *desc = fixture_desc();
        struct parts parts = {.count = 0};
        const struct xform one = xform_identity();
        fixture_point_light(desc);
        parts_add(&parts, mesh_box(), SHAPE_MESH, &one, 0);
        int object = parts_add_object(desc, &parts);
        parts_deinit(&parts);
        for (int i = 0; i < most + many; i++) {
            struct xform way = xform_translate(3.0 * i, 0.0, 0.0);
            parts_add_instance(desc, object, 0, &way);
        }
        struct scene_options options = {.threads = 1};
        struct scene *scene = scene_build(desc, &options, NULL);
        assert_non_null(scene);
        assert_int_equal(scene->instance_count, many ? most + 1 : 0);
        assert_int_equal(scene->desc->shape_count, many ? 1 : most);
        scene_destroy(scene);
    }
}

/* Where no float would hold what becomes of directions, shapes are copied. */
static void extreme_instances_are_copied(void **state)
{
    (void)state;
    const struct xform ways[] = {instance_way(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0),
                                 instance_way(1.0, 1.0, 1.0, 0.0, 9.0, 0.0, 0.0),
                                 instance_way(1.0, 1.0, 1e-5, 0.0, 0.0, 9.0, 0.0),
                                 instance_way(1e6, 1e6, 1e6, 0.0, 0.0, 0.0, 3e6)};
    struct scene *scene = scene_of(false, NULL, 0, ways, 4);
    assert_int_equal(scene->instance_count, 2);
    assert_int_equal(scene->objects[0].shape_count, 12);
    scene_destroy(scene);
}

static void triangles_are_kept_once(void **state)
{
    (void)state;
    static const double profile[] = {0.5, 0.0, 1.0, 0.6, 0.4, 1.2};
    size_t geometry[2];
    for (int many = 0; many < 2; many++) {
        struct scene_desc *desc = fixture_desc();
        struct parts parts = {.count = 0};
        const struct xform one = xform_identity();
        fixture_point_light(desc);
        parts_add(&parts, mesh_lathe(profile, 3, 4000, true, 60.0), SHAPE_MESH, &one, 0);
        int object = parts_add_object(desc, &parts);
        for (int i = 0; i < (many ? 1000 : 2); i++) {
            struct xform way = instance_way(1.0, 1.0, 1.0, 5.0 * i, 3.0 * i, 0.0, 0.0);
            parts_add_instance(desc, object, 0, &way);
        }
        parts_deinit(&parts);
        struct scene *scene = fixture_build(desc);
        struct memory memory = memory_of_scene(scene);
        geometry[many] = memory.geometry;
        assert_int_equal(scene->instance_count, many ? 1000 : 2);
        /* 16000 triangles, and a leaf and less than a node for each instance */
        assert_true((double)memory.bvh < 2e6 + (many ? 1000.0 * 400.0 : 0.0));
        scene_destroy(scene);
    }
    assert_int_equal(geometry[1] - geometry[0], 998 * sizeof(struct instance));
}

/* --- a lamp upon an instance ------------------------------------------------------- */

static bool lamp_is_noted(double height)
{
    struct scene_desc *desc = fixture_desc();
    struct parts parts = {.count = 0};
    const struct xform tilt = xform_rotate(30.0, 1.0, 0.0, 0.0);
    struct xform back = xform_inverse(&tilt), grow = xform_scale(4.0, 4.0, 1.0);
    const struct xform ways[] = {xform_mul(&grow, &back),
                                 xform_translate(0.0, 0.0, 50.0)};
    parts_add(&parts, mesh_rectangle(), SHAPE_MESH, &tilt, 0);
    parts_put(desc, false, &parts, NULL, 0, ways, 2);
    parts_deinit(&parts);
    struct mesh *lamp = mesh_rectangle();
    struct xform up = xform_translate(0.0, 0.0, height);
    mesh_transform(lamp, &up);
    struct shape_desc *shape = fixture_mesh(desc, lamp);
    shape->emits = true;
    shape->radiance = rgb_grey(1.0);
    struct scene *scene = fixture_build(desc);
    assert_int_equal(scene->instance_count, 2);
    bool noted = false;
    for (size_t i = 0; i < scene->desc->log.count; i++)
        noted |= strstr(scene->desc->log.notes[i].text, "lies upon another") != NULL;
    scene_destroy(scene);
    return noted;
}

static void lamps_upon_instances_are_noted(void **state)
{
    (void)state;
    assert_true(lamp_is_noted(0.0));
    assert_false(lamp_is_noted(0.1));
}

/* --- bad input --------------------------------------------------------------------- */

static void refused(struct scene_desc *desc, enum err_code code, const char *message)
{
    struct err err = {0};
    struct scene_options options = {.threads = 1};
    struct scene *scene = scene_build(desc, &options, &err);
    assert_null(scene);
    assert_int_equal(err.code, code);
    assert_int_equal(err.line, 1);
    if (!strstr(err.message, message))
        fail_msg("%s", err.message);
}

static struct scene_desc *boxes(int objects)
{
    struct scene_desc *desc = fixture_desc();
    struct parts parts = {.count = 0};
    const struct xform one = xform_identity();
    fixture_point_light(desc);
    parts_add(&parts, mesh_box(), SHAPE_MESH, &one, 0);
    for (int i = 0; i < objects; i++)
        parts_add_object(desc, &parts);
    parts_deinit(&parts);
    return desc;
}

static void bad_input_is_told(void **state)
{
    (void)state;
    struct xform one = xform_identity(), flat = xform_scale(1.0, 0.0, 1.0);
    struct scene_desc *desc = boxes(1);
    parts_add_instance(desc, 2, 0, &one);
    refused(desc, ERR_VALUE, "names object 2 of 1");
    desc = boxes(1);
    parts_add_instance(desc, 1, 0, &flat);
    refused(desc, ERR_VALUE, "invertible");
    desc = boxes(1);
    parts_add_instance(desc, 1, 1, &one);
    refused(desc, ERR_VALUE, "contains itself");
    desc = boxes(4); /* 1 > 2 > 3 > 2, and 4 hangs on it */
    parts_add_instance(desc, 1, 0, &one);
    parts_add_instance(desc, 2, 1, &one);
    parts_add_instance(desc, 3, 2, &one);
    parts_add_instance(desc, 2, 3, &one);
    parts_add_instance(desc, 4, 3, &one);
    refused(desc, ERR_VALUE, "contains itself");
}

/* 10 in each of 12: 10^12 would take as many records; nothing is taken. */
static void too_many_are_refused_beforehand(void **state)
{
    (void)state;
    struct scene_desc *desc = boxes(12);
    double before = machine_memory_peak();
    for (int o = 1; o <= 12; o++)
        for (int i = 0; i < 10; i++) {
            struct xform way = xform_translate(pow(10.0, 12 - o) * i, 0.0, 0.0);
            parts_add_instance(desc, o, o - 1, &way);
        }
    refused(desc, ERR_MEMORY, "1.111e+12 instances");
    assert_true(machine_memory_peak() - before < 1e7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_equal_those_of_copies),
        cmocka_unit_test(hits_go_through_the_transform),
        cmocka_unit_test(uneven_hits_equal_those_of_copies),
        cmocka_unit_test(lamps_are_copied),
        cmocka_unit_test(single_objects_are_moved),
        cmocka_unit_test(few_triangles_are_copied),
        cmocka_unit_test(extreme_instances_are_copied),
        cmocka_unit_test(triangles_are_kept_once),
        cmocka_unit_test(lamps_upon_instances_are_noted),
        cmocka_unit_test(bad_input_is_told),
        cmocka_unit_test(too_many_are_refused_beforehand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
