/* import/mesh/import_ply: all formats and types, written here by hand; every way to be
 * wrong.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "support/import_test.h"

#include <sys/stat.h>
#include <zlib.h>

struct bytes {
    char data[4096];
    size_t size;
};

static void put_text(struct bytes *b, const char *text)
{
    memcpy(b->data + b->size, text, strlen(text));
    b->size += strlen(text);
}

static void put_bits(struct bytes *b, uint64_t bits, size_t width, bool big)
{
    for (size_t i = 0; i < width; i++)
        b->data[b->size++] = (char)(bits >> 8 * (big ? width - 1 - i : i));
}

static void put_float(struct bytes *b, float v, bool big)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    put_bits(b, bits, 4, big);
}

static void put_double(struct bytes *b, double v, bool big)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    put_bits(b, bits, 8, big);
}

static struct mesh *read_bytes(const struct bytes *b, struct err *err)
{
    return import_ply(import_test_write_bytes("t.ply", b->data, b->size), NULL, err);
}

static struct mesh *read_good(const struct bytes *b)
{
    struct err err = {0};
    struct mesh *mesh = read_bytes(b, &err);
    if (!mesh)
        print_message("%s\n", err.message);
    assert_non_null(mesh);
    return mesh;
}

static void index_is(const struct mesh *mesh, uint32_t triangle, uint32_t a, uint32_t b,
                     uint32_t c)
{
    const uint32_t *i = mesh->index + 3 * (size_t)triangle;
    assert_true(i[0] == a && i[1] == b && i[2] == c);
}

/* A pentagon and a triangle with normals, uv, things to skip, and faces first. */
static void put_binary(struct bytes *b, bool big)
{
    put_text(b, "ply\r\nformat ");
    put_text(b, big ? "binary_big_endian" : "binary_little_endian");
    put_text(b,
             " 1.0\r\ncomment made by a test\r\nobj_info none\r\n"
             "element face 2\nproperty uchar flags\n"
             "property list ushort int vertex_index\nproperty list char short junk\n"
             "element edge 2\nproperty list int double w\nproperty uint8 a\n"
             "element vertex 5\nproperty double x\nproperty float y\nproperty short z\n"
             "property uint id\nproperty float32 nx\nproperty float ny\n"
             "property float nz\nproperty float s\nproperty float t\nend_header\n");
    for (int face = 0; face < 2; face++) {
        int corners = face ? 3 : 5;
        put_bits(b, 9, 1, big);
        put_bits(b, (uint64_t)corners, 2, big);
        for (int i = 0; i < corners; i++)
            put_bits(b, (uint64_t)(face ? 4 - i : i), 4, big);
        put_bits(b, (uint64_t)face, 1, big); /* junk: 0 or 1 items */
        if (face)
            put_bits(b, 0xfffe, 2, big);
    }
    for (int edge = 0; edge < 2; edge++) {
        put_bits(b, 2, 4, big);
        put_double(b, 0.5, big);
        put_double(b, (double)NAN, big); /* skipped: not looked at */
        put_bits(b, 1, 1, big);
    }
    for (int v = 0; v < 5; v++) {
        put_double(b, 0.25 * v, big);
        put_float(b, -1.5f * (float)v, big);
        put_bits(b, (uint64_t)(-3 * v), 2, big);
        put_bits(b, 77, 4, big);
        put_float(b, 0.0f, big);
        put_float(b, 0.0f, big);
        put_float(b, 1.0f, big);
        put_float(b, 0.1f * (float)v, big);
        put_float(b, 1.0f, big);
    }
}

static void check_pentagon(const struct mesh *mesh)
{
    assert_int_equal(mesh->vertex_count, 5);
    assert_int_equal(mesh->triangle_count, 4);
    index_is(mesh, 0, 0, 1, 2);
    index_is(mesh, 1, 0, 2, 3);
    index_is(mesh, 2, 0, 3, 4);
    index_is(mesh, 3, 4, 3, 2);
    assert_true(mesh->p[12] == 1.0f && mesh->p[13] == -6.0f && mesh->p[14] == -12.0f);
    assert_true(mesh->n[14] == 1.0f && mesh->n[13] == 0.0f);
    assert_true(mesh->uv[8] == 0.1f * 4.0f && mesh->uv[9] == 1.0f);
}

static void test_binary(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++) {
        struct bytes b = {.size = 0};
        put_binary(&b, big);
        struct mesh *mesh = read_good(&b);
        check_pentagon(mesh);
        mesh_destroy(mesh);
    }
}

#define ASCII_HEAD                                                                  \
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n" \
    "property float z\nelement face 1\nproperty list uchar uint vertex_indices\n"   \
    "end_header\n"
#define ASCII_POINTS "0 0 0\n1 0 0\n1 1e0 0\n0 1 -.5\n"

static void test_ascii(void **state)
{
    static const char *const tails[] = {"", "\n", "\r\n", " \n\n"};
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct bytes b = {.size = 0};
        put_text(&b, ASCII_HEAD ASCII_POINTS "4 0 1 2 3");
        put_text(&b, tails[i]);
        struct mesh *mesh = read_good(&b);
        assert_int_equal(mesh->triangle_count, 2);
        index_is(mesh, 1, 0, 2, 3);
        assert_true(mesh->p[11] == -0.5f);
        assert_null(mesh->n);
        assert_null(mesh->uv);
        mesh_destroy(mesh);
    }
}

/* Each integer type at its extremes, in both orders; read back through x. */
static void test_types(void **state)
{
    static const struct {
        const char *name;
        uint64_t bits;
        size_t width;
        double value;
    } rows[] = {{"char", 0x80, 1, -128.0},
                {"int8", 0x7f, 1, 127.0},
                {"uchar", 0xff, 1, 255.0},
                {"uint8", 0x80, 1, 128.0},
                {"short", 0x8000, 2, -32768.0},
                {"int16", 0x1234, 2, 4660.0},
                {"ushort", 0xffff, 2, 65535.0},
                {"uint16", 0x8001, 2, 32769.0},
                {"int", 0x80000000, 4, -0x1p31},
                {"int32", 0x10000, 4, 65536.0},
                {"uint", 0x80000000, 4, 0x1p31},
                {"uint32", 0xffffff00, 4, 4294967040.0},
                {"float", 0x3fc00000, 4, 1.5},
                {"float32", 0xbf000000, 4, -0.5},
                {"double", 0x4004000000000000, 8, 2.5},
                {"float64", 0xc004000000000000, 8, -2.5}};
    (void)state;
    for (size_t row = 0; row < 2 * sizeof rows / sizeof rows[0]; row++) {
        bool big = row % 2;
        struct bytes b = {.size = 0};
        put_text(&b, "ply\nformat ");
        put_text(&b, big ? "binary_big_endian" : "binary_little_endian");
        put_text(&b, " 1.0\nelement vertex 3\nproperty ");
        put_text(&b, rows[row / 2].name);
        put_text(&b, " x\nproperty char y\nproperty char z\nelement face 1\n"
                     "property list uchar uchar vertex_indices\nend_header\n");
        for (int v = 0; v < 3; v++) {
            put_bits(&b, rows[row / 2].bits, rows[row / 2].width, big);
            put_bits(&b, 0, 2, big);
        }
        put_text(&b, "\x03");
        put_bits(&b, 0x020100, 3, false);
        struct mesh *mesh = read_good(&b);
        assert_true((double)mesh->p[0] == rows[row / 2].value);
        mesh_destroy(mesh);
    }
}

static void bad(const char *text, const char *expected)
{
    struct bytes b = {.size = 0};
    struct err err = {0};
    put_text(&b, text);
    assert_null(read_bytes(&b, &err));
    import_test_error_is(&err, expected);
}

static void test_bad_header(void **state)
{
    (void)state;
    bad("", "not a PLY file");
    bad("plyx\n", "t.ply:1: not a PLY file");
    bad("ply\n", "t.ply:2: the PLY header has no end_header");
    bad("ply\nformat ascii 2.0\n", "t.ply:2: \"format ascii|");
    bad("ply\nelement vertex 3\n", "t.ply:2: \"format ascii|");
    bad("ply\nformat ascii 1.0\nproperty float x\n", "t.ply:3: a property before any");
    bad("ply\nformat ascii 1.0\nelement v -1\n", "t.ply:3: the element's count is not");
    bad("ply\nformat ascii 1.0\nelement v 99999999999999999999\n", "t.ply:3: ");
    bad("ply\nformat ascii 1.0\nelement v 1\nproperty flat x\n",
        "t.ply:4: unknown PLY type \"flat\"");
    bad("ply\nformat ascii 1.0\nelement v 1\nproperty list float int x\n",
        "t.ply:4: the length of a list must be of an integer type");
    bad("ply\nformat ascii 1.0\nelement v 1\nproperty int x\nproperty int x\n",
        "t.ply:5: a property of this name");
    bad("ply\nformat ascii 1.0\nelement v 1\nelement v 1\n",
        "t.ply:4: an element of this");
    bad("ply\nformat ascii 1.0\nvertex 1\n", "t.ply:3: \"element\", \"property\" or");
    bad("ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0\n", "has no properties");
}

/* Promises that the file cannot keep are refused before anything is allocated. */
static void test_huge_counts(void **state)
{
    (void)state;
    bad("ply\nformat ascii 1.0\nelement vertex 100000000\nproperty float x\nproperty "
        "float "
        "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n",
        "promises 100000000 rows of \"vertex\", but only 6 bytes follow it");
    bad("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float "
        "x\nelement "
        "face 4000000000\nproperty list uchar int vertex_indices\nend_header\n0000000",
        "promises 4000000000 rows of \"face\"");
    bad("ply\nformat binary_little_endian 1.0\nelement vertex 999999999999999999\n"
        "property double x\nend_header\n00000000",
        "promises 999999999999999999 rows of \"vertex\"");
}

#define LENIENT_HEAD                                                                  \
    "ply\nformat ascii 1.0\n%selement vertex 6\nproperty float x\nproperty float y\n" \
    "property float z\n%send_header\n"
#define LENIENT_FACES "element face 3\nproperty list uchar int vertex_indices\n"
#define LENIENT_L     "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n"

/* An L of area 3 among faces of no and two corners, vertices before and after the faces.
 */
static void test_lenient(void **state)
{
    (void)state;
    for (int after = 0; after < 2; after++)
        for (int first = 0; first < 6; first++) {
            struct text text = {0};
            text_append(&text, LENIENT_HEAD, after ? LENIENT_FACES : "",
                        after ? "" : LENIENT_FACES);
            text_append(&text, "%s0\n2 0 1\n6", after ? "" : LENIENT_L);
            for (int i = 0; i < 6; i++)
                text_append(&text, " %d", (first + i) % 6);
            text_append(&text, "\n%s", after ? LENIENT_L : "");
            struct err err = {0};
            struct mesh *mesh = import_ply(import_test_write("t.ply", text.data), NULL,
                                           &err);
            assert_non_null(mesh);
            assert_int_equal(mesh->triangle_count, 4);
            assert_int_equal(mesh->remarks.short_faces, 2);
            assert_true(fabs(mesh_area(mesh) - 3.0) < 1e-12);
            mesh_destroy(mesh);
            free(text.data);
        }
}

/* A normal that is not finite is 0, for mesh_check to mend. */
static void test_nan_normal(void **state)
{
    (void)state;
    struct err err = {0};
    struct mesh *mesh = import_ply(
        import_test_write("t.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nproperty float nx\n"
                          "property float ny\nproperty float nz\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0 nan -nan(ind) inf\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"),
        NULL, &err);
    assert_non_null(mesh);
    for (int i = 0; i < 3; i++)
        assert_true(mesh->n[i] == 0.0f);
    assert_true(mesh->n[5] == 1.0f);
    mesh_destroy(mesh);
}

static void test_bad_data(void **state)
{
    (void)state;
    bad(ASCII_HEAD ASCII_POINTS "3 0 1", "t.ply:14:6: the file ends before its data");
    bad(ASCII_HEAD ASCII_POINTS "3 0 1 4\n", "t.ply:14:8: an index or a count is out of");
    bad(ASCII_HEAD ASCII_POINTS "3 0 1 -1\n",
        "t.ply:14:9: an index or a count is out of");
    bad(ASCII_HEAD ASCII_POINTS "3 0 1 1.5\n", "t.ply:14:10: an index or a count is");
    bad(ASCII_HEAD ASCII_POINTS "2 0 4 \n", "t.ply:14:6: an index or a count is out of");
    bad(ASCII_HEAD ASCII_POINTS "3 0 1 nan\n", "an index or a count is out of");
    bad(ASCII_HEAD ASCII_POINTS "3 0 1 2 0\n", "t.ply:14:9: more data than the header");
    bad(ASCII_HEAD ASCII_POINTS "4000000000 0 1 2\n", "t.ply:15:1: the file ends");
    bad(ASCII_HEAD "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n", "a vertex is not finite");
    bad(ASCII_HEAD "0 0 0\n1 1e39 0\n1 1 0\n0 1 0\n3 0 1 2\n",
        "t.ply:11:7: a vertex is not finite");
}

static void test_bad_binary(void **state)
{
    struct bytes good = {.size = 0};
    (void)state;
    put_binary(&good, false);
    struct err err = {0}, err_more = {0}, err_nan = {0};
    struct bytes b = good;
    b.size -= 1;
    assert_null(read_bytes(&b, &err));
    import_test_error_is(&err, "the file ends before its data, before byte");
    b = good;
    put_text(&b, "\nx");
    assert_null(read_bytes(&b, &err_more));
    import_test_error_is(&err_more, "more data than the header promises");
    b = good;
    put_text(&b, "\n");
    mesh_destroy(read_good(&b));
    b = good;
    memset(b.data + b.size - 8, 0xff, 4); /* s of the last vertex */
    assert_null(read_bytes(&b, &err_nan));
    import_test_error_is(&err_nan, "a vertex is not finite");
}

/* Every shorter file is refused, and none is read beyond its end. */
static void test_every_truncation(void **state)
{
    struct bytes whole = {.size = 0};
    (void)state;
    put_binary(&whole, true);
    for (size_t size = 0; size < whole.size; size++) {
        struct bytes b = whole;
        struct err err = {0};
        b.size = size;
        assert_null(read_bytes(&b, &err));
        assert_int_not_equal(err.code, ERR_NONE);
    }
}

static void test_bad_meaning(void **state)
{
    static const char *const rest = "element face 1\nproperty list uchar int "
                                    "vertex_indices\nend_header\n0 0 0\n3 0 0 0\n";
    static const struct {
        const char *vertex, *expected;
    } rows[] = {
        {"property float x\nproperty float y\n", "the vertices lack x, y or z"},
        {"property float x\nproperty float y\nproperty float z\nproperty float nx\n",
         "lack one of nx, ny, nz"},
        {"property float x\nproperty float y\nproperty float z\nproperty float v\n",
         "lack one of u, v"},
        {"property float u\nproperty float s\nproperty float z\n", "mean the same"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct text text = {0};
        text_append(&text, "ply\nformat ascii 1.0\nelement vertex 1\n%s%s",
                    rows[i].vertex, rest);
        bad(text.data, rows[i].expected);
        mem_free(text.data);
    }
    bad("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
        "no \"vertex\" or no \"face\"");
    bad("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nelement face 0\n"
        "property list uchar int vertex_indices\nend_header\n",
        "the mesh is empty");
    bad("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement face 1\n"
        "property list uchar float vertex_indices\nend_header\n0\n3 0 0 0\n",
        "the faces want one list");
}

static void test_no_file(void **state)
{
    struct err err = {0}, err_dir = {0};
    struct place at = {"scene.pbrt", 4, 9};
    (void)state;
    assert_null(import_ply(import_test_path("absent.ply"), &at, &err));
    import_test_error_is(&err, "scene.pbrt:4:9: ");
    import_test_error_is(&err, "absent.ply");
    mkdir(import_test_path("folder.ply"), 0777);
    assert_null(import_ply(import_test_path("folder.ply"), &at, &err_dir));
    import_test_error_is(&err_dir, "scene.pbrt:4:9: ");
}

/* The same mesh packed; packed and cut short. */
static void test_packed(void **state)
{
    (void)state;
    struct bytes b = {.size = 0};
    put_binary(&b, false);
    unsigned char packed[4096];
    z_stream z = {.next_in = (Bytef *)b.data,
                  .avail_in = (uInt)b.size,
                  .next_out = packed,
                  .avail_out = sizeof packed};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, 0), Z_OK);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    size_t size = z.total_out;
    deflateEnd(&z);
    struct err err = {0};
    struct mesh *mesh = import_ply(import_test_write_bytes("t.ply.gz", packed, size),
                                   NULL, &err);
    assert_non_null(mesh);
    check_pentagon(mesh);
    mesh_destroy(mesh);
    for (size_t cut = 0; cut < size; cut += 7) {
        err = (struct err){0};
        assert_null(
            import_ply(import_test_write_bytes("t.ply.gz", packed, cut), NULL, &err));
        assert_non_null(strstr(err.message, "cut short"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_packed),
        cmocka_unit_test(test_binary),
        cmocka_unit_test(test_ascii),
        cmocka_unit_test(test_types),
        cmocka_unit_test(test_bad_header),
        cmocka_unit_test(test_huge_counts),
        cmocka_unit_test(test_lenient),
        cmocka_unit_test(test_nan_normal),
        cmocka_unit_test(test_bad_data),
        cmocka_unit_test(test_bad_binary),
        cmocka_unit_test(test_every_truncation),
        cmocka_unit_test(test_bad_meaning),
        cmocka_unit_test(test_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
