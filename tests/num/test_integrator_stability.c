/* The table of stability sweeps (bench/stability.c writes all of it): here the most
 * extreme number of each, for one setup of every integrator; with ETALON_LONG all.
 * Nothing may fail. */

#include "support/stability_cases.h"
#include "support/stability_invariance.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define QUICK 0x8245u /* pt, pssmlt, mmlt, pfmlt exact, mlt */
#define LONG  (~0u)

static int count_failed(const struct stability_row *rows, int count)
{
    int failed = 0;
    for (int i = 0; i < count; i++) {
        if (rows[i].verdict != FAILED)
            continue;
        print_error("%s, %s %g, %s: %s; %g, reference %g\n", rows[i].of->category,
                    rows[i].of->name, rows[i].x, rows[i].setup, rows[i].note,
                    rows[i].value, rows[i].reference);
        failed++;
    }
    return failed;
}

static void sweeps(void **state)
{
    (void)state;
    static struct stability_row rows[STABILITY_ROWS_MOST];
    bool all = getenv("ETALON_LONG") != NULL;
    int count = 0;
    for (int i = 0; i < STABILITY_SWEEPS; i++) {
        const struct stability_sweep *sweep = &stability_sweeps[i];
        if (!all && (sweep->heavy || sweep->effort > 4.0))
            continue;
        for (int k = 0; k < (all ? sweep->count : 1); k++) {
            stability_need_rows(count);
            count += stability_run(sweep, sweep->x[k], all ? LONG : QUICK, rows + count);
        }
    }
    count += stability_pools(rows, count);
    stability_judge(rows, count);
    assert_int_equal(count_failed(rows, count), 0);
}

static void invariances(void **state)
{
    (void)state;
    static struct stability_row rows[STABILITY_ROWS_MOST];
    bool all = getenv("ETALON_LONG") != NULL;
    int count = 0;
    for (int i = 0; i < STABILITY_SETUPS; i++) {
        const struct stability_setup *setup = &stability_setups[i];
        if (stability_ignores_scale(setup))
            rows[count++] = stability_invariance(&stability_emission_bits, setup,
                                                 all ? 1 : 200);
        rows[count++] = stability_invariance(&stability_scale_bits, setup, all ? 1 : 40);
    }
    assert_int_equal(count_failed(rows, count), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(invariances),
        cmocka_unit_test(sweeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
