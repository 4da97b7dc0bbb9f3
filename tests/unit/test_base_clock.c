/* base/clock: wall time runs while we sleep, CPU time does not; both count work. */
#include "base/clock.h"

#include <time.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void sleep_costs_wall_time_only(void **state)
{
    (void)state;
    double wall = clock_wall(), cpu = clock_cpu();
    nanosleep(&(struct timespec){0, 50000000}, NULL);
    assert_true(clock_wall() - wall >= 0.05);
    assert_true(clock_cpu() - cpu < 0.04);
}

static void work_costs_cpu_time(void **state)
{
    (void)state;
    double cpu = clock_cpu(), wall = clock_wall();
    while (clock_cpu() - cpu < 0.02)
        ;
    assert_true(clock_wall() - wall > 0.015);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleep_costs_wall_time_only),
        cmocka_unit_test(work_costs_cpu_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
