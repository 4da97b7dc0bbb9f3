/* base/machine: one line of text, whole or cut. */
#include "base/machine.h"

#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void it_is_a_line(void **state)
{
    (void)state;
    char name[128], cut[4];
    memset(name, 'x', sizeof name);
    machine_cpu_model(name, sizeof name);
    assert_non_null(memchr(name, '\0', sizeof name));
    assert_true(strlen(name) > 0);
    assert_null(strpbrk(name, "\n\t"));
    assert_true(name[strlen(name) - 1] != ' ');
    machine_cpu_model(cut, sizeof cut);
    assert_true(strlen(cut) < sizeof cut);
    assert_memory_equal(cut, name, strlen(cut));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_a_line)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
