/* Bootstrap, seeds and statistics: exact laws, exact replays, any number of threads. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/bootstrap.h"
#include "chain/startup.h"
#include "support/toy_target.h"

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

/* Paths that are added are those of a longer one; the effective number is that of
 * [Kong92]. */
static void bootstrap_goes_on(void **state)
{
    (void)state;
    struct bootstrap whole, parts = {0};
    bootstrap_run(&whole, 7, 3000, 9, 1, targets, 2);
    bootstrap_extend(&parts, 7, 1001, 9, 1, targets, 1);
    bootstrap_extend(&parts, 1008, 1999, 9, 1, targets, 3);
    bootstrap_summarize(&parts, 1001);
    assert_true(whole.b != parts.b && whole.effective == parts.effective);
    bootstrap_summarize(&parts, 3000);
    assert_memory_equal(whole.targets, parts.targets, 3000 * sizeof *whole.targets);
    assert_memory_equal(whole.pixels, parts.pixels, 3000 * sizeof *whole.pixels);
    assert_true(whole.b == parts.b && whole.effective == parts.effective);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < 3000; i++) {
        sum += whole.targets[i];
        squares += whole.targets[i] * whole.targets[i];
    }
    assert_true(fabs(whole.effective / (sum * sum / squares) - 1.0) < 1e-12);
    bootstrap_deinit(&whole);
    bootstrap_deinit(&parts);
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

static struct statistics_part part_of(const struct tally *tallies, int chains)
{
    return (struct statistics_part){.tallies = tallies, .chains = chains};
}

static void measure(const struct tally *tallies, int chains, struct statistics *out)
{
    struct statistics_part part = part_of(tallies, chains);
    statistics_measure(&part, 1, out);
}

static void assert_close(double x, double y)
{
    if (!(fabs(x - y) <= 1e-13 * fmax(1.0, fabs(y))))
        fprintf(stderr, "%.17g is not %.17g\n", x, y);
    assert_true(fabs(x - y) <= 1e-13 * fmax(1.0, fabs(y)));
}

static void statistics_by_hand(void **state)
{
    (void)state;
    struct statistics s;
    measure(hand, 3, &s);
    assert_true(s.eta_s == 18.0 / 30 && s.eta_l == 4.0 / 20 && s.eta_0 == 15.0 / 20);
    assert_close(s.r, 4.0 / 15);
    assert_close(s.q, 1.0 / 3);
    assert_close(s.failure_rate, 10.0 / 50);
    assert_true(s.small == 30 && s.large == 20 && s.seeds == 3.0);
    /* residuals: small -1, 1.2, -.2; large -.2, .4, -.2; r: -1/15, 6/15, -5/15 */
    assert_close(s.eta_s_se, sqrt(1.5 * 2.48) / 30);
    assert_close(s.eta_l_se, sqrt(1.5 * 0.24) / 20);
    assert_close(s.r_se, sqrt(1.5 * 62.0 / 225) / 15);
    assert_close(s.failure_rate_se, sqrt(1.5 * (0.64 + 1.44 + 0.16)) / 50);
    /* of eta_l/eta_s: large/20 - q small/30, over eta_s */
    double x = -0.01 + 1.0 / 90, y = 0.02 - 1.2 / 90, z = -0.01 + 0.2 / 90;
    assert_close(s.q_se, sqrt(1.5 * (x * x + y * y + z * z)) / 0.6);
    /* Two units hold almost all of the variance: 2 V^2 / (sum v^2 - V^2 / 3). */
    double v = 2.48, fourths = 1.0 + 1.2 * 1.2 * 1.2 * 1.2 + 0.2 * 0.2 * 0.2 * 0.2;
    assert_close(s.eta_s_freedom, fmin(2.0, 2.0 * v * v / (fourths - v * v / 3.0)));
    assert_true(s.r_lo <= s.r && s.r_hi > s.r);
}

/* Chains of one path are one unit, whatever they are among themselves. */
static void chains_of_one_seed_are_one_unit(void **state)
{
    (void)state;
    static const struct tally four[4] = {
        {.proposed = SMALL_LARGE(10, 10), .acceptance = SMALL_LARGE(5.0, 1.0)},
        {.proposed = SMALL_LARGE(10, 10), .acceptance = SMALL_LARGE(7.0, 1.0)},
        {.proposed = SMALL_LARGE(10, 10), .acceptance = SMALL_LARGE(2.0, 3.0)},
        {.proposed = SMALL_LARGE(10, 10), .acceptance = SMALL_LARGE(2.0, 3.0)},
    };
    static const int64_t seeds[4] = {3, 3, 8, 9};
    struct statistics_part part = {.tallies = four, .seeds = seeds, .chains = 4};
    struct statistics s;
    statistics_measure(&part, 1, &s);
    assert_true(s.seeds == 3.0 && s.eta_s == 0.4);
    /* residuals 4, -2, -2; shares of the chains 1/2, 1/4, 1/4 */
    assert_close(s.eta_s_se, sqrt(16.0 / 0.5 + 4.0 / 0.75 + 4.0 / 0.75) / 40);
    double large = s.eta_l_se;
    part.seeds = NULL;
    statistics_measure(&part, 1, &s);
    assert_true(s.seeds == 4.0 && s.eta_l_se < large);
}

static void statistics_that_the_data_cannot_tell(void **state)
{
    (void)state;
    struct tally tallies[2] = {
        {.proposed = SMALL_LARGE(10, 0), .acceptance = SMALL_LARGE(5.0, 0.0)},
        {.proposed = SMALL_LARGE(10, 0), .acceptance = SMALL_LARGE(4.0, 0.0)}};
    static const int64_t same[2] = {1, 1};
    struct statistics_part part = {.tallies = tallies, .seeds = same, .chains = 2};
    struct statistics s;
    measure(tallies, 2, &s);
    assert_true(s.eta_s == 0.45 && s.eta_l == 0.0 && s.eta_0 == 0.0 && s.r == 0.0);
    assert_true(isfinite(s.eta_s_se) && isinf(s.eta_l_se) && isinf(s.q_se));
    assert_true(s.r_lo == 0.0 && s.r_hi == 1.0);
    measure(tallies, 1, &s);
    assert_true(s.eta_s == 0.5 && isinf(s.eta_s_se));
    statistics_measure(&part, 1, &s);
    assert_true(s.eta_s == 0.45 && isinf(s.eta_s_se) && s.eta_s_freedom == 1.0);
}

/* Of many equal units, one of which is far off, the freedom is that of one square. */
static void freedom_of_few_that_are_far_off(void **state)
{
    (void)state;
    static struct tally tallies[400];
    struct statistics s;
    for (int i = 0; i < 400; i++)
        tallies[i] = (struct tally){
            .proposed = SMALL_LARGE(10, 10),
            .acceptance = SMALL_LARGE(i % 2 ? 4.0 : 6.0, i == 7 ? 9.0 : 0.0)};
    measure(tallies, 400, &s);
    assert_close(s.eta_s_freedom, 399.0);
    assert_true(s.eta_l_freedom > 1.9 && s.eta_l_freedom < 2.1);
}

/* --- parts with a weight of their own --------------------------------------------- */

/* A part that weighs nothing changes nothing, whatever it holds. */
static void one_part_is_the_whole(void **state)
{
    (void)state;
    struct statistics one, whole;
    struct statistics_part parts[2] = {part_of(hand, 3), part_of(hand, 1)};
    measure(hand, 3, &one);
    parts[0].b = 0.25;
    statistics_measure(parts, 2, &whole);
    assert_close(whole.eta_s, one.eta_s);
    assert_close(whole.eta_s_se, one.eta_s_se);
    assert_close(whole.eta_l_se, one.eta_l_se);
    assert_close(whole.eta_0_se, one.eta_0_se);
    assert_close(whole.z_small, one.z_small);
    assert_close(whole.r, one.r);
    assert_close(whole.r_se, one.r_se);
    assert_close(whole.r_freedom, one.r_freedom);
    assert_close(whole.q_se, one.q_se);
    assert_int_equal(whole.small, 40);
}

static const struct tally other[2] = {
    {.proposed = SMALL_LARGE(10, 10),
     .nonzero = SMALL_LARGE(5, 4),
     .acceptance = SMALL_LARGE(1.0, 1.0)},
    {.proposed = SMALL_LARGE(10, 10),
     .nonzero = SMALL_LARGE(5, 2),
     .acceptance = SMALL_LARGE(3.0, 2.0)},
};

/* Errors of the parts and of their weights. */
static void parts_by_hand(void **state)
{
    (void)state;
    struct statistics a, b, whole;
    struct statistics_part parts[2] = {part_of(hand, 3), part_of(other, 2)};
    parts[0].b = 6.0;
    parts[1].b = 2.0;
    measure(hand, 3, &a);
    measure(other, 2, &b);
    statistics_measure(parts, 2, &whole);
    assert_close(whole.eta_s, 0.75 * 0.6 + 0.25 * 0.2);
    assert_close(whole.eta_l, 0.75 * 0.2 + 0.25 * 0.15);
    assert_close(whole.r, whole.eta_l / (0.75 * 0.75 + 0.25 * 0.3));
    double own = 0.5625 * a.eta_s_se * a.eta_s_se + 0.0625 * b.eta_s_se * b.eta_s_se;
    assert_close(whole.eta_s_se, sqrt(own));
    double acceptance = whole.acceptance_se;
    parts[0].b_variance = 0.5;
    parts[0].b_freedom = 7.0;
    parts[1].b_variance = 0.2;
    parts[1].b_freedom = 3.0;
    statistics_measure(parts, 2, &whole);
    double first = 0.1 * 0.1 * 0.5 / 64.0, second = 0.3 * 0.3 * 0.2 / 64.0;
    assert_close(whole.eta_s_se, sqrt(own + first + second));
    /* r: (d eta_l - r d eta_0) / eta_0 for the weights, as for the units */
    double r = whole.r, z = whole.eta_0, l = whole.eta_l;
    double d = ((0.2 - l) - r * (0.75 - z)) / z, e = ((0.15 - l) - r * (0.3 - z)) / z;
    struct statistics bare;
    parts[0].b_variance = parts[1].b_variance = 0.0;
    statistics_measure(parts, 2, &bare);
    assert_close(whole.r_se * whole.r_se - bare.r_se * bare.r_se,
                 (d * d * 0.5 + e * e * 0.2) / 64.0);
    assert_close(whole.acceptance_se, acceptance);
}

/* A part of a single unit is taken to vary as the others do; with none to go by, and
 * where all weigh nothing, the error cannot be told. */
static void single_units_borrow(void **state)
{
    (void)state;
    struct statistics one, whole;
    struct statistics_part parts[2] = {part_of(hand, 3), part_of(other, 1)};
    parts[0].b = parts[1].b = 1.0;
    measure(hand, 3, &one);
    statistics_measure(parts, 2, &whole);
    double v = one.eta_s_se * one.eta_s_se;
    assert_close(whole.eta_s_se, sqrt(0.25 * v + 0.25 * 3.0 * v));
    parts[0].chains = 1;
    statistics_measure(parts, 2, &whole);
    assert_true(isinf(whole.eta_l_se) && isinf(whole.r_se) && isfinite(whole.r));
    assert_true(whole.r_freedom == 1.0 && whole.r_lo == 0.0 && whole.r_hi == 1.0);
    parts[0] = part_of(hand, 3);
    parts[1].b = 0.0;
    statistics_measure(parts, 2, &whole);
    assert_true(isinf(whole.eta_s_se) && isfinite(whole.acceptance_se));
}

/* Acceptance and failures of a run hold the error of the p_l that its start gave: by the
 * units of the start, whose x of q adds to theirs, or as a variance. */
static void mixing_adds_to_acceptance(void **state)
{
    (void)state;
    struct statistics start, bare, slope, variance;
    struct statistics_part part = part_of(hand, 3);
    struct statistics_mixing none = {.freedom = 1.0};
    struct statistics_mixing by_q = {.slope = {100.0, -100.0}, .freedom = 1.0};
    struct statistics_mixing by_variance = {.variance = {4.0, 9.0}, .freedom = 2.0};
    statistics_measure(&part, 1, &start);
    statistics_measure_after(&part, &part, 1, &none, &bare);
    assert_close(bare.acceptance_se, start.acceptance_se);
    statistics_measure_after(&part, &part, 1, &by_q, &slope);
    /* of x + 100 x_q the second is nearly all */
    assert_true(fabs(slope.acceptance_se / (100.0 * start.q_se) - 1.0) <
                start.acceptance_se / (100.0 * start.q_se) + 1e-12);
    assert_true(slope.acceptance_se > 2.0 * start.acceptance_se);
    statistics_measure_after(&part, &part, 1, &by_variance, &variance);
    assert_close(variance.acceptance_se * variance.acceptance_se,
                 start.acceptance_se * start.acceptance_se + 4.0);
    assert_close(variance.failure_rate_se * variance.failure_rate_se,
                 start.failure_rate_se * start.failure_rate_se + 9.0);
    assert_close(variance.eta_s_se, start.eta_s_se);
}

static void tallies_add_and_subtract(void **state)
{
    (void)state;
    const struct tally a = {{1, 2, 3},     {3, 4, 5}, {5, 6, 7}, {7.5, 8.5, 9.5},
                            {3.0, 5.5},    9.25,      10.5,      11.5,
                            {{0, 1}, {2}}, 12,        7,         13};
    const struct tally b = {{10, 20, 1},  {30, 40}, {50, 60}, {70.5, 80.5, 90.5},
                            {6.5, 2.0},   90.25,    100.5,    110.5,
                            {{20}, {40}}, 120,      70,       130};
    struct tally sum = a, difference;
    tally_add(&sum, &b);
    assert_true(sum.proposed[0] == 11 && sum.accepted[1] == 44 && sum.nonzero[0] == 55);
    assert_true(sum.acceptance[1] == 89.0 && sum.large_sum == 99.5);
    assert_true(sum.large_sum_fourths == 122.0);
    assert_true(sum.work[0] == 9.5 && sum.work[1] == 7.5);
    assert_true(sum.large_sum_squares == 111.0 && sum.acceptance[2] == 100.0);
    assert_true(sum.failures[0][0] == 20 && sum.failures[1][0] == 42);
    assert_true(sum.failures[0][1] == 1 && sum.excluded == 132 && sum.zero_states == 77);
    assert_int_equal(sum.final_failures, 143);
    difference = tally_difference(&sum, &b);
    assert_memory_equal(&difference, &a, sizeof a);
}

static void moves_to_other_paths_count(void **state)
{
    (void)state;
    const struct tally still = {.proposed = {5, 6, 7}, .nonzero = {5, 6, 7}};
    assert_int_equal(tally_moves(&still), 0);
    for (int move = 0; move < MOVES_MOST; move++) {
        struct tally moved = still;
        moved.accepted[move] = 3;
        assert_int_equal(tally_moves(&moved), move_keeps_path(move) ? 0 : 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bootstrap_is_the_same_for_any_threads),
        cmocka_unit_test(bootstrap_goes_on),
        cmocka_unit_test(seeds_replay_the_bootstrap),
        cmocka_unit_test(chains_of_one_seed_differ),
        cmocka_unit_test(selection_has_the_expected_counts),
        cmocka_unit_test(selection_at_the_ends),
        cmocka_unit_test(nonfinite_paths_count_as_black),
        cmocka_unit_test(statistics_by_hand),
        cmocka_unit_test(statistics_that_the_data_cannot_tell),
        cmocka_unit_test(chains_of_one_seed_are_one_unit),
        cmocka_unit_test(freedom_of_few_that_are_far_off),
        cmocka_unit_test(mixing_adds_to_acceptance),
        cmocka_unit_test(tallies_add_and_subtract),
        cmocka_unit_test(moves_to_other_paths_count),
        cmocka_unit_test(one_part_is_the_whole),
        cmocka_unit_test(parts_by_hand),
        cmocka_unit_test(single_units_borrow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
