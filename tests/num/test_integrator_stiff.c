/* Chains that cannot mix in their budget, by the rule: every part of the run is right on
 * average and none is by itself, so the verdict has to doubt them. Where large steps make
 * up for it, it must not. */
#include "support/stiff_verdict.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static enum verdict_call judge(const struct stiff *stiff, const struct stiff_setup *setup,
                               double p_large, long mutations)
{
    char words[256];
    enum verdict_call call = stiff_judge(stiff, setup, p_large, mutations, words,
                                         sizeof words);
    printf("%s\n", words);
    return call;
}

/* Small steps do not leave the half that they began in, large ones do not hit. */
static void an_island_is_doubted(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_island, &stiff_mh, 0.5, 200), VERDICT_NOT);
    assert_int_equal(judge(&stiff_island, &stiff_plain, 0.05, 200), VERDICT_NOT);
}

/* No large step crosses over, as there is hardly one: chains stay on their plateau. */
static void plateaus_are_doubted(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_plateaus, &stiff_plain, 1e-5, 200), VERDICT_NOT);
    assert_int_equal(judge(&stiff_plateaus, &stiff_mh, 1e-5, 200), VERDICT_NOT);
}

/* The same, with large steps. */
static void mixed_chains_are_not(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_plateaus, &stiff_mh, 0.3, 200), VERDICT_CONVERGED);
    assert_int_equal(judge(&stiff_two_islands, &stiff_mh, 0.3, 200), VERDICT_CONVERGED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_island_is_doubted),
        cmocka_unit_test(plateaus_are_doubted),
        cmocka_unit_test(mixed_chains_are_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
