/* Chains with jumps (chain/pss_jump.h) on a toy of two techniques for a number x of
 * [0,1]: x = u, and the larger one of two numbers, which loses the other. With the
 * densities 1 and 2x and C(x) = exp(-6x) (1 + cos(20x)) both have the target 2 C / (1 +
 * 2x), and the share of states in a part of [0,1] is that of C's integral. Numbers that
 * are kept where they are to be drawn anew, or techniques drawn by other weights, change
 * these shares, as such states do not return to uniform numbers.
 *
 * Shares of 8 parts of [0,1], and of the first technique in each, as means of independent
 * chains: t-tests against quadrature. False alarms of all: FALSE_ALARM. What the tests
 * see is printed: the smallest relative error that fails one in nine runs of ten. */

#include "chain/chain.h"
#include "chain/pss_jump.h"
#include "math/accum.h"
#include "support/stat_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define PARTS       8
#define CHAINS      60
#define BURN_IN     2000
#define STATES      200000

static double integrand(double x)
{
    return exp(-6.0 * x) * (1.0 + cos(20.0 * x));
}

static double target_of(double x)
{
    return 2.0 * integrand(x) / (1.0 + 2.0 * x);
}

static bool first_technique(double u)
{
    return u < 0.5;
}

/* The splat's pixel: 2 parts + technique. */
static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    (void)ctx;
    bool first = first_technique(*ustream_take(numbers->connect, 0, 1));
    double x;
    if (first) {
        x = *ustream_take(numbers->camera, 0, 1);
    } else {
        const double *u = ustream_take(numbers->light, 0, 2);
        x = fmax(u[0], u[1]);
    }
    contrib_clear(out);
    contrib_add(out, 2 * (int)(x * PARTS) + !first, rgb_grey(target_of(x)), 1, 1);
}

static enum inversion invert(void *ctx, const struct numbers *current, struct rng *rng,
                             struct found *found, struct contrib *again)
{
    bool was_first = first_technique(*ustream_take(current->connect, 0, 1));
    eval(ctx, current, again);
    double x, chance;
    if (was_first) {
        x = *ustream_take(current->camera, 0, 1);
    } else {
        const double *u = ustream_take(current->light, 0, 2);
        x = fmax(u[0], u[1]);
    }
    chance = 1.0 / (1.0 + 2.0 * x); /* of the first, by the balance heuristic */
    bool first = rng_double(rng) < chance;
    if (first == was_first)
        return INVERSION_SAME;
    *found->connect.value = 0.5 * (rng_double(rng) + !first);
    if (first) {
        *found->camera.value = x;
    } else {
        int larger = rng_double(rng) < 0.5;
        found->light.value[larger] = x;
        found->light.value[!larger] = x * rng_double(rng);
    }
    return INVERSION_OTHER;
}

/* Expected shares: [part], and [PARTS + part] of the first technique in it. */
static void find_truth(double share[2 * PARTS])
{
    const int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < 2 * PARTS; i++)
        share[i] = 0.0;
    for (int i = 0; i < n; i++) {
        double x = (i + 0.5) / n, c = integrand(x);
        int part = (int)(x * PARTS);
        share[part] += c;
        share[PARTS + part] += c / (1.0 + 2.0 * x);
        sum += c;
    }
    for (int i = 0; i < PARTS; i++) {
        share[PARTS + i] /= share[i];
        share[i] /= sum;
    }
}

static struct tally run_chain(int index, double share[2 * PARTS])
{
    struct pss_options options = {.capacity = {1, 2, 1}, .jump = 0.3, .invert = invert};
    struct chain_params params = {0.05, 1.0, ESTIMATOR_PLAIN};
    struct chain_sinks sinks = {.tape = NULL};
    struct target target = {eval, NULL};
    struct chain chain;
    double all[PARTS] = {0.0}, first[PARTS] = {0.0};
    kernel_init(&options.kernel, &kernel_exponential, 0.0, 0.0, 0.0);
    chain_init(&chain, &state_pss_jump, &options, 1);
    chain_seed(&chain, &target, 11, (uint64_t)index, (uint64_t)index);
    step_mh.advance(&chain, &params, &target, &sinks, BURN_IN);
    for (int i = 0; i < STATES; i++) {
        step_mh.advance(&chain, &params, &target, &sinks, 1);
        int pixel = chain.current->splats[0].pixel;
        all[pixel / 2] += 1.0;
        first[pixel / 2] += pixel % 2 == 0;
    }
    for (int i = 0; i < PARTS; i++) {
        share[i] = all[i] / STATES;
        share[PARTS + i] = all[i] > 0.0 ? first[i] / all[i] : 0.5;
    }
    struct tally tally = chain.tally;
    chain_deinit(&chain);
    return tally;
}

static void test_shares(void **state)
{
    double truth[2 * PARTS], level = stat_sidak(FALSE_ALARM, 2 * PARTS), worst = 0.0;
    struct welford of[2 * PARTS] = {{0}};
    struct tally tally = {0};
    bool ok = true;
    (void)state;
    find_truth(truth);
    for (int i = 0; i < CHAINS; i++) {
        double share[2 * PARTS];
        struct tally one = run_chain(i, share);
        tally_add(&tally, &one);
        for (int j = 0; j < 2 * PARTS; j++)
            welford_add(&of[j], share[j]);
    }
    for (int j = 0; j < 2 * PARTS; j++) {
        char line[96];
        double se = welford_se(&of[j]), t = (of[j].mean - truth[j]) / se;
        snprintf(line, sizeof line, "%s of part %d: %.6g +- %.2g for %.6g",
                 j < PARTS ? "share" : "first technique", j % PARTS, of[j].mean, se,
                 truth[j]);
        double sees = stat_t_seen(level, CHAINS - 1.0, 0.9) * se / truth[j];
        printf("%s, t %.2f, sees %.2f %%\n", line, t, 100.0 * sees);
        ok = stat_ok(line, stat_t_p(t, CHAINS - 1.0), level) && ok;
        worst = fmax(worst, fabs(t));
    }
    double jumps = (double)tally.proposed[MOVE_JUMP];
    printf("%.0f jumps, acceptance %.9f; worst t %.2f\n", jumps,
           tally.acceptance[MOVE_JUMP] / jumps, worst);
    assert_true(tally.acceptance[MOVE_JUMP] > (1.0 - 1e-9) * jumps);
    assert_true(ok);
}

/* What the path has already. */
static enum inversion keep(void *ctx, const struct numbers *current, struct rng *rng,
                           struct found *found, struct contrib *again)
{
    (void)rng, (void)found;
    eval(ctx, current, again);
    return INVERSION_SAME;
}

/* A chain that only jumps is as stuck as one that rejects everything. */
static void test_jumps_are_no_moves(void **state)
{
    const pss_invert ways[] = {keep, invert};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct pss_options options = {
            .capacity = {1, 2, 1}, .jump = 1.0, .invert = ways[i]};
        struct chain_params params = {0.0, 1.0, ESTIMATOR_PLAIN};
        struct chain_sinks sinks = {.tape = NULL};
        struct target target = {eval, NULL};
        struct chain chain;
        kernel_init(&options.kernel, &kernel_gaussian, 0.0, 0.0, 0.0);
        chain_init(&chain, &state_pss_jump, &options, 1);
        chain_seed(&chain, &target, 11, 0, 0);
        step_mh.advance(&chain, &params, &target, &sinks, 1000);
        const struct tally *t = &chain.tally;
        assert_int_equal(t->proposed[MOVE_JUMP] + t->proposed[MOVE_STAY], 1000);
        assert_true(t->accepted[MOVE_JUMP] + t->accepted[MOVE_STAY] > 900);
        assert_int_equal(tally_moves(t), 0);
        assert_int_equal(chain.most_rejections_in_row, 1000);
        chain_deinit(&chain);
    }
}

/* An inverse that is none is rejected. */
static enum inversion refuse(void *ctx, const struct numbers *current, struct rng *rng,
                             struct found *found, struct contrib *again)
{
    (void)rng, (void)found;
    eval(ctx, current, again);
    return INVERSION_NONE;
}

static enum inversion mislead(void *ctx, const struct numbers *current, struct rng *rng,
                              struct found *found, struct contrib *again)
{
    eval(ctx, current, again);
    *found->connect.value = 0.25;
    *found->camera.value = rng_double(rng) * 0.1;
    return INVERSION_OTHER;
}

static void test_bad_inverses_are_counted(void **state)
{
    const pss_invert bad[] = {refuse, mislead};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct pss_options options = {
            .capacity = {1, 2, 1}, .jump = 0.3, .invert = bad[i]};
        struct chain_params params = {0.05, 1.0, ESTIMATOR_PLAIN};
        struct chain_sinks sinks = {.tape = NULL};
        struct target target = {eval, NULL};
        struct chain chain;
        kernel_init(&options.kernel, &kernel_gaussian, 0.0, 0.0, 0.0);
        chain_init(&chain, &state_pss_jump, &options, 1);
        chain_seed(&chain, &target, 11, 0, 0);
        step_pf_exact.advance(&chain, &params, &target, &sinks, 5000);
        const struct tally *t = &chain.tally;
        assert_true(t->proposed[MOVE_JUMP] > 1000);
        assert_int_equal(t->failures[MOVE_JUMP][FAILURE_INVERSE] + t->nonzero[MOVE_JUMP],
                         t->proposed[MOVE_JUMP]);
        assert_int_equal(t->proposed[MOVE_SECOND_STAGE], 0);
        if (bad[i] == refuse)
            assert_int_equal(t->accepted[MOVE_JUMP], 0);
        else
            assert_true(t->nonzero[MOVE_JUMP] < t->proposed[MOVE_JUMP] / 2);
        chain_deinit(&chain);
    }
}

/* Carries light where the camera's number is below a half. */
static void eval_half(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    (void)ctx;
    double u = *ustream_take(numbers->camera, 0, 1);
    contrib_clear(out);
    if (u < 0.5)
        contrib_add(out, 0, rgb_grey(1.0), 0, 0);
}

static enum inversion keep_half(void *ctx, const struct numbers *current, struct rng *rng,
                                struct found *found, struct contrib *again)
{
    (void)rng, (void)found;
    eval_half(ctx, current, again);
    assert_true(again->target > 0.0);
    return INVERSION_SAME;
}

static bool never(void *ctx)
{
    (void)ctx;
    return false;
}

/* Jumps are proposed from states that carry light alone, whatever proposals were rejected
 * in between, and not where the target has no other numbers. */
static void test_where_jumps_start(void **state)
{
    (void)state;
    for (int alone = 0; alone < 2; alone++) {
        struct pss_options options = {.capacity = {1, 1, 1},
                                      .jump = 0.5,
                                      .invert = keep_half,
                                      .invertible = alone ? never : NULL};
        struct target target = {eval_half, NULL};
        struct chain chain;
        int jumps[2] = {0, 0};
        bool lit = false;
        kernel_init(&options.kernel, &kernel_exponential, 0.0, 0.0, 0.0);
        chain_init(&chain, &state_pss_jump, &options, 1);
        rng_init(&chain.rng, 5, RNG_TEST, 0);
        const struct state_type *type = chain.state->type;
        for (int i = 0; i < 2000; i++) {
            enum move move = i % 3 == 0 ? MOVE_LARGE : MOVE_LOCAL;
            struct proposal p = type->propose(chain.state, &target, move, chain.proposed);
            if (p.move == MOVE_STAY)
                jumps[lit]++;
            if (i == 0 || i % 4 == 1) {
                lit = chain.proposed->target > 0.0;
                type->accept(chain.state);
            } else {
                type->reject(chain.state);
            }
        }
        assert_int_equal(jumps[false], 0);
        assert_true(alone ? jumps[true] == 0 : jumps[true] > 200);
        chain_deinit(&chain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shares),
        cmocka_unit_test(test_jumps_are_no_moves),
        cmocka_unit_test(test_bad_inverses_are_counted),
        cmocka_unit_test(test_where_jumps_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
