/* import/gzip and packed PLY files: larger than a piece, of several members, and those
 * that unpack to far more than they promise. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "import/gzip.h"
#include "support/import_test.h"

#include <sys/resource.h>
#include <zlib.h>

#define MEGABYTE (1u << 20)

/* One gzip member of `size` bytes behind what `out` holds. */
static void pack(struct text *out, const char *data, size_t size)
{
    z_stream z = {.next_in = (Bytef *)data, .avail_in = (uInt)size};
    assert_int_equal(deflateInit2(&z, 1, Z_DEFLATED, 16 + MAX_WBITS, 8, 0), Z_OK);
    size_t room = deflateBound(&z, (uLong)size) + 64;
    out->data = mem_grow(out->data, &out->capacity, out->length + room, 1);
    z.next_out = (Bytef *)out->data + out->length;
    z.avail_out = (uInt)room;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    out->length += z.total_out;
    deflateEnd(&z);
}

static struct mesh *read_packed(const struct text *packed, struct err *err)
{
    return import_ply(import_test_write_bytes("t.ply.gz", packed->data, packed->length),
                      NULL, err);
}

static void put_header(struct text *text, const char *format, int vertices, int faces)
{
    text_append(text,
                "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float "
                "y\nproperty float z\nelement face %d\nproperty list uchar int "
                "vertex_indices\nend_header\n",
                format, vertices, faces);
}

static void put_bytes(struct text *text, const void *data, size_t size)
{
    text->data = mem_grow(text->data, &text->capacity, text->length + size + 1, 1);
    memcpy(text->data + text->length, data, size);
    text->length += size;
}

/* A strip of so many vertices that the file takes several pieces. */
static void make_strip(struct text *text, bool ascii)
{
    const int32_t count = 60000;
    put_header(text, ascii ? "ascii" : "binary_little_endian", count, count - 2);
    for (int32_t i = 0; i < count; i++) {
        float p[3] = {(float)i, (float)(i % 2), 1.0f / (float)(i + 1)};
        if (ascii)
            text_append(text, "%d %d %.9g\n", i, i % 2, (double)p[2]);
        else
            put_bytes(text, p, sizeof p);
    }
    for (int32_t i = 0; i + 2 < count; i++) {
        int32_t index[3] = {i, i + 1, i + 2};
        if (ascii)
            text_append(text, "3 %d %d %d\n", i, i + 1, i + 2);
        else {
            put_bytes(text, "\3", 1);
            put_bytes(text, index, sizeof index);
        }
    }
}

static void check_same(const struct mesh *a, const struct mesh *b)
{
    assert_non_null(a);
    assert_non_null(b);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->p, b->p, 3 * sizeof(float) * a->vertex_count);
    assert_memory_equal(a->index, b->index, 3 * sizeof *a->index * a->triangle_count);
}

/* Packed whole, and as members that begin in the middle of a number. */
static void check_strip(bool ascii)
{
    struct text plain = {0}, whole = {0}, members = {0};
    struct err err = {0};
    make_strip(&plain, ascii);
    assert_true(plain.length > MEGABYTE + 4096);
    pack(&whole, plain.data, plain.length);
    for (size_t at = 0, part; at < plain.length; at += part) {
        part = plain.length - at < 99991 ? plain.length - at : 99991;
        pack(&members, plain.data + at, part);
    }
    struct mesh *wanted = import_ply(
        import_test_write_bytes("t.ply", plain.data, plain.length), NULL, &err);
    struct mesh *one = read_packed(&whole, &err), *many = read_packed(&members, &err);
    check_same(one, wanted);
    check_same(many, wanted);
    mesh_destroy(wanted);
    mesh_destroy(one);
    mesh_destroy(many);
    mem_free(plain.data);
    mem_free(whole.data);
    mem_free(members.data);
}

static void test_pieces(void **state)
{
    (void)state;
    check_strip(true);
    check_strip(false);
}

/* The place of an error behind the first piece is that of the unpacked file. */
static void test_place(void **state)
{
    struct text plain = {0}, packed = {0};
    struct err err = {0}, err_packed = {0};
    (void)state;
    make_strip(&plain, true);
    plain.data[plain.length - 3] = 'x';
    pack(&packed, plain.data, plain.length);
    assert_null(import_ply(import_test_write_bytes("t.ply", plain.data, plain.length),
                           NULL, &err));
    assert_null(read_packed(&packed, &err_packed));
    assert_true(err.line > 100000 && err.col > 1);
    assert_int_equal(err_packed.line, err.line);
    assert_int_equal(err_packed.col, err.col);
    assert_string_equal(err_packed.message, err.message);
    mem_free(plain.data);
    mem_free(packed.data);
}

static long peak_kilobytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

/* A good triangle, and behind it 512 MB of zeros in half a megabyte. */
static void test_bomb(void **state)
{
    static const unsigned char body[3 * 12 + 13] = {
        [12 + 2] = 0x80, [12 + 3] = 0x3f, [24 + 6] = 0x80, [24 + 7] = 0x3f,
        [36] = 3,        [41] = 1,        [45] = 2};
    struct text plain = {0}, packed = {0}, zeros = {0};
    struct err err = {0};
    (void)state;
    put_header(&plain, "binary_little_endian", 3, 1);
    put_bytes(&plain, body, sizeof body);
    pack(&packed, plain.data, plain.length);
    struct mesh *mesh = read_packed(&packed, &err);
    assert_non_null(mesh);
    mesh_destroy(mesh);
    char *block = mem_alloc(MEGABYTE, 1);
    pack(&zeros, block, MEGABYTE);
    for (int i = 0; i < 512; i++)
        put_bytes(&packed, zeros.data, zeros.length);
    assert_true(packed.length < 4 * MEGABYTE);
    long before = peak_kilobytes();
    assert_null(read_packed(&packed, &err));
    import_test_error_is(&err, "t.ply.gz: more data than the header promises");
    assert_true(peak_kilobytes() - before < 64 * 1024);
    mem_free(block);
    mem_free(plain.data);
    mem_free(packed.data);
    mem_free(zeros.data);
}

/* A header of more than its file can hold is refused before room is made for it. */
static void test_promise(void **state)
{
    struct text plain = {0}, packed = {0};
    struct err err = {0};
    (void)state;
    put_header(&plain, "binary_little_endian", 100000000, 1);
    pack(&packed, plain.data, plain.length);
    long before = peak_kilobytes();
    assert_null(read_packed(&packed, &err));
    import_test_error_is(
        &err, "t.ply.gz:3:16: the header promises 100000000 rows of \"vertex\", "
              "but at most ");
    assert_true(peak_kilobytes() - before < 64 * 1024);
    mem_free(plain.data);
    mem_free(packed.data);
}

/* What follows the last member is neither read nor passed over. */
static void test_rest(void **state)
{
    struct text plain = {0}, packed = {0};
    struct err err = {0};
    (void)state;
    text_append(&plain, "ply\n");
    pack(&packed, plain.data, plain.length);
    put_bytes(&packed, "rest", 4);
    assert_null(read_packed(&packed, &err));
    import_test_error_is(&err, "cut short or no gzip file");
    mem_free(plain.data);
    mem_free(packed.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bomb),   cmocka_unit_test(test_promise),
        cmocka_unit_test(test_pieces), cmocka_unit_test(test_place),
        cmocka_unit_test(test_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
