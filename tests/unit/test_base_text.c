/* base/text: strict numbers, paths, misspellings, whole files in and out. */
#include "base/text.h"

#include "base/mem.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void doubles_are_strict(void **state)
{
    (void)state;
    double x = 7.0;
    assert_true(text_to_double("1e-3", &x));
    assert_true(x == 1e-3);
    assert_true(text_to_double("-.5", &x));
    assert_true(x == -0.5);
    assert_true(text_to_double("5e-324", &x));
    assert_true(x > 0.0);
    const char *bad[] = {"", " 1", "1 ", "1x", "nan", "inf", "-inf", "1e999", "e5", "."};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        x = 7.0;
        assert_false(text_to_double(bad[i], &x));
        assert_true(x == 7.0);
    }
}

static void longs_are_strict(void **state)
{
    (void)state;
    long x = 7;
    assert_true(text_to_long("-12", &x));
    assert_int_equal(x, -12);
    assert_true(text_to_long("010", &x));
    assert_int_equal(x, 10); /* never octal */
    const char *bad[] = {"", " 1", "1 ", "1.0", "1e3", "99999999999999999999", "x"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(text_to_long(bad[i], &x));
    assert_int_equal(x, 10);
}

static void check_path(char *made, const char *expected)
{
    assert_string_equal(made, expected);
    mem_free(made);
}

static void paths_split_and_join(void **state)
{
    (void)state;
    check_path(text_directory("a/b.c"), "a");
    check_path(text_directory("b.c"), ".");
    check_path(text_directory("/b.c"), "/");
    check_path(text_directory("/a/b/c"), "/a/b");
    check_path(text_join("a", "b/c"), "a/b/c");
    check_path(text_join("a/", "b"), "a/b");
    check_path(text_join("a", "/b"), "/b");
    check_path(text_join(".", "b"), "b");
    check_path(text_join("/", "b"), "/b");
    assert_true(text_ends_with("scene.PBRT", ".pbrt"));
    assert_false(text_ends_with("pbrt", ".pbrt"));
}

static void misspellings_find_their_word(void **state)
{
    (void)state;
    const char *const keys[] = {"max_depth", "chains", "start", "start_cap", "per", NULL};
    assert_string_equal(text_nearest("max_dept", keys), "max_depth");
    assert_string_equal(text_nearest("Max_Depht", keys), "max_depth");
    assert_string_equal(text_nearest("chans", keys), "chains");
    assert_string_equal(text_nearest("startcap", keys), "start_cap");
    assert_string_equal(text_nearest("pre", keys), "per");
    const char *const sizes[] = {"szab", "size", NULL}; /* a swap is one error, not two */
    assert_string_equal(text_nearest("szie", sizes), "size");
    assert_null(text_nearest("integrator", keys));
    assert_null(text_nearest("x", keys));
    assert_null(text_nearest("", keys));
    char endless[1000];
    memset(endless, 'x', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_null(text_nearest(endless, keys));
}

static void text_grows(void **state)
{
    (void)state;
    struct text text = {0};
    for (int i = 0; i < 1000; i++)
        text_append(&text, "%03d,", i);
    assert_int_equal(text.length, 4000);
    assert_int_equal(strlen(text.data), 4000);
    assert_memory_equal(text.data + 3996, "999,", 5);
    mem_free(text.data);
    check_path(text_format("%s-%d", "a", 5), "a-5");
    check_path(text_copy_n("abcdef", 3), "abc");
}

static char *folder(void)
{
    char *name = text_copy("/var/tmp/etalon-test-XXXXXX");
    assert_non_null(mkdtemp(name));
    return name;
}

static void files_go_round(void **state)
{
    (void)state;
    char *dir = folder(), *path = text_join(dir, "f.bin");
    size_t size = 200000, read = 0;
    char *data = mem_alloc(size, 1);
    for (size_t i = 0; i < size; i++)
        data[i] = (char)(i * 31 % 251); /* zero bytes too */
    struct err err = {0};
    assert_true(text_write_file(path, "old", 3, &err));
    assert_true(text_write_file(path, data, size, &err));
    char *back = text_read_file(path, &read, NULL, &err);
    assert_non_null(back);
    assert_int_equal(read, size);
    assert_memory_equal(back, data, size);
    assert_int_equal(back[size], 0);
    mem_free(back);
    mem_free(data);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(dir), 0); /* nothing temporary is left */
    mem_free(path);
    mem_free(dir);
}

static void check_unreadable(const char *path, const char *reason)
{
    struct err err = {0};
    size_t size;
    char text[1200];
    assert_null(text_read_file(path, &size, &(struct place){"who.yaml", 4, 5}, &err));
    assert_int_equal(err.code, ERR_IO);
    err_format(&err, text, (int)sizeof text);
    assert_int_equal(strncmp(text, "who.yaml:4:5: ", 14), 0);
    assert_non_null(strstr(text, path));
    assert_non_null(strstr(text, reason));
}

static void only_regular_files_are_read(void **state)
{
    (void)state;
    char *dir = folder(), *fifo = text_join(dir, "fifo"), *none = text_join(dir, "none");
    assert_int_equal(mkfifo(fifo, 0600), 0);
    check_unreadable(dir, "directory");
    check_unreadable(fifo, "not a regular file"); /* and does not wait for a writer */
    check_unreadable(none, "No such file");
    unlink(fifo);
    rmdir(dir);
    mem_free(fifo);
    mem_free(none);
    mem_free(dir);
}

static void failed_writes_leave_nothing(void **state)
{
    (void)state;
    char *dir = folder(), *gone = text_join(dir, "no/such/f");
    struct err err = {0};
    assert_false(text_write_file(gone, "x", 1, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_non_null(strstr(err.message, "no/such/f"));
    err.code = ERR_NONE;
    assert_false(text_write_file(dir, "x", 1, &err)); /* a directory */
    assert_int_equal(rmdir(dir), 0);
    mem_free(gone);
    mem_free(dir);
}

/* A FIFO stands for /dev/null and the like, which a mistake here would destroy. */
static void devices_are_not_replaced(void **state)
{
    (void)state;
    char *dir = folder(), *fifo = text_join(dir, "fifo"), got = 0;
    assert_int_equal(mkfifo(fifo, 0600), 0);
    int reader = open(fifo, O_RDWR | O_NONBLOCK);
    assert_true(text_write_file(fifo, "x", 1, NULL));
    assert_int_equal(read(reader, &got, 1), 1);
    assert_int_equal(got, 'x');
    struct stat info;
    assert_int_equal(stat(fifo, &info), 0);
    assert_true(S_ISFIFO(info.st_mode));
    close(reader);
    unlink(fifo);
    assert_int_equal(rmdir(dir), 0);
    mem_free(fifo);
    mem_free(dir);
}

static void two_paths_to_one_file(void **state)
{
    (void)state;
    char *dir = folder(), *path = text_join(dir, "f"), *link = text_join(dir, "l");
    char *hard = text_join(dir, "h"), *dotted = text_format("%s/./f", dir);
    assert_true(text_same_file(path, dotted)); /* neither is there yet */
    assert_false(text_same_file(path, hard));
    assert_true(text_write_file(path, "x", 1, NULL));
    assert_false(text_same_file(path, hard));
    assert_int_equal(symlink("f", link), 0);
    assert_int_equal(linkat(AT_FDCWD, path, AT_FDCWD, hard, 0), 0);
    assert_true(text_same_file(path, dotted));
    assert_true(text_same_file(path, link));
    assert_true(text_same_file(link, hard));
    assert_false(text_same_file("/dev/null", "/dev/null"));
    assert_false(text_same_file(dir, dir));
    assert_false(text_same_file("/no/where", "/no/where"));
    unlink(hard);
    unlink(link);
    unlink(path);
    assert_int_equal(rmdir(dir), 0);
    mem_free(dotted);
    mem_free(hard);
    mem_free(link);
    mem_free(path);
    mem_free(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_are_strict),
        cmocka_unit_test(longs_are_strict),
        cmocka_unit_test(paths_split_and_join),
        cmocka_unit_test(misspellings_find_their_word),
        cmocka_unit_test(text_grows),
        cmocka_unit_test(files_go_round),
        cmocka_unit_test(only_regular_files_are_read),
        cmocka_unit_test(failed_writes_leave_nothing),
        cmocka_unit_test(devices_are_not_replaced),
        cmocka_unit_test(two_paths_to_one_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
