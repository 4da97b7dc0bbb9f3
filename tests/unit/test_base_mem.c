/* base/mem: zeroed, aligned, growing by doubling; exhaustion ends the process in words.
 */
#include "base/mem.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void is_zeroed_and_aligned(void **state)
{
    (void)state;
    for (size_t align = 1; align <= 4096; align *= 4) {
        unsigned char *p = mem_aligned(align, 100, 3);
        assert_int_equal((uintptr_t)p % align, 0);
        for (int i = 0; i < 300; i++)
            assert_int_equal(p[i], 0);
        memset(p, 255, 300);
        mem_free(p);
    }
    unsigned char *p = mem_alloc(300, 1);
    for (int i = 0; i < 300; i++)
        assert_int_equal(p[i], 0);
    mem_free(p);
    mem_free(NULL);
}

static void empty_arrays_exist(void **state)
{
    (void)state;
    void *a = mem_alloc(0, 8), *b = mem_aligned(64, 8, 0), *c = mem_resize(NULL, 0, 1);
    assert_non_null(a);
    assert_non_null(b);
    assert_non_null(c);
    a = mem_resize(a, 0, 8); /* not a release */
    assert_non_null(a);
    mem_free(a);
    mem_free(b);
    mem_free(c);
}

static void grows_by_doubling(void **state)
{
    (void)state;
    int *list = NULL;
    size_t capacity = 0;
    int moves = 0;
    for (int i = 0; i < 100000; i++) {
        size_t before = capacity;
        list = mem_grow(list, &capacity, (size_t)i + 1, sizeof *list);
        moves += capacity != before;
        list[i] = i;
    }
    assert_true(moves <= 15); /* 8 * 2^14 > 100000 */
    for (int i = 0; i < 100000; i++)
        assert_int_equal(list[i], i);
    size_t enough = capacity;
    assert_ptr_equal(mem_grow(list, &capacity, enough, sizeof *list), list);
    assert_int_equal(capacity, enough);
    mem_free(list);
}

/* Runs `hog` in a child: it must exit with status 1 and name what was asked for. */
static void check_exhaustion(void (*hog)(void))
{
    int ends[2];
    char text[256] = "";
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        hog();
        _exit(0);
    }
    close(ends[1]);
    assert_true(read(ends[0], text, sizeof text - 1) > 0);
    close(ends[0]);
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    assert_non_null(strstr(text, "out of memory"));
}

static void hog_product(void)
{
    mem_alloc(SIZE_MAX / 2, 3);
}

static void hog_growth(void)
{
    size_t capacity = 0;
    mem_grow(NULL, &capacity, SIZE_MAX / 4, 8);
}

static void hog_aligned(void)
{
    mem_aligned(64, SIZE_MAX / 8, 16);
}

static void exhaustion_ends_in_words(void **state)
{
    (void)state;
    check_exhaustion(hog_product);
    check_exhaustion(hog_growth);
    check_exhaustion(hog_aligned);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_zeroed_and_aligned),
        cmocka_unit_test(empty_arrays_exist),
        cmocka_unit_test(grows_by_doubling),
        cmocka_unit_test(exhaustion_ends_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
