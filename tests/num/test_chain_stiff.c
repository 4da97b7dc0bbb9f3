/* Stiff chains: targets on which small steps are nearly always accepted and large ones
 * nearly never. Chains that start from exact samples stay unbiased, whatever their
 * pictures spread by; tallies tell how badly they mix. False-alarm rate: 1e-4. */

#include "chain/plarge.h"
#include "chain/startup.h"
#include "support/stat_test.h"
#include "support/stiff_target.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define LEVEL stat_sidak(1e-4, 12)

static void check_cell(const struct stiff *stiff, const struct stiff_outcome *o, int cell)
{
    double exact = stiff_cell(stiff, cell), se = welford_se(&o->cell[cell]);
    printf("cell %d: %.4g +- %.2g, exact %.4g\n", cell, o->cell[cell].mean, se, exact);
    assert_true(se < 0.5 * exact); /* or the test could not fail */
    assert_true(
        stat_ok("cell", stat_mean_p(o->values[cell], STIFF_CHAINS, exact), LEVEL));
}

/* eta_s near 1, eta_l 1e-6: no bias, but chains that stay in the half that they began in,
 * as their spread tells, and a rule that owns up to knowing nothing. */
static void an_island_in_forty_dimensions(void **state)
{
    (void)state;
    struct stiff_outcome o;
    struct statistics s;
    stiff_run(&stiff_island, &stiff_mh, 0.5, 4000, &o);
    statistics_measure(
        &(struct statistics_part){.tallies = o.tallies, .chains = STIFF_CHAINS}, 1, &s);
    struct plarge p = plarge_zsolnai2013(&s);
    printf("eta_s %.4f, eta_l %.3g, eta_0 %.3g; %s\n", s.eta_s, s.eta_l, s.eta_0,
           p.reason);
    assert_true(s.eta_s > 0.95 && s.eta_l < 1e-4);
    assert_true(stat_ok("large steps that hit",
                        stat_binomial_p((long)o.all.nonzero[MOVE_LARGE],
                                        (long)o.all.proposed[MOVE_LARGE],
                                        stiff_volume(&stiff_island)),
                        LEVEL));
    check_cell(&stiff_island, &o, 0);
    check_cell(&stiff_island, &o, 1);
    /* Unmixed chains spread like single samples, sqrt(1/4 3/4). */
    double spread = sqrt(welford_variance(&o.cell[0])) / stiff_integral(&stiff_island);
    printf("spread between chains %.3f of at most %.3f\n", spread, sqrt(3.0) / 4.0);
    assert_true(spread > 0.3);
    assert_true(p.branch == PLARGE_DARK || p.unsure || p.p_l_hi - p.p_l_lo > 0.2);
    assert_non_null(strstr(p.reason, p.branch == PLARGE_DARK ? "no light" : "["));
}

/* A chain crosses over once in two million mutations; large steps counted apart need not
 * wait for it. */
static void two_islands(void **state)
{
    (void)state;
    struct stiff_outcome o;
    stiff_run(&stiff_two_islands, &stiff_mh, 0.3, 4000, &o);
    check_cell(&stiff_two_islands, &o, 0);
    check_cell(&stiff_two_islands, &o, 4);
}

/* The dim plateaus are 1e-12 of the picture, and right: large steps show them, and the
 * film keeps such splats. Chains alone would have to wait 1e12 mutations for a visit. */
static void plateaus_of_twelve_decades(void **state)
{
    (void)state;
    struct stiff_outcome o;
    stiff_run(&stiff_plateaus, &stiff_mh, 0.3, 4000, &o);
    for (int i = 0; i < 4; i++)
        check_cell(&stiff_plateaus, &o, i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_island_in_forty_dimensions),
        cmocka_unit_test(two_islands),
        cmocka_unit_test(plateaus_of_twelve_decades),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
