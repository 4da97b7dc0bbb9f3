/* Bootstrap, seeds and statistics: exact laws, exact replays, any number of threads. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/startup.h"
#include "support/toy_target.h"

#include <gsl/gsl_cdf.h>
#include <stdio.h>

static struct toy toy = {8};
static const struct target targets[3] = {
    {toy_eval, &toy}, {toy_eval, &toy}, {toy_eval, &toy}};

static void bootstrap_is_the_same_for_any_threads(void **state)
{
    (void)state;
    struct bootstrap one, more;
    bootstrap_run(&one, 0, 5001, 9, 1, targets, 1);
    for (int threads = 2; threads <= 3; threads++) {
        bootstrap_run(&more, 0, 5001, 9, 1, targets, threads);
        assert_memory_equal(one.targets, more.targets, 5001 * sizeof *one.targets);
        assert_true(one.b == more.b && one.b_se == more.b_se);
        assert_true(one.eta_0 == more.eta_0 && one.eta_0_se == more.eta_0_se);
        bootstrap_deinit(&more);
    }
    double sum = 0.0, nonzero = 0.0;
    for (int i = 0; i < 5001; i++) {
        sum += one.targets[i];
        nonzero += one.targets[i] > 0.0;
    }
    assert_true(fabs(one.b / (sum / 5001) - 1.0) < 1e-12);
    assert_true(fabs(one.eta_0 - nonzero / 5001) < 1e-12);
    assert_true(fabs(one.eta_0_se * one.eta_0_se * 5000 / (one.eta_0 * (1 - one.eta_0)) -
                     1.0) < 1e-9);
    bootstrap_deinit(&one);
}

/* A seed is the bootstrap's path itself, every number of it. */
static void seeds_replay_the_bootstrap(void **state)
{
    (void)state;
    struct bootstrap bootstrap;
    struct chain chain;
    bootstrap_run(&bootstrap, 0, 400, 9, 1, targets, 2);
    toy_chain_init(&chain, &kernel_gaussian);
    for (uint64_t i = 0; i < 400; i++) {
        chain_seed(&chain, &targets[0], 9, i, 3);
        assert_true(chain.current->target == bootstrap.targets[i]);
        struct contrib again;
        double x[TOY_MAX] = {0};
        contrib_init(&again, 1);
        toy_state(&chain, &toy, x);
        toy_fill(&toy, x, &again);
        assert_true(again.target == bootstrap.targets[i]);
        contrib_deinit(&again);
    }
    chain_deinit(&chain);
    bootstrap_deinit(&bootstrap);
}

/* Two chains from one seed part ways at once, and do not go on with the path's numbers.
 */
static void chains_of_one_seed_differ(void **state)
{
    (void)state;
    double first[2][2];
    for (uint64_t id = 0; id < 2; id++) {
        struct chain chain;
        toy_chain_init(&chain, &kernel_exponential);
        chain_seed(&chain, &targets[0], 9, 5, id);
        pss_begin(pss_of(&chain), true);
        memcpy(first[id], ustream_take(pss_numbers(pss_of(&chain)).camera, 0, 2),
               sizeof first[id]);
        chain_deinit(&chain);
    }
    assert_true(first[0][0] != first[1][0] && first[0][1] != first[1][1]);
}

/* Systematic resampling: over a grid of u every path is picked in proportion to its
 * target, and for each u its count is one of the two integers about the expected one. */
static void selection_has_the_expected_counts(void **state)
{
    (void)state;
    double values[] = {0.0, 1.0, 0.25, 0.0, 3.0, 0.5, 0.0, 2.25, 0.0};
    enum { PATHS = 9, CHAINS = 10, GRID = 7000 };
    struct bootstrap bootstrap = {.count = PATHS, .targets = values};
    double counts[PATHS] = {0};
    for (int g = 0; g < GRID; g++) {
        long seeds[CHAINS];
        int now[PATHS] = {0};
        bootstrap_select(&bootstrap, (g + 0.5) / GRID, seeds, CHAINS);
        for (int j = 0; j < CHAINS; j++) {
            assert_true(j == 0 || seeds[j - 1] <= seeds[j]);
            counts[seeds[j]]++;
            now[seeds[j]]++;
        }
        for (int i = 0; i < PATHS; i++)
            assert_true(fabs(now[i] - CHAINS * values[i] / 7.0) < 1.0);
    }
    for (int i = 0; i < PATHS; i++)
        assert_true(fabs(counts[i] / GRID - CHAINS * values[i] / 7.0) < 2.0 / GRID);
}

static void selection_at_the_ends(void **state)
{
    (void)state;
    enum { PATHS = 1000, CHAINS = 256 };
    double values[PATHS];
    for (int i = 0; i < PATHS; i++)
        values[i] = i < 990 ? 0.1 : 0.0;
    struct bootstrap bootstrap = {.count = PATHS, .targets = values};
    long seeds[CHAINS];
    bootstrap_select(&bootstrap, 1.0 - 0x1p-53, seeds, CHAINS);
    assert_int_equal(seeds[CHAINS - 1], 989);
    bootstrap_select(&bootstrap, 0.0, seeds, CHAINS);
    assert_int_equal(seeds[0], 0);
    values[0] = 0.0;
    bootstrap_select(&bootstrap, 0.0, seeds, CHAINS);
    assert_int_equal(seeds[0], 1);

    for (int i = 0; i < PATHS; i++)
        values[i] = 0.0;
    bootstrap_select(&bootstrap, 0.5, seeds, CHAINS);
    for (int j = 0; j < CHAINS; j++)
        assert_in_range(seeds[j], 0, PATHS - 1);
    assert_int_equal(seeds[CHAINS / 2], PATHS / 2);
}

static void not_a_number(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    toy_eval(ctx, numbers, out);
    if (out->target > 1.0)
        out->target = HUGE_VAL;
}

static void nonfinite_paths_count_as_black(void **state)
{
    (void)state;
    const struct target bad = {not_a_number, &toy};
    struct bootstrap bootstrap;
    bootstrap_run(&bootstrap, 0, 1000, 9, 1, &bad, 1);
    assert_in_range(bootstrap.nonfinite, 100, 900);
    assert_true(bootstrap.b > 0.0 && bootstrap.b < 1.0);
    bootstrap_deinit(&bootstrap);
}

/* Values of small and large steps. */
#define SMALL_LARGE(small, large)                      \
    {                                                  \
        [MOVE_SMALL] = (small), [MOVE_LARGE] = (large) \
    }

static const struct tally hand[3] = {
    {.proposed = SMALL_LARGE(10, 6),
     .nonzero = SMALL_LARGE(8, 4),
     .acceptance = SMALL_LARGE(5.0, 1.0)},
    {.proposed = SMALL_LARGE(8, 8),
     .nonzero = SMALL_LARGE(8, 6),
     .acceptance = SMALL_LARGE(6.0, 2.0)},
    {.proposed = SMALL_LARGE(12, 6),
     .nonzero = SMALL_LARGE(9, 5),
     .acceptance = SMALL_LARGE(7.0, 1.0)},
};

static void statistics_by_hand(void **state)
{
    (void)state;
    struct statistics s;
    statistics_measure(hand, 3, &s);
    assert_true(s.eta_s == 18.0 / 30 && s.eta_l == 4.0 / 20 && s.eta_0 == 15.0 / 20);
    assert_true(fabs(s.r - 4.0 / 15) < 1e-15);
    assert_int_equal(s.small, 30);
    assert_int_equal(s.large, 20);
    /* residuals: small -1, 1.2, -.2; large -.2, .4, -.2; r: -1/15, 6/15, -5/15 */
    assert_true(fabs(s.eta_s_se - sqrt(1.5 * 2.48) / 30) < 1e-15);
    assert_true(fabs(s.eta_l_se - sqrt(1.5 * 0.24) / 20) < 1e-15);
    assert_true(fabs(s.eta_sl_cov - 1.5 * 0.72 / 600) < 1e-15);
    assert_true(fabs(s.r_se - sqrt(1.5 * 62.0 / 225) / 15) < 1e-15);
    assert_true(fabs(s.quantile - 9.92484) < 1e-5);
    assert_true(s.r_lo == 0.0 && fabs(s.r_hi - fmin(1.0, s.r + 9.92484 * s.r_se)) < 1e-6);
}

static void statistics_that_the_data_cannot_tell(void **state)
{
    (void)state;
    struct tally tallies[2] = {
        {.proposed = {[MOVE_SMALL] = 10}, .acceptance = {[MOVE_SMALL] = 5.0}},
        {.proposed = {[MOVE_SMALL] = 10}, .acceptance = {[MOVE_SMALL] = 4.0}}};
    struct statistics s;
    statistics_measure(tallies, 2, &s);
    assert_true(s.eta_s == 0.45 && s.eta_l == 0.0 && s.eta_0 == 0.0 && s.r == 0.0);
    assert_true(isfinite(s.eta_s_se) && isinf(s.eta_l_se) && isinf(s.eta_sl_cov));
    assert_true(s.r_lo == 0.0 && s.r_hi == 1.0);
    statistics_measure(tallies, 1, &s);
    assert_true(s.eta_s == 0.5 && isinf(s.eta_s_se));
}

static void quantile_is_students(void **state)
{
    (void)state;
    static const struct tally tallies[400];
    for (int chains = 2; chains <= 400; chains++) {
        struct statistics s;
        statistics_measure(tallies, chains, &s);
        assert_true(fabs(s.quantile - gsl_cdf_tdist_Pinv(0.995, chains - 1)) < 1e-4);
    }
}

/* --- parts measured apart --------------------------------------------------------- */

static void assert_close(double x, double y)
{
    if (!(fabs(x - y) <= 1e-13 * fmax(1.0, fabs(y))))
        fprintf(stderr, "%.17g is not %.17g\n", x, y);
    assert_true(fabs(x - y) <= 1e-13 * fmax(1.0, fabs(y)));
}

/* One part is the whole; so is one beside others that weigh nothing, whatever they hold,
 * and then the error of r comes out of those of eta_l and eta_0 as it came out of the
 * chains. */
static void one_part_is_the_whole(void **state)
{
    (void)state;
    struct statistics parts[2], whole;
    const double weights[2] = {0.25, 0.0};
    statistics_measure(hand, 3, &parts[0]);
    statistics_join(parts, weights, 1, &whole);
    assert_memory_equal(&whole, &parts[0], sizeof whole);
    statistics_measure(hand, 1, &parts[1]); /* no errors: infinite */
    statistics_join(parts, weights, 2, &whole);
    assert_close(whole.eta_s, parts[0].eta_s);
    assert_close(whole.eta_s_se, parts[0].eta_s_se);
    assert_close(whole.eta_l_se, parts[0].eta_l_se);
    assert_close(whole.eta_0_se, parts[0].eta_0_se);
    assert_close(whole.z_small, parts[0].z_small);
    assert_close(whole.eta_sl_cov, parts[0].eta_sl_cov);
    assert_close(whole.eta_l0_cov, parts[0].eta_l0_cov);
    assert_close(whole.r, parts[0].r);
    assert_close(whole.r_se, parts[0].r_se);
    assert_close(whole.freedom, 2.0);
    assert_close(whole.quantile, parts[0].quantile);
    assert_int_equal(whole.small, parts[0].small + parts[1].small);
    assert_int_equal(whole.large, parts[0].large + parts[1].large);
}

static const struct statistics two_parts[2] = {
    {.eta_s = 0.8,
     .eta_s_se = 0.01,
     .eta_l = 0.3,
     .eta_l_se = 0.02,
     .eta_0 = 0.6,
     .eta_0_se = 0.03,
     .z_small = 0.9,
     .eta_sl_cov = 1e-5,
     .eta_l0_cov = 2e-4,
     .freedom = 3.0,
     .small = 100,
     .large = 50},
    {.eta_s = 0.4,
     .eta_s_se = 0.02,
     .eta_l = 0.1,
     .eta_l_se = 0.04,
     .eta_0 = 0.2,
     .eta_0_se = 0.01,
     .z_small = 0.5,
     .eta_sl_cov = -2e-5,
     .eta_l0_cov = 1e-4,
     .freedom = 30.0,
     .small = 7,
     .large = 9},
};

static void join_by_hand(void **state)
{
    (void)state;
    const double weights[2] = {6.0, 2.0}; /* only their ratio counts */
    struct statistics s;
    statistics_join(two_parts, weights, 2, &s);
    assert_close(s.eta_s, 0.7);
    assert_close(s.eta_l, 0.25);
    assert_close(s.eta_0, 0.5);
    assert_close(s.z_small, 0.8);
    assert_close(s.eta_s_se, sqrt(0.0075 * 0.0075 + 0.005 * 0.005));
    assert_close(s.eta_l_se, sqrt(0.015 * 0.015 + 0.01 * 0.01));
    assert_close(s.eta_0_se, sqrt(0.0225 * 0.0225 + 0.0025 * 0.0025));
    assert_close(s.eta_sl_cov, 0.5625 * 1e-5 - 0.0625 * 2e-5);
    assert_close(s.eta_l0_cov, 0.5625 * 2e-4 + 0.0625 * 1e-4);
    assert_int_equal(s.small, 107);
    assert_int_equal(s.large, 59);
    /* r = 1/2; the variances of eta_l - r eta_0 over eta_0^2, and their freedom
     * [Satterthwaite46]. */
    double a = 0.5625 * (4e-4 - 2e-4 + 0.25 * 9e-4) / 0.25;
    double b = 0.0625 * (16e-4 - 1e-4 + 0.25 * 1e-4) / 0.25;
    assert_close(s.r, 0.5);
    assert_close(s.r_se, sqrt(a + b));
    assert_close(s.freedom, (a + b) * (a + b) / (a * a / 3.0 + b * b / 30.0));
    assert_true(s.freedom > 3.0 && s.freedom < 33.0);
    assert_close(s.r_hi, s.r + s.quantile * s.r_se);
}

/* Equal parts have the sum of their freedoms; a part that weighs next to nothing leaves
 * that of the other. */
static void freedom_of_the_whole(void **state)
{
    (void)state;
    struct statistics parts[5], whole;
    const double even[5] = {1.0, 1.0, 1.0, 1.0, 1.0}, one[5] = {1.0, 1e-9};
    for (int i = 0; i < 5; i++)
        parts[i] = two_parts[0];
    statistics_join(parts, even, 5, &whole);
    assert_close(whole.freedom, 15.0);
    assert_close(whole.eta_s_se, 0.01 / sqrt(5.0));
    parts[1].freedom = 1.0;
    statistics_join(parts, one, 2, &whole);
    assert_true(fabs(whole.freedom - 3.0) < 1e-8);
}

/* What one part that counts cannot tell, the whole cannot. */
static void join_what_cannot_be_told(void **state)
{
    (void)state;
    struct statistics parts[2] = {two_parts[0]}, whole;
    const double weights[2] = {1.0, 1.0};
    statistics_measure(hand, 1, &parts[1]);
    statistics_join(parts, weights, 2, &whole);
    assert_true(isinf(whole.eta_l_se) && isinf(whole.r_se) && isfinite(whole.r));
    assert_true(whole.freedom == 1.0 && whole.r_lo == 0.0 && whole.r_hi == 1.0);
    parts[0].eta_0 = parts[1].eta_0 = parts[0].eta_l = parts[1].eta_l = 0.0;
    statistics_join(parts, weights, 2, &whole);
    assert_true(whole.r == 0.0 && whole.r_lo == 0.0 && whole.r_hi == 1.0);
}

static void tallies_add_and_subtract(void **state)
{
    (void)state;
    const struct tally a = {{1, 2, 3}, {3, 4, 5}, {5, 6, 7},     {7.5, 8.5, 9.5},
                            9.25,      10.5,      {{0, 1}, {2}}, 12,
                            7,         13};
    const struct tally b = {{10, 20, 1}, {30, 40}, {50, 60},     {70.5, 80.5, 90.5},
                            90.25,       100.5,    {{20}, {40}}, 120,
                            70,          130};
    struct tally sum = a, difference;
    tally_add(&sum, &b);
    assert_true(sum.proposed[0] == 11 && sum.accepted[1] == 44 && sum.nonzero[0] == 55);
    assert_true(sum.acceptance[1] == 89.0 && sum.large_sum == 99.5);
    assert_true(sum.large_sum_squares == 111.0 && sum.acceptance[2] == 100.0);
    assert_true(sum.failures[0][0] == 20 && sum.failures[1][0] == 42);
    assert_true(sum.failures[0][1] == 1 && sum.excluded == 132 && sum.zero_states == 77);
    assert_int_equal(sum.final_failures, 143);
    difference = tally_difference(&sum, &b);
    assert_memory_equal(&difference, &a, sizeof a);
}

static void every_move_counts(void **state)
{
    (void)state;
    const struct tally still = {.proposed = {5, 6, 7}, .nonzero = {5, 6, 7}};
    assert_int_equal(tally_moves(&still), 0);
    for (int move = 0; move < MOVES_MOST; move++) {
        struct tally moved = still;
        moved.accepted[move] = 3;
        assert_int_equal(tally_moves(&moved), 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bootstrap_is_the_same_for_any_threads),
        cmocka_unit_test(seeds_replay_the_bootstrap),
        cmocka_unit_test(chains_of_one_seed_differ),
        cmocka_unit_test(selection_has_the_expected_counts),
        cmocka_unit_test(selection_at_the_ends),
        cmocka_unit_test(nonfinite_paths_count_as_black),
        cmocka_unit_test(statistics_by_hand),
        cmocka_unit_test(statistics_that_the_data_cannot_tell),
        cmocka_unit_test(quantile_is_students),
        cmocka_unit_test(tallies_add_and_subtract),
        cmocka_unit_test(every_move_counts),
        cmocka_unit_test(one_part_is_the_whole),
        cmocka_unit_test(join_by_hand),
        cmocka_unit_test(freedom_of_the_whole),
        cmocka_unit_test(join_what_cannot_be_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
