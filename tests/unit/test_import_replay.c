/* Read once more: what the fuzzers found (tests/data/fuzz/READER-WHAT), which must end in
 * a result or an error, and what they begin with (tests/fuzz/seeds/READER), which must be
 * accepted. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "support/fuzz_input.h"

#include <dirent.h>

static const struct reader {
    const char *name;
    bool (*read)(const uint8_t *data, size_t size);
} readers[] = {
    {"pbrt", fuzz_pbrt}, {"mitsuba", fuzz_mitsuba},       {"yaml", fuzz_yaml},
    {"ply", fuzz_ply},   {"serialized", fuzz_serialized}, {"obj", fuzz_obj},
    {"exr", fuzz_exr},
};

#define READERS (sizeof readers / sizeof readers[0])

/* The one whose name, and a dash, the file's begins with. */
static const struct reader *reader_of(const char *name)
{
    for (size_t i = 0; i < READERS; i++) {
        size_t length = strlen(readers[i].name);
        if (strncmp(name, readers[i].name, length) == 0 && name[length] == '-')
            return &readers[i];
    }
    return NULL;
}

static bool read_file(const struct reader *reader, const char *path)
{
    size_t size;
    struct err err = {0};
    char *data = text_read_file(path, &size, NULL, &err);
    assert_non_null(data);
    bool read = reader->read((const uint8_t *)data, size);
    mem_free(data);
    return read;
}

/* Of one reader, or each file's own. Returns the number of files. */
static int read_folder(const char *folder, const struct reader *reader, bool accepted)
{
    int count = 0;
    DIR *directory = opendir(folder);
    for (struct dirent *e; directory && (e = readdir(directory));) {
        if (e->d_name[0] == '.' || text_equal(e->d_name, "README.md"))
            continue;
        const struct reader *own = reader ? reader : reader_of(e->d_name);
        char *path = text_join(folder, e->d_name);
        print_message("%s\n", path);
        assert_non_null(own);
        bool read = read_file(own, path);
        assert_true(read || !accepted);
        mem_free(path);
        count++;
    }
    if (directory)
        closedir(directory);
    return count;
}

static void test_found(void **state)
{
    (void)state;
    assert_true(read_folder("tests/data/fuzz", NULL, false) > 0);
}

static void test_seeds(void **state)
{
    int count = 0;
    (void)state;
    for (size_t i = 0; i < READERS; i++) {
        char *folder = text_join("tests/fuzz/seeds", readers[i].name);
        count += read_folder(folder, &readers[i], true);
        mem_free(folder);
    }
    assert_true(count > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_found),
        cmocka_unit_test(test_seeds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
