/* base/pack: what goes in comes out, nothing else does, and a file is whole or refused.
 */
#include "base/pack.h"

#include "base/hash.h"
#include "base/mem.h"
#include "base/pack_file.h"
#include "support/test_file.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

#define LAYOUT 3

struct sample {
    int number;
    long large;
    bool flag;
    double value, values[5];
    int64_t words[3];
    uint32_t halves[3];
    char text[8];
    struct text blob;
};

/* One function for both ways, as it is meant to be. */
static void sample_pack(struct pack *pack, struct sample *s)
{
    pack_int(pack, "number", &s->number, -9, 9);
    pack_long(pack, "large", &s->large, INT64_MIN, INT64_MAX);
    pack_flag(pack, "flag", &s->flag);
    pack_double(pack, "value", &s->value);
    pack_doubles(pack, "values", s->values, 5);
    pack_int64s(pack, "words", s->words, 3);
    pack_uint32s(pack, "halves", s->halves, 3);
    pack_uint32s(pack, "nothing", s->halves, 0);
    pack_text(pack, "text", s->text, sizeof s->text);
    pack_blob(pack, "blob", &s->blob);
}

static const struct sample first = {
    .number = -7,
    .large = INT64_MIN,
    .flag = true,
    .value = -0.0,
    .values = {1e-320, (double)INFINITY, -1.5, 0x1p1023, 0.1},
    .words = {INT64_MAX, -1, 0},
    .halves = {1, UINT32_MAX, 0},
    .text = "1234567",
    .blob = {.data = "a\0bc", .length = 4},
};

static void write_sample(const char *path)
{
    struct err err = {0};
    struct sample s = first;
    struct pack *pack = pack_create(path, LAYOUT, &err);
    assert_non_null(pack);
    assert_false(pack_reads(pack));
    sample_pack(pack, &s);
    assert_true(pack_close(pack, &err));
}

static bool read_sample(const char *path, uint32_t layout, struct sample *s,
                        struct err *err)
{
    *err = (struct err){0};
    *s = (struct sample){0};
    struct pack *pack = pack_open(path, layout, err);
    if (pack == NULL)
        return false;
    assert_true(pack_reads(pack));
    sample_pack(pack, s);
    return pack_close(pack, err);
}

static void test_round_trip(void **state)
{
    (void)state;
    char *path = test_file("round"), *part = text_format("%s.part", path);
    struct sample s;
    struct err err;
    write_sample(path);
    assert_int_equal(access(part, F_OK), -1);
    assert_true(read_sample(path, LAYOUT, &s, &err));
    assert_int_equal(s.number, first.number);
    assert_true(s.large == first.large && s.flag);
    assert_true(s.value == 0.0 && signbit(s.value));
    assert_memory_equal(s.values, first.values, sizeof s.values);
    assert_memory_equal(s.words, first.words, sizeof s.words);
    assert_memory_equal(s.halves, first.halves, sizeof s.halves);
    assert_string_equal(s.text, first.text);
    assert_int_equal(s.blob.length, 4);
    assert_memory_equal(s.blob.data, first.blob.data, 4);
    mem_free(s.blob.data);
    remove(path);
    mem_free(path);
    mem_free(part);
}

/* An array beyond the buffer, of a length that is no multiple of a word. */
static void test_long_arrays(void **state)
{
    (void)state;
    const size_t count = 100001;
    char *path = test_file("long");
    struct err err = {0};
    uint32_t *values = mem_alloc(count, sizeof *values);
    uint32_t *again = mem_alloc(count, sizeof *again);
    for (size_t i = 0; i < count; i++)
        values[i] = (uint32_t)(i * 2654435761u);
    struct pack *pack = pack_create(path, LAYOUT, &err);
    pack_flag(pack, "before", &(bool){true});
    pack_uint32s(pack, "values", values, count);
    pack_flag(pack, "behind", &(bool){true});
    assert_true(pack_close(pack, &err));
    bool before = false, behind = false;
    pack = pack_open(path, LAYOUT, &err);
    pack_flag(pack, "before", &before);
    pack_uint32s(pack, "values", again, count);
    pack_flag(pack, "behind", &behind);
    assert_true(pack_close(pack, &err));
    assert_true(before && behind);
    assert_memory_equal(values, again, count * sizeof *values);
    mem_free(values);
    mem_free(again);
    remove(path);
    mem_free(path);
}

/* --- arrays that are mostly 0 ------------------------------------------------------- */

#define MANY 100001

/* One value in `every` is not 0: the negative zero of doubles is none. */
struct arrays {
    int64_t integers[MANY];
    uint32_t halves[MANY];
    double doubles[MANY];
    float floats[MANY];
};

static void fill(struct arrays *a, size_t every)
{
    *a = (struct arrays){0};
    for (size_t i = every / 2; i < MANY; i += every) {
        a->integers[i] = -(int64_t)i - 1;
        a->halves[i] = (uint32_t)i + 1;
        a->doubles[i] = i % 3 ? -0.0 : 1.0 / (double)(i + 1);
        a->floats[i] = -1.0f / (float)(i + 1);
    }
}

static void arrays_pack(struct pack *pack, struct arrays *a)
{
    pack_sum_int64s(pack, "integers", a->integers, MANY);
    pack_sum_uint32s(pack, "halves", a->halves, MANY);
    pack_doubles(pack, "doubles", a->doubles, MANY);
    pack_floats(pack, "floats", a->floats, MANY);
}

/* Written and read over what is not 0; then added to itself. */
static size_t check_arrays(size_t every)
{
    struct arrays *a = mem_alloc(1, sizeof *a), *again = mem_alloc(1, sizeof *again);
    struct err err = {0};
    struct text bytes = {0};
    fill(a, every);
    fill(again, 1);
    struct pack *pack = pack_create_memory(LAYOUT, &err);
    arrays_pack(pack, a);
    assert_true(pack_close_memory(pack, &bytes, &err));
    for (int adds = 0; adds < 2; adds++) {
        pack = pack_open_memory(&bytes, LAYOUT, &err);
        pack_set_part(pack, (struct run_part){adds, 2}, adds);
        arrays_pack(pack, again);
        assert_true(pack_close(pack, &err));
        assert_memory_equal(again->doubles, a->doubles, sizeof a->doubles);
        assert_memory_equal(again->floats, a->floats, sizeof a->floats);
        for (size_t i = 0; i < MANY; i++) {
            assert_true(again->integers[i] == (1 + adds) * a->integers[i]);
            assert_true(again->halves[i] == (uint32_t)(1 + adds) * a->halves[i]);
        }
    }
    size_t size = bytes.length;
    mem_free(bytes.data);
    mem_free(again);
    mem_free(a);
    return size;
}

static void test_zeros(void **state)
{
    (void)state;
    size_t full = check_arrays(1), bits = MANY / 8;
    assert_true(full > 24 * (size_t)MANY && full < 24 * (size_t)MANY + 400);
    size_t hundredth = check_arrays(100);
    assert_true(hundredth < full / 100 + 4 * bits + 500);
    assert_true(check_arrays(MANY) < 4 * bits + 500);
    assert_true(check_arrays(63) < full / 63 + 4 * bits + 500);
}

/* Bits that say something else than the count, or that lie beyond the last value. */
static void test_bits_that_disagree(void **state)
{
    (void)state;
    static const uint64_t lies[][4] = {
        {2, 7, 0, 0}, {1, 3, 0, 0}, {1, 0, UINT64_C(1) << 36, 0}, {101, ~0u, ~0u, 0}};
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        const unsigned char label[] = {'i', 1, 1, 0, 0, 0, 0, 0, 'x'};
        const uint64_t count = 100;
        struct err err = {0};
        struct text bytes = {0};
        int64_t values[100];
        struct pack *pack = pack_create_memory(LAYOUT, &err);
        pack_file_put(pack, label, sizeof label);
        pack_file_put(pack, &count, sizeof count);
        pack_file_put(pack, lies[i], sizeof lies[i]);
        assert_true(pack_close_memory(pack, &bytes, &err));
        pack = pack_open_memory(&bytes, LAYOUT, &err);
        pack_int64s(pack, "x", values, 100);
        assert_false(pack_ok(pack));
        pack_destroy(pack);
        mem_free(bytes.data);
    }
}

/* --- files that are not what was written ------------------------------------------ */

static void write_bytes(const char *path, const char *bytes, size_t size)
{
    struct err err = {0};
    assert_true(text_write_file(path, bytes, size, &err));
}

static void assert_damaged(const char *path)
{
    struct err err = {0};
    assert_null(pack_open(path, LAYOUT, &err));
    assert_true(strstr(err.message, "damaged") || strstr(err.message, "no checkpoint"));
    assert_string_equal(err.file, path);
}

static void test_damage(void **state)
{
    (void)state;
    char *path = test_file("damage");
    struct err err = {0};
    size_t size;
    write_sample(path);
    char *bytes = text_read_file(path, &size, NULL, &err);
    assert_non_null(bytes);
    for (size_t cut = 0; cut < size; cut += cut % 8 == 0 ? 1 : 7) {
        write_bytes(path, bytes, cut);
        assert_damaged(path);
    }
    for (size_t bit = 0; bit < 8 * size; bit += 9) {
        bytes[bit / 8] = (char)(bytes[bit / 8] ^ 1 << bit % 8);
        write_bytes(path, bytes, size);
        assert_damaged(path);
        bytes[bit / 8] = (char)(bytes[bit / 8] ^ 1 << bit % 8);
    }
    /* Two words that change places, and one said twice. */
    for (size_t i = 0; i + 16 <= size; i += 8) {
        char *other = mem_alloc(size + 8, 1);
        memcpy(other, bytes, size);
        memcpy(other + i, bytes + i + 8, 8);
        memcpy(other + i + 8, bytes + i, 8);
        if (memcmp(other, bytes, size) != 0) {
            write_bytes(path, other, size);
            assert_damaged(path);
        }
        memcpy(other, bytes, i + 8);
        memcpy(other + i + 8, bytes + i, size - i);
        write_bytes(path, other, size + 8);
        assert_damaged(path);
        mem_free(other);
    }
    write_bytes(path, bytes, size);
    struct sample s;
    assert_true(read_sample(path, LAYOUT, &s, &err));
    mem_free(s.blob.data);
    mem_free(bytes);
    remove(path);
    mem_free(path);
}

/* Flips of the top bits of neighbouring words, which a mere product would not tell. */
static void test_top_bits(void **state)
{
    (void)state;
    uint64_t words[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    struct hash before;
    hash_init(&before);
    hash_words(&before, words, 8);
    for (int i = 0; i < 7; i++) {
        struct hash after;
        words[i] ^= UINT64_C(1) << 63;
        words[i + 1] ^= UINT64_C(1) << 63;
        hash_init(&after);
        hash_words(&after, words, 8);
        assert_true(after.value != before.value);
        words[i] ^= UINT64_C(1) << 63;
        words[i + 1] ^= UINT64_C(1) << 63;
    }
}

static void test_other_layout(void **state)
{
    (void)state;
    char *path = test_file("layout");
    struct sample s;
    struct err err;
    write_sample(path);
    assert_false(read_sample(path, LAYOUT + 1, &s, &err));
    assert_non_null(strstr(err.message, "has layout 3, and this version reads 4"));
    remove(path);
    mem_free(path);
}

/* --- readers that ask for something else ------------------------------------------ */

static bool one_read(const char *path, void (*ask)(struct pack *pack))
{
    struct err err = {0};
    struct pack *pack = pack_open(path, LAYOUT, &err);
    ask(pack);
    bool ok = pack_close(pack, &err);
    assert_true(ok || strstr(err.message, "no state that a run can be in"));
    return ok;
}

static void ask_rightly(struct pack *pack)
{
    pack_int(pack, "number", &(int){0}, 0, 5);
}

static void ask_by_another_name(struct pack *pack)
{
    pack_int(pack, "numbers", &(int){0}, 0, 5);
}

static void ask_for_another_kind(struct pack *pack)
{
    pack_double(pack, "number", &(double){0.0});
}

static void ask_for_two(struct pack *pack)
{
    pack_int64s(pack, "number", (int64_t[2]){0}, 2);
}

static void ask_for_less(struct pack *pack)
{
    int value = 1;
    pack_int(pack, "number", &value, 0, 4);
    assert_int_equal(value, 1); /* what is refused is not handed on */
}

static void ask_for_more(struct pack *pack)
{
    pack_int(pack, "number", &(int){0}, 6, 9);
}

static void ask_for_a_flag(struct pack *pack)
{
    pack_flag(pack, "number", &(bool){false});
}

static void ask_again(struct pack *pack)
{
    ask_rightly(pack);
    ask_rightly(pack);
}

static void ask_for_text(struct pack *pack)
{
    pack_text(pack, "number", (char[4]){0}, 4);
}

static void ask_nothing(struct pack *pack)
{
    (void)pack;
}

static void test_other_fields(void **state)
{
    (void)state;
    char *path = test_file("fields");
    struct err err = {0};
    struct pack *pack = pack_create(path, LAYOUT, &err);
    pack_int(pack, "number", &(int){5}, 0, 9);
    assert_true(pack_close(pack, &err));
    assert_true(one_read(path, ask_rightly));
    assert_false(one_read(path, ask_by_another_name));
    assert_false(one_read(path, ask_for_another_kind));
    assert_false(one_read(path, ask_for_two));
    assert_false(one_read(path, ask_for_less));
    assert_false(one_read(path, ask_for_more));
    assert_false(one_read(path, ask_for_a_flag));
    assert_false(one_read(path, ask_again));
    assert_false(one_read(path, ask_for_text));
    assert_false(one_read(path, ask_nothing));
    remove(path);
    mem_free(path);
}

/* A text that is too long, or that ends before its end. */
static void test_texts(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t length;
        bool fits;
    } rows[] = {{"abc", 3, true}, {"abcd", 4, false}, {"a\0b", 3, false}, {"", 0, true}};
    char *path = test_file("texts");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct err err = {0};
        char text[4] = "old";
        struct text blob = {.data = (char *)rows[i].text, .length = rows[i].length};
        struct pack *pack = pack_create(path, LAYOUT, &err);
        pack_blob(pack, "text", &blob);
        assert_true(pack_close(pack, &err));
        pack = pack_open(path, LAYOUT, &err);
        pack_text(pack, "text", text, sizeof text);
        assert_true(pack_close(pack, &err) == rows[i].fits);
        assert_string_equal(text, rows[i].fits ? rows[i].text : "old");
    }
    remove(path);
    mem_free(path);
}

/* --- an older file stays ---------------------------------------------------------- */

static void assert_sample_stands(const char *path)
{
    struct sample s;
    struct err err;
    char *part = text_format("%s.part", path);
    assert_true(read_sample(path, LAYOUT, &s, &err));
    assert_int_equal(access(part, F_OK), -1);
    mem_free(s.blob.data);
    mem_free(part);
}

static void test_unfinished(void **state)
{
    (void)state;
    char *path = test_file("unfinished");
    struct err err = {0};
    double values[20000] = {0.0};
    write_sample(path);
    assert_true(pack_writable(path, &err));
    assert_sample_stands(path);
    struct pack *pack = pack_create(path, LAYOUT, &err);
    pack_doubles(pack, "values", values, 20000);
    pack_destroy(pack);
    assert_sample_stands(path);
    remove(path);
    mem_free(path);
}

/* A disk that is full, as far as a test can have one. */
static void test_no_room(void **state)
{
    (void)state;
    char *path = test_file("room");
    struct err err = {0};
    struct rlimit before, small;
    double values[20000];
    for (int i = 0; i < 20000; i++)
        values[i] = 1.0;
    write_sample(path);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    struct pack *pack = pack_create(path, LAYOUT, &err);
    pack_doubles(pack, "values", values, 20000);
    assert_false(pack_ok(pack));
    bool closed = pack_close(pack, &err);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_false(closed);
    assert_non_null(strstr(err.message, "cannot write"));
    assert_sample_stands(path);
    remove(path);
    mem_free(path);
}

static void test_no_file(void **state)
{
    (void)state;
    static const char *const to_read[] = {"/nonexistent", "/", "/dev/null"};
    static const char *const to_write[] = {"/nonexistent/x", "/", "/dev/null"};
    for (int i = 0; i < 3; i++) {
        struct err err = {0};
        assert_null(pack_open(to_read[i], LAYOUT, &err));
        assert_true(err.code != ERR_NONE);
        err = (struct err){0};
        assert_false(pack_writable(to_write[i], &err));
        assert_null(pack_create(to_write[i], LAYOUT, NULL));
        assert_int_equal(err.code, ERR_IO);
    }
    pack_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),   cmocka_unit_test(test_long_arrays),
        cmocka_unit_test(test_zeros),        cmocka_unit_test(test_bits_that_disagree),
        cmocka_unit_test(test_damage),       cmocka_unit_test(test_top_bits),
        cmocka_unit_test(test_other_layout), cmocka_unit_test(test_other_fields),
        cmocka_unit_test(test_texts),        cmocka_unit_test(test_unfinished),
        cmocka_unit_test(test_no_room),      cmocka_unit_test(test_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
