/* Loop's subdivision: what it must keep, and its limit where that is known. */

#include "base/mem.h"
#include "math/vec3.h"
#include "scene/mesh.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

static struct mesh *control(const float *p, uint32_t vertices, const uint32_t *index,
                            uint32_t triangles)
{
    struct mesh *mesh = mesh_create(vertices, triangles, false, false);
    memcpy(mesh->p, p, 3 * (size_t)vertices * sizeof(float));
    memcpy(mesh->index, index, 3 * (size_t)triangles * sizeof(uint32_t));
    return mesh;
}

static const float octahedron[18] = {1, 0,  0, -1, 0, 0, 0, 1, 0,
                                     0, -1, 0, 0,  0, 1, 0, 0, -1};
static const uint32_t octahedron_index[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                              2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

static struct vec3 at(const float *array, size_t i)
{
    return vec3(array[3 * i], array[3 * i + 1], array[3 * i + 2]);
}

/* A corner of valence 4 has beta 3/32 and gamma 1/8: its limit is (1 - 4/8) of itself, as
 * its neighbours cancel; at every level the same point. */
static void test_octahedron(void **state)
{
    (void)state;
    struct mesh *c = control(octahedron, 6, octahedron_index, 8);
    for (int levels = 0; levels < 4; levels++) {
        struct mesh *m = mesh_loop(c, levels);
        assert_non_null(m);
        assert_int_equal(m->triangle_count, 8u << (2 * levels));
        assert_int_equal(m->vertex_count, 2 + m->triangle_count / 2); /* Euler */
        assert_true(fabsf(m->p[0] - 0.5f) < 1e-6f && fabsf(m->p[1]) < 1e-6f);
        for (size_t i = 0; i < m->vertex_count; i++) {
            struct vec3 n = at(m->n, i), p = at(m->p, i);
            assert_true(fabsf(vec3_dot(n, n) - 1.0f) < 1e-5f);
            /* Outwards as the winding, and nearly along p on this round thing. */
            assert_true(vec3_dot(n, p) > 0.9f * sqrtf(vec3_dot(p, p)));
        }
        mesh_destroy(m);
    }
    mesh_destroy(c);
}

/* A flat square with a border stays flat and keeps its normals to the winding's side;
 * straight borders stay where they are. */
static void test_flat_with_border(void **state)
{
    (void)state;
    static const float p[27] = {0, 0, 1, 1, 0, 1, 2, 0, 1, 0, 1, 1, 1, 1,
                                1, 2, 1, 1, 0, 2, 1, 1, 2, 1, 2, 2, 1};
    static const uint32_t index[24] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4,
                                       3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7};
    struct mesh *c = control(p, 9, index, 8);
    struct mesh *m = mesh_loop(c, 3);
    assert_non_null(m);
    float least = 10.0f, most = -10.0f;
    for (size_t i = 0; i < m->vertex_count; i++) {
        assert_true(fabsf(m->p[3 * i + 2] - 1.0f) < 1e-6f);
        assert_true(m->n[3 * i + 2] > 0.999f);
        least = fminf(least, m->p[3 * i]);
        most = fmaxf(most, m->p[3 * i]);
    }
    assert_true(fabsf(least) < 0.01f && fabsf(most - 2.0f) < 0.01f);
    mesh_destroy(m);
    mesh_destroy(c);
}

static void test_refusals(void **state)
{
    (void)state;
    static const float p[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    static const uint32_t fin[9] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    static const uint32_t turned[6] = {0, 1, 2, 0, 1, 3};
    static const uint32_t pinched[3] = {0, 0, 1};
    struct mesh *bad[] = {control(p, 5, fin, 3), control(p, 5, turned, 2),
                          control(p, 5, pinched, 1)};
    for (int i = 0; i < 3; i++) {
        assert_null(mesh_loop(bad[i], 2));
        mesh_destroy(bad[i]);
    }
    struct mesh *small = control(p, 5, fin, 1);
    struct mesh *most = mesh_loop(small, 9);
    assert_int_equal(most->triangle_count, 1u << 18);
    assert_null(mesh_loop(small, 10));
    mesh_destroy(most);
    mesh_destroy(small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_octahedron),
        cmocka_unit_test(test_flat_with_border),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
