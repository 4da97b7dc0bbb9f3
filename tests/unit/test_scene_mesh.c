/* Meshes: checks and repairs, and the solids that are made of them. */

#include "base/mem.h"
#include "scene/mesh.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "support/near.h"

static struct vec3 corner(const struct mesh *mesh, const float *array, uint32_t triangle,
                          int k)
{
    const float *v = array + 3 * (size_t)mesh->index[3 * (size_t)triangle + (size_t)k];
    return vec3(v[0], v[1], v[2]);
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Every directed edge a -> b, by position, has exactly one partner b -> a. */
static void assert_watertight(const struct mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 a = corner(mesh, mesh->p, i, k);
            struct vec3 b = corner(mesh, mesh->p, i, (k + 1) % 3);
            int partners = 0, copies = 0;
            for (uint32_t j = 0; j < mesh->triangle_count; j++)
                for (int l = 0; l < 3; l++) {
                    struct vec3 c = corner(mesh, mesh->p, j, l);
                    struct vec3 d = corner(mesh, mesh->p, j, (l + 1) % 3);
                    partners += same(a, d) && same(b, c);
                    copies += same(a, c) && same(b, d);
                }
            assert_int_equal(partners, 1);
            assert_int_equal(copies, 1);
        }
}

/* Volume by the divergence theorem: positive if all faces look outward. */
static double volume(const struct mesh *mesh)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct vec3 a = corner(mesh, mesh->p, i, 0), b = corner(mesh, mesh->p, i, 1),
                    c = corner(mesh, mesh->p, i, 2);
        sum += (double)vec3_dot(a, vec3_cross(b, c)) / 6.0;
    }
    return sum;
}

static void assert_normals_follow_winding(const struct mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct vec3 a = corner(mesh, mesh->p, i, 0);
        struct vec3 e1 = vec3_sub(corner(mesh, mesh->p, i, 1), a);
        struct vec3 e2 = vec3_sub(corner(mesh, mesh->p, i, 2), a);
        struct vec3 n = vec3_cross(e1, e2);
        for (int k = 0; k < 3; k++) {
            struct vec3 m = corner(mesh, mesh->n, i, k);
            assert_near(vec3_length(m), 1.0, 1e-6);
            assert_true(vec3_dot(n, m) > 0.0f);
        }
    }
}

static void box_is_closed(void **state)
{
    (void)state;
    struct mesh *box = mesh_box();
    assert_watertight(box);
    assert_near(volume(box), 8.0, 1e-6);
    mesh_destroy(box);
    struct mesh *rectangle = mesh_rectangle();
    struct vec3 e1 = vec3_sub(corner(rectangle, rectangle->p, 0, 1),
                              corner(rectangle, rectangle->p, 0, 0));
    struct vec3 e2 = vec3_sub(corner(rectangle, rectangle->p, 0, 2),
                              corner(rectangle, rectangle->p, 0, 0));
    assert_true(vec3_cross(e1, e2).z == 4.0f);
    mesh_destroy(rectangle);
}

/* A cylinder with caps, either way round; a cone; a ring with a square section. */
static void lathe_makes_solids(void **state)
{
    (void)state;
    static const double cylinder[] = {0, -1, 1, -1, 1, 1, 0, 1};
    static const double reversed[] = {0, 1, 1, 1, 1, -1, 0, -1};
    static const double cone[] = {0, 0, 1, 0, 0, 2};
    static const double ring[] = {2, 0, 3, 0, 3, 1, 2, 1, 2, 0};
    static const double ring_reversed[] = {2, 0, 2, 1, 3, 1, 3, 0, 2, 0};
    /* Volumes of the prism over the regular 12-gon: area of it with radius r is 3 r^2. */
    static const struct {
        const double *profile;
        int count;
        double volume;
    } rows[] = {{cylinder, 4, 6.0},
                {reversed, 4, 6.0},
                {cone, 3, 2.0},
                {ring, 5, 15.0},
                {ring_reversed, 5, 15.0}};
    for (size_t i = 0; i < 5; i++)
        for (int smooth = 0; smooth < 2; smooth++) {
            struct mesh *mesh = mesh_lathe(rows[i].profile, rows[i].count, 12, smooth,
                                           30.0);
            assert_non_null(mesh);
            assert_watertight(mesh);
            assert_near(volume(mesh), rows[i].volume, 1e-5);
            if (smooth)
                assert_normals_follow_winding(mesh);
            mesh_destroy(mesh);
        }
}

/* An open profile that goes up looks outward, one that goes down inward. */
static void open_lathe_looks_right_of_its_way(void **state)
{
    (void)state;
    static const double up[] = {1, 0, 1, 1}, down[] = {1, 1, 1, 0};
    for (int i = 0; i < 2; i++) {
        struct mesh *mesh = mesh_lathe(i ? down : up, 2, 8, true, 30.0);
        assert_int_equal(mesh->triangle_count, 16);
        assert_normals_follow_winding(mesh);
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            double out = (double)(mesh->p[3 * v] * mesh->n[3 * v] +
                                  mesh->p[3 * v + 2] * mesh->n[3 * v + 2]);
            assert_near(out, i ? -1.0 : 1.0, 1e-6);
        }
        mesh_destroy(mesh);
    }
}

/* A profile that turns by 90 degrees: kept at a crease of 60, smoothed at 120. */
static void lathe_keeps_creases(void **state)
{
    (void)state;
    static const double profile[] = {1, 0, 2, 0, 2, 1};
    for (int smoothed = 0; smoothed < 2; smoothed++) {
        struct mesh *mesh = mesh_lathe(profile, 3, 8, true, smoothed ? 120.0 : 60.0);
        double slant = smoothed ? -sqrt(0.5)
                                : -1.0; /* n.y at the end of the first band */
        assert_near(mesh->n[3 * 8 + 1], slant, 1e-6);
        double start = smoothed ? -sqrt(0.5) : 0.0; /* at the start of the second */
        assert_near(mesh->n[3 * 16 + 1], start, 1e-6);
        mesh_destroy(mesh);
    }
}

static void lathe_refuses(void **state)
{
    (void)state;
    static const double good[] = {1, 0, 1, 1}, negative[] = {1, 0, -1, 1};
    const double nan[] = {1, 0, (double)NAN, 1};
    assert_null(mesh_lathe(good, 1, 8, false, 0.0));
    assert_null(mesh_lathe(good, 2, 2, false, 0.0));
    assert_null(mesh_lathe(negative, 2, 8, false, 0.0));
    assert_null(mesh_lathe(nan, 2, 8, false, 0.0));
}

static const struct place here = {"file.x", 3, 7};

static long notes(const struct log *log)
{
    long sum = 0;
    for (size_t i = 0; i < log->count; i++)
        sum += log->notes[i].count;
    return sum;
}

static void degenerate_triangles_go(void **state)
{
    (void)state;
    struct log log;
    struct err err = {0};
    log_init(&log);
    struct mesh *mesh = mesh_create(5, 5, false, false);
    const float p[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 1, 1e-12f, 0};
    const uint32_t index[15] = {0, 1, 2, 0, 1, 1, 0, 1, 3, 2, 1, 0, 0, 3, 4};
    memcpy(mesh->p, p, sizeof p);
    memcpy(mesh->index, index, sizeof index);
    assert_true(mesh_check(mesh, &here, &log, &err));
    assert_int_equal(mesh->triangle_count, 2);
    assert_memory_equal(mesh->index, index, 12);
    assert_memory_equal(mesh->index + 3, index + 9, 12);
    assert_int_equal(notes(&log), 3);
    mesh_destroy(mesh);
    log_deinit(&log);
}

static void bad_meshes_are_refused(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct log log;
        struct err err = {0};
        log_init(&log);
        struct mesh *mesh = mesh_create(3, 1, true, true);
        for (uint32_t i = 0; i < 3; i++) {
            mesh->index[i] = i;
            mesh->p[4 * (size_t)i] = 1.0f;
            mesh->n[3 * (size_t)i] = 1.0f;
        }
        if (kind == 0)
            mesh->p[7] = NAN;
        if (kind == 1)
            mesh->uv[5] = NAN;
        if (kind == 2)
            mesh->index[2] = 3;
        assert_false(mesh_check(mesh, &here, &log, &err));
        assert_int_equal(err.code, ERR_VALUE);
        assert_int_equal(err.line, 3);
        static const char *const says[] = {"position of vertex 2", "uv of vertex 2",
                                           "triangle 0 names vertex 3"};
        assert_non_null(strstr(err.message, says[kind]));
        mesh_destroy(mesh);
        log_deinit(&log);
    }
}

static void zero_normals_are_repaired(void **state)
{
    (void)state;
    struct log log;
    struct err err = {0};
    log_init(&log);
    struct mesh *mesh = mesh_create(3, 1, true, false);
    for (uint32_t i = 0; i < 3; i++) {
        mesh->index[i] = i;
        mesh->p[4 * (size_t)i] = 1.0f;
    }
    mesh->n[0] = 5.0f; /* not unit, but a direction */
    mesh->n[3] = NAN;
    mesh->n[7] = INFINITY;
    mesh->remarks.short_faces = 2;
    assert_true(mesh_check(mesh, &here, &log, &err));
    assert_int_equal(notes(&log), 4);
    assert_true(mesh->n[0] == 1.0f);
    for (int k = 3; k < 9; k++)
        assert_near(mesh->n[k], sqrt(1.0 / 3.0), 1e-6);
    mesh_destroy(mesh);
    log_deinit(&log);
}

/* Normals go by the inverse transpose: they stay perpendicular under uneven scale. */
static void transform_keeps_normals_perpendicular(void **state)
{
    (void)state;
    static const double profile[] = {1, 0, 2, 3};
    struct mesh *mesh = mesh_lathe(profile, 2, 64, true, 30.0);
    struct xform scale = xform_scale(3.0, 0.5, -2.0);
    struct xform turn = xform_rotate(40.0, 1.0, 1.0, 0.0);
    struct xform both = xform_mul(&turn, &scale);
    mesh_transform(mesh, &both);
    for (size_t k = 0; k < 64; k++) {
        const float *a = mesh->p + 3 * k, *b = mesh->p + 3 * (k + 64),
                    *n = mesh->n + 3 * k;
        struct vec3 along = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        struct vec3 normal = {n[0], n[1], n[2]};
        assert_near(vec3_length(normal), 1.0, 1e-6);
        assert_near(vec3_dot(along, normal) / vec3_length(along), 0.0, 1e-6);
    }
    mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_is_closed),
        cmocka_unit_test(lathe_makes_solids),
        cmocka_unit_test(open_lathe_looks_right_of_its_way),
        cmocka_unit_test(lathe_keeps_creases),
        cmocka_unit_test(lathe_refuses),
        cmocka_unit_test(degenerate_triangles_go),
        cmocka_unit_test(bad_meshes_are_refused),
        cmocka_unit_test(zero_normals_are_repaired),
        cmocka_unit_test(transform_keeps_normals_perpendicular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
