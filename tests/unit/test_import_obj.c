/* import/mesh/import_obj: what the format allows, and every way to be wrong. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_test.h"

#include <sys/stat.h>

static struct mesh *read_good(const char *text)
{
    struct err err = {0};
    struct mesh *mesh = import_obj(import_test_write("t.obj", text), NULL, &err);
    if (!mesh)
        print_message("%d:%d: %s\n", err.line, err.col, err.message);
    assert_non_null(mesh);
    return mesh;
}

static void bad(const char *text, const char *expected)
{
    struct err err = {0};
    assert_null(import_obj(import_test_write("t.obj", text), NULL, &err));
    import_test_error_is(&err, expected);
}

static void index_is(const struct mesh *mesh, uint32_t triangle, uint32_t a, uint32_t b,
                     uint32_t c)
{
    const uint32_t *i = mesh->index + 3 * (size_t)triangle;
    assert_true(i[0] == a && i[1] == b && i[2] == c);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void test_positions(void **state)
{
    (void)state;
    struct mesh *mesh = read_good("# a square\n\n  " SQUARE "f 1 2 3 4 # all\n");
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    assert_true(!mesh->n && !mesh->uv);
    index_is(mesh, 0, 0, 1, 2);
    index_is(mesh, 1, 0, 2, 3);
    assert_true(mesh->p[3] == 1.0f && mesh->p[10] == 1.0f && mesh->p[9] == 0.0f);
    mesh_destroy(mesh);
}

/* A corner is a vertex by all three of its indices. */
static void test_corners(void **state)
{
    (void)state;
    struct mesh *mesh = read_good(SQUARE "vt 0.25\nvt .5 .75\nvn 0 0 1\nvn 0 0 2\n"
                                         "f 1/1/1 2/2/1 3/2/1\n"
                                         "f 1/1/1 3/2/1 4//2\nf 1/2/1 2 3/2/1\n"
                                         "f 1/1/2 2/2/1 4//2\n");
    assert_int_equal(mesh->vertex_count, 7);
    assert_int_equal(mesh->triangle_count, 4);
    index_is(mesh, 0, 0, 1, 2);
    index_is(mesh, 1, 0, 2, 3);
    index_is(mesh, 2, 4, 5, 2);
    index_is(mesh, 3, 6, 1, 3);
    assert_true(mesh->uv[0] == 0.25f && mesh->uv[1] == 0.0f);
    assert_true(mesh->uv[2] == 0.5f && mesh->uv[3] == 0.75f);
    assert_true(mesh->n[2] == 1.0f && mesh->n[11] == 2.0f);
    assert_true(mesh->n[17] == 0.0f); /* said nothing */
    mesh_destroy(mesh);
}

static void test_negative(void **state)
{
    (void)state;
    struct mesh *mesh = read_good("v 9 9 9\nv 0 0 0\nv 1 0 0\nvn 1 0 0\nv 1 1 0\n"
                                  "f -3//-1 -2//-1 -1//-1\nv 5 5 5\nf -2 -1 1\n");
    assert_int_equal(mesh->vertex_count, 6);
    assert_true(mesh->p[0] == 0.0f && mesh->p[3] == 1.0f && mesh->p[7] == 1.0f);
    assert_true(mesh->p[12] == 5.0f && mesh->p[15] == 9.0f);
    mesh_destroy(mesh);
}

/* Carriage returns, continued lines, colours of vertices, names, no newline at the end.
 */
static void test_odds_and_ends(void **state)
{
    (void)state;
    struct mesh *mesh = read_good("mtllib a b.mtl\r\no thing # 1\r\nv 0 0 0 .5 .5 .5\r\n"
                                  "v 1 \\\r\n 0 0 1\r\nv 1 1 0\r\ng a\r\ns off\r\n"
                                  "usemtl m \\\nf 9\r\nf 1 \\\n2 3");
    assert_int_equal(mesh->vertex_count, 3);
    assert_int_equal(mesh->triangle_count, 1);
    assert_true(mesh->p[3] == 1.0f && mesh->p[6] == 1.0f);
    mesh_destroy(mesh);
}

/* More vertices than the first table of corners holds. */
static void test_many(void **state)
{
    (void)state;
    struct text text = {0};
    for (int i = 0; i < 1000; i++)
        text_append(&text, "v %d %d 0\n", i, i * i);
    for (int round = 0; round < 2; round++)
        for (int i = 1; i + 2 <= 1000; i++)
            text_append(&text, "f %d %d %d\n", i, i + 1, i + 2);
    struct mesh *mesh = read_good(text.data);
    assert_int_equal(mesh->vertex_count, 1000);
    assert_int_equal(mesh->triangle_count, 2 * 998);
    for (uint32_t i = 0; i < 998; i++) {
        index_is(mesh, i, i, i + 1, i + 2);
        index_is(mesh, 998 + i, i, i + 1, i + 2);
    }
    assert_true(mesh->p[3 * 999] == 999.0f);
    mesh_destroy(mesh);
    free(text.data);
}

/* One position under many normals: the table meets it again and again. */
static void test_many_normals(void **state)
{
    (void)state;
    struct text text = {0};
    text_append(&text, SQUARE);
    for (int i = 0; i < 600; i++)
        text_append(&text, "vn %d 1 0\n", i);
    for (int i = 1; i <= 600; i++)
        text_append(&text, "f 1//%d 2//%d 3//%d\n", i, i, i);
    struct mesh *mesh = read_good(text.data);
    assert_int_equal(mesh->vertex_count, 1800);
    for (uint32_t i = 0; i < 600; i++) {
        index_is(mesh, i, 3 * i, 3 * i + 1, 3 * i + 2);
        assert_true(mesh->n[9 * i] == (float)i && mesh->p[9 * i + 3] == 1.0f);
    }
    mesh_destroy(mesh);
    free(text.data);
}

/* An L of area 3 from each of its corners, both ways round; its bounding square is 4. */
static void test_concave(void **state)
{
    (void)state;
    for (int first = 0; first < 12; first++) {
        struct text text = {0};
        text_append(&text, "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf");
        for (int i = 0; i < 6; i++)
            text_append(&text, " %d", (first < 6 ? first + i : 17 - first - i) % 6 + 1);
        struct mesh *mesh = read_good(text.data);
        assert_int_equal(mesh->triangle_count, 4);
        assert_true(fabs(mesh_area(mesh) - 3.0) < 1e-12);
        mesh_destroy(mesh);
        free(text.data);
    }
}

/* Faces of one or two corners are left out, indices 0 of vt and vn are "none", and
 * normals that are no finite numbers are 0; all of it is counted. */
static void test_lenient(void **state)
{
    (void)state;
    struct mesh *mesh = read_good(SQUARE "f 1 2\nf 3\nf\nf 1 2 3\n");
    assert_int_equal(mesh->triangle_count, 1);
    assert_int_equal(mesh->remarks.short_faces, 3);
    mesh_destroy(mesh);
    mesh = read_good(SQUARE "f 1 2\n");
    assert_int_equal(mesh->triangle_count, 0);
    mesh_destroy(mesh);
    mesh = read_good(SQUARE "f 1//0 2//0 3//0\nf 1/0/0 2/0/0 3/0\n");
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->remarks.missing_normals, 5);
    assert_int_equal(mesh->remarks.missing_uvs, 3);
    assert_true(!mesh->n && !mesh->uv);
    mesh_destroy(mesh);
    mesh = read_good(SQUARE "vn nan -NaN(ind) 1.#QNAN\nvn -inf 0 1\nvn 0 1 0\n"
                            "f 1//1 2//2 3//3\n");
    assert_true(mesh->n[0] == 0.0f && mesh->n[1] == 0.0f && mesh->n[2] == 0.0f);
    assert_true(mesh->n[3] == 0.0f && mesh->n[5] == 1.0f && mesh->n[7] == 1.0f);
    mesh_destroy(mesh);
}

static void test_bad(void **state)
{
    (void)state;
    bad("", "t.obj:1:1: the file has no faces");
    bad(SQUARE, "no faces");
    bad("v 0 0\n", "t.obj:1:6: too few numbers");
    bad("v 0 0 x\n", "t.obj:1:7: expected a number");
    bad("v 0 0 nan\n", "t.obj:1:7: expected a number");
    bad("v 0 0 1e39\n", "t.obj:1:7: number beyond the range of float");
    bad("vn 0 0 x\n", "t.obj:1:8: expected a number");
    bad(SQUARE "f 1 2 5\n", "t.obj:5:7: no vertex (v) of that number so far");
    bad(SQUARE "f 0 1 2\n", "t.obj:5:3: no vertex");
    bad(SQUARE "f 1 2 -5\n", "t.obj:5:7: no vertex");
    bad(SQUARE "f 1 2 4294967297\n", "t.obj:5:7: no vertex");
    bad(SQUARE "f 1 2 99999999999999999999999\n", "t.obj:5:7: no vertex");
    bad(SQUARE "f 1/1 2 3\n", "t.obj:5:5: no texture coordinate (vt)");
    bad(SQUARE "f 1//1 2 3\n", "t.obj:5:6: no normal (vn)");
    bad(SQUARE "f 1/ 2 3\n", "t.obj:5:5: expected an index");
    bad(SQUARE "f 1// 2 3\n", "t.obj:5:6: expected an index");
    bad(SQUARE "vt 0 0\nvn 1 0 0\nf 1/1/1/1 2 3\n", "t.obj:7:8: expected a corner");
    bad(SQUARE "f 1 2 3.5\n", "t.obj:5:8: expected a corner");
    bad("w 1 2 3\n", "t.obj:1:1: unknown statement \"w\"");
    bad("vertex 1 2 3\n", "t.obj:1:1: unknown statement \"vertex\"");
}

static void test_not_a_file(void **state)
{
    (void)state;
    struct err err = {0}, err2 = {0}, err3 = {0};
    struct place at = {"scene.xml", 3, 4};
    assert_null(import_obj(import_test_path("absent.obj"), &at, &err));
    import_test_error_is(&err, "scene.xml:3:4: cannot open");
    mkdir(import_test_path("folder.obj"), 0755);
    assert_null(import_obj(import_test_path("folder.obj"), &at, &err2));
    import_test_error_is(&err2, "scene.xml:3:4: ");
    assert_null(import_obj(
        import_test_write_bytes("zero.obj", "v 0 0 0\0\nv 1 1 1\n", 17), NULL, &err3));
    assert_int_equal(err3.line, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_positions), cmocka_unit_test(test_corners),
        cmocka_unit_test(test_negative),  cmocka_unit_test(test_odds_and_ends),
        cmocka_unit_test(test_many),      cmocka_unit_test(test_many_normals),
        cmocka_unit_test(test_concave),   cmocka_unit_test(test_lenient),
        cmocka_unit_test(test_bad),       cmocka_unit_test(test_not_a_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
