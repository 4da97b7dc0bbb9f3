/* base/libraries: the program runs with the settings that it asks for, and what it
 * allocates lies on huge pages where the system has them for those who ask. */
#include "base/libraries.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#define BYTES ((size_t)64 << 20)

static void waiting_threads_sleep(void **state)
{
    (void)state;
    assert_non_null(getenv("GOMP_SPINCOUNT"));
    assert_non_null(getenv("KMP_BLOCKTIME"));
}

/* Whether a line of the file holds the text. */
static bool file_has(const char *path, const char *text)
{
    char line[256];
    bool found = false;
    FILE *file = fopen(path, "r");
    while (file && !found && fgets(line, sizeof line, file))
        found = strstr(line, text) != NULL;
    if (file)
        fclose(file);
    return found;
}

static long huge_kilobytes(void)
{
    char line[256];
    long kilobytes = -1;
    FILE *file = fopen("/proc/self/smaps_rollup", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "AnonHugePages:", 14) == 0)
            kilobytes = strtol(line + 14, NULL, 10);
    if (file)
        fclose(file);
    return kilobytes;
}

/* Defined by the address sanitizer, whose allocator is not the one that is meant. */
extern void __asan_init(void) __attribute__((weak));

static void heap_is_on_huge_pages(void **state)
{
    (void)state;
    const char *tunables = getenv("GLIBC_TUNABLES");
    assert_non_null(tunables);
    assert_string_equal(tunables, "glibc.malloc.hugetlb=1");
    if (__asan_init ||
        !file_has("/sys/kernel/mm/transparent_hugepage/enabled", "[madvise]"))
        skip();
    char *bytes = malloc(BYTES);
    assert_non_null(bytes);
    long before = huge_kilobytes();
    memset(bytes, 1, BYTES);
    long gained = huge_kilobytes() - before;
    free(bytes);
    /* Half: the system may be short of them. */
    assert_true(before < 0 || gained > (long)(BYTES >> 11));
}

/* Takes away what the caller has set, before the program executes itself again. */
static void forget_environment(void)
{
    static const char *const names[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT",
                                        "KMP_BLOCKTIME", "GLIBC_TUNABLES"};
    if (getenv("TEST_LIBRARIES_BEGUN"))
        return;
    for (int i = 0; i < 4; i++)
        unsetenv(names[i]);
    setenv("TEST_LIBRARIES_BEGUN", "1", 1);
}

int main(int argc, char **argv)
{
    (void)argc;
    forget_environment();
    libraries_prepare(argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waiting_threads_sleep),
        cmocka_unit_test(heap_is_on_huge_pages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
