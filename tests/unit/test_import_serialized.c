/* import/mesh/import_serialized: both versions and precisions, several meshes in a file,
 * and every way to be wrong. The files are made here. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_test.h"
#include "support/serialized_make.h"

static struct mesh *read_file(const struct serialized *s, int index,
                              struct import_serialized_flags *flags, struct err *err)
{
    return import_serialized(import_test_write_bytes("t.serialized", s->data, s->size),
                             index, flags, NULL, err);
}

static void bad(const struct serialized *s, int index, const char *expected)
{
    struct err err = {0};
    struct import_serialized_flags flags;
    assert_null(read_file(s, index, &flags, &err));
    import_test_error_is(&err, expected);
}

static void one_square(struct serialized *file, int version, unsigned flags)
{
    struct serialized body = {.size = 0};
    file->size = 0;
    serialized_square(&body, version, flags, 0.0);
    size_t offset = serialized_add(file, version, &body);
    serialized_end(file, version, &offset, 1);
}

static void check_square(int version, unsigned bits)
{
    struct serialized file = {.size = 0};
    struct err err = {0};
    struct import_serialized_flags flags = {0};
    one_square(&file, version, bits);
    struct mesh *mesh = read_file(&file, 0, &flags, &err);
    if (!mesh)
        print_message("%s\n", err.message);
    assert_non_null(mesh);
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    assert_true(mesh->p[6] == 1.0f && mesh->p[7] == 1.0f && mesh->p[8] == 0.0f);
    assert_true(mesh->index[3] == 0 && mesh->index[4] == 2 && mesh->index[5] == 3);
    assert_true(!!mesh->n == !!(bits & 1) && !!mesh->uv == !!(bits & 2));
    assert_true(!mesh->n || (mesh->n[0] == 0.0f && mesh->n[11] == 1.0f));
    assert_true(!mesh->uv || (mesh->uv[2] == 1.0f && mesh->uv[7] == 1.0f));
    assert_true(flags.colours == !!(bits & 8) && flags.face_normals == !!(bits & 0x10));
    mesh_destroy(mesh);
}

static void test_good(void **state)
{
    (void)state;
    for (int version = 3; version <= 4; version++) {
        check_square(version, 0x1000);
        check_square(version, 0x2000);
        check_square(version, 0x1001);
        check_square(version, 0x2003);
        check_square(version, 0x100b);
        check_square(version, 0x201f);
    }
}

static void test_several(void **state)
{
    (void)state;
    for (int version = 3; version <= 4; version++) {
        struct serialized file = {.size = 0};
        size_t offsets[3];
        for (int i = 0; i < 3; i++) {
            struct serialized body = {.size = 0};
            serialized_square(&body, version, 0x1000, i);
            offsets[i] = serialized_add(&file, version, &body);
        }
        serialized_end(&file, version, offsets, 3);
        for (int i = 0; i < 3; i++) {
            struct err err = {0};
            struct import_serialized_flags flags;
            struct mesh *mesh = read_file(&file, i, &flags, &err);
            assert_non_null(mesh);
            assert_true(mesh->p[2] == (float)i);
            mesh_destroy(mesh);
        }
        bad(&file, 3, "no mesh of the shape_index 3, the file holds 3");
        bad(&file, -1, "no mesh of the shape_index -1");
    }
}

/* A header that claims much in a file of little. */
static void test_claims(void **state)
{
    (void)state;
    static const uint64_t claims[][2] = {{100000000, 2},
                                         {4, 100000000},
                                         {UINT64_MAX - 9, 2},
                                         {4, UINT64_MAX - 9},
                                         {UINT64_C(1) << 62, UINT64_C(1) << 62}};
    for (size_t i = 0; i < sizeof claims / sizeof claims[0]; i++) {
        struct serialized body = {.size = 0}, file = {.size = 0};
        serialized_square(&body, 4, 0x1000, 0.0);
        body.size = 4 + 7;
        serialized_put(&body, claims[i][0], 8);
        serialized_put(&body, claims[i][1], 8);
        body.size = 1024;
        size_t offset = serialized_add(&file, 4, &body);
        serialized_end(&file, 4, &offset, 1);
        bad(&file, 0,
            claims[i][0] < UINT32_MAX && claims[i][1] < UINT32_MAX
                ? "the header claims more vertices"
                : "more than 2^32 vertices");
    }
}

/* No vertices, or no triangles. */
static void test_empty(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct serialized body = {.size = 0}, file = {.size = 0};
        serialized_square(&body, 4, 0x1000, 0.0);
        memset(body.data + 4 + 7 + 8 * i, 0, 8);
        size_t offset = serialized_add(&file, 4, &body);
        serialized_end(&file, 4, &offset, 1);
        bad(&file, 0, "the mesh is empty");
    }
}

/* A name that is longer than the file; flags before it: single precision. */
static void test_name(void **state)
{
    static unsigned char body[100000];
    struct serialized file = {.size = 0};
    size_t offset = 0;
    uLongf room = SERIALIZED_MAX / 2;
    (void)state;
    memset(body, 'a', sizeof body);
    memcpy(body, "\0\x10\0\0", 4);
    serialized_put(&file, 0x041c, 2);
    serialized_put(&file, 4, 2);
    assert_int_equal(compress(file.data + 4, &room, body, sizeof body), Z_OK);
    file.size += room;
    serialized_end(&file, 4, &offset, 1);
    bad(&file, 0, "the name of the mesh does not end");
}

static void test_bad(void **state)
{
    struct serialized good, file;
    (void)state;
    one_square(&good, 4, 0x1000);
    for (size_t size = 0; size < good.size; size++) { /* cut anywhere */
        file = good;
        file.size = size;
        bad(&file, 0, "t.serialized: ");
    }
    file = good; /* cut within the data, with a table all the same */
    file.size = 20;
    serialized_end(&file, 4, (const size_t[]){0}, 1);
    bad(&file, 0, "truncated: the mesh's data ends early");
    file = good;
    file.data[0] ^= 1;
    bad(&file, 0, "no .serialized mesh file");
    file = good;
    file.data[2] = 5;
    bad(&file, 0, "versions 3 and 4");
    file = good;
    file.data[4] ^= 0xff;
    bad(&file, 0, "compressed data is corrupt");
    file = good;
    file.data[file.size - 12] = 1;
    bad(&file, 0, "no mesh stands where the table says");
    file = good;
    memset(file.data + file.size - 12, 0xff, 8);
    bad(&file, 0, "starts behind the end");
    file = good;
    memset(file.data + file.size - 4, 0xff, 4);
    bad(&file, 0, "the table of meshes");
}

/* As Mitsuba reads them: double precision if the flag says so, else single; normals that
 * are not finite are 0, and mesh_check mends them. */
static void test_lenient(void **state)
{
    (void)state;
    struct serialized body = {.size = 0}, file = {.size = 0};
    struct import_serialized_flags flags = {0};
    struct err err = {0};
    size_t offset = 0;
    check_square(3, 0x0003);
    check_square(4, 0x0000);
    check_square(4, 0x3001);
    serialized_square(&body, 4, 0x1001, 0.0);
    memset(body.data + body.size - 6 * 4 - 12 * 4, 0xff, 4); /* NaN in the first normal */
    serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    struct mesh *mesh = read_file(&file, 0, &flags, &err);
    assert_non_null(mesh);
    assert_true(mesh->n[0] == 0.0f && mesh->n[2] == 1.0f);
    mesh_destroy(mesh);
}

static void test_bad_values(void **state)
{
    (void)state;
    struct serialized body = {.size = 0}, file = {.size = 0};
    size_t offset = 0;
    serialized_square(&body, 4, 0x1000, 0.0);
    body.data[body.size - 4] = 4; /* an index */
    serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    bad(&file, 0, "a vertex that is not there");
    body.size = file.size = 0;
    serialized_square(&body, 4, 0x2000, 1e300);
    serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    bad(&file, 0, "not finite in single precision");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),       cmocka_unit_test(test_several),
        cmocka_unit_test(test_claims),     cmocka_unit_test(test_bad),
        cmocka_unit_test(test_bad_values), cmocka_unit_test(test_empty),
        cmocka_unit_test(test_name),       cmocka_unit_test(test_lenient),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
