/* The rule that ends a run before its budget, on made-up verdicts: when it looks, what it
 * waits for, and how often it errs if every look is a new chance to. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "convergence/until.h"

#include "math/law.h"
#include "math/rng.h"
#include "support/test_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define PARTS 8

static struct verdict made(enum verdict_call call, double relmse, double relmse_se)
{
    return (struct verdict){.call = call,
                            .error_bars_valid = call >= VERDICT_BLIND,
                            .parts = PARTS,
                            .relmse = relmse,
                            .relmse_se = relmse_se};
}

/* What a run waits for. */
struct wish {
    bool converged;
    double relmse;
};

static const struct wish no_wish = {0}, converged = {.converged = true},
                         below = {.relmse = 0.01}, both = {true, 0.01};

static struct until begin(const struct wish *wish)
{
    struct until until;
    until_init(&until, wish->converged, wish->relmse);
    return until;
}

static void looks_are_at_fixed_places(void **state)
{
    (void)state;
    const double places[] = {8.0, 12.0, 18.0, 27.0, 40.5};
    struct verdict v = made(VERDICT_SHORT, 1.0, 0.1);
    const struct wish *const wishes[] = {&converged, &below};
    struct until none = begin(&no_wish), until = begin(&converged);
    assert_false(until_due(&none, 1e9));
    for (int w = 0; w < 2; w++) {
        until = begin(wishes[w]);
        for (int i = 0; i < 5; i++) {
            assert_false(until_due(&until, places[i] - 1e-9));
            assert_true(until_due(&until, places[i]));
            assert_false(until_look(&until, places[i], &v));
        }
    }
    assert_int_equal(until.looks, 5);
    assert_false(until_look(&until, 1000.0, &v)); /* a long round: one look */
    assert_false(until_due(&until, 1037.0));
    assert_true(until_due(&until, 1038.0)); /* 8 * 1.5^12 */
    assert_int_equal(until.looks, 6);
}

/* Looks of this sequence: c converged, b blind, n not. How many until it ends; 0: never.
 */
static int ends_after(const char *sequence, const struct wish *wish)
{
    struct until until = begin(wish);
    for (int i = 0; sequence[i]; i++) {
        struct verdict v = made(sequence[i] == 'c'   ? VERDICT_CONVERGED
                                : sequence[i] == 'b' ? VERDICT_BLIND
                                                     : VERDICT_NOT,
                                0.005, 1e-4);
        if (until_look(&until, until.next, &v))
            return i + 1;
    }
    return 0;
}

static void two_looks_in_succession(void **state)
{
    (void)state;
    assert_int_equal(ends_after("nccc", &converged), 3);
    assert_int_equal(ends_after("cncncn", &converged), 0);
    assert_int_equal(ends_after("cnnbb", &converged), 5);
    assert_int_equal(ends_after("cbc", &converged), 2);
    assert_int_equal(ends_after("nc", &below), 2); /* bars that hold do at once */
    assert_int_equal(ends_after("nnn", &below), 0);
    assert_int_equal(ends_after("cc", &both), 2);
    assert_int_equal(ends_after("c", &both), 0);
}

/* Noise above what "converged" allows is no matter to who asks for more of it; anything
 * else is. */
static void bars_that_hold(void **state)
{
    (void)state;
    const struct wish loose = {.relmse = 0.5};
    struct verdict v = made(VERDICT_NOT, 0.3, 0.001);
    struct until until = begin(&loose);
    assert_false(until_look(&until, 8.0, &v));
    assert_true(isnan(until.bound));
    v.error_bars_valid = true;
    assert_true(until_look(&until, 12.0, &v));
    assert_true(until.bound > 0.3 && until.bound < 0.31);
    v.parts = 1;
    assert_false(until_look(&until, 18.0, &v));
}

/* 20 looks with errors of their own, at a relMSE that is just what must not be called
 * less. Their levels sum to .05 * 20/21; the runs that end are binomial, and the limit is
 * passed by chance once in 10^4. With the level of each look at .05, 64 % of the runs
 * would end, with twice the right levels 9.1 %: always seen. */
static void many_looks_are_no_more_chances(void **state)
{
    (void)state;
    const int runs = 20000, looks = 20;
    const double truth = 0.01, spread = 0.05 * truth;
    struct rng rng;
    int ended = 0;
    rng_init(&rng, 5, RNG_TEST, 0);
    for (int run = 0; run < runs; run++) {
        struct until until = begin(&below);
        bool reached = false;
        for (int k = 0; k < looks && !reached; k++) {
            double x[PARTS], mean = 0.0, squares = 0.0;
            for (int i = 0; i < PARTS; i++) {
                double u = rng_double(&rng);
                x[i] = truth + spread * law_normal_quantile(u > 0.0 ? u : 0.5);
                mean += x[i] / PARTS;
            }
            for (int i = 0; i < PARTS; i++)
                squares += (x[i] - mean) * (x[i] - mean);
            struct verdict v = made(VERDICT_CONVERGED, mean,
                                    sqrt(squares / (PARTS * (PARTS - 1.0))));
            reached = until_look(&until, until.next, &v);
        }
        ended += reached;
    }
    double rate = 0.05 * looks / (looks + 1.0); /* at most: looks that agree share it */
    printf("%d of %d runs end (%.4f), at most %.4f expected\n", ended, runs,
           (double)ended / runs, rate);
    assert_true(ended < rate * runs + 3.72 * sqrt(rate * (1.0 - rate) * runs));
    assert_true(ended > 0.8 * rate * runs); /* and no look is wasted */
}

static void resumed_for_the_same(void **state)
{
    (void)state;
    char *path = test_file("until.pack");
    const struct wish *const wishes[] = {&converged, &below, &both, &no_wish};
    struct err err = {0};
    struct until until = begin(&converged), other;
    struct verdict v = made(VERDICT_CONVERGED, 0.005, 1e-4);
    until_look(&until, 8.0, &v);
    assert_true(until_look(&until, 12.0, &v));
    for (int i = 0; i < 4; i++) {
        struct pack *pack = pack_create(path, 1, &err);
        assert_non_null(pack);
        until_pack(pack, &until);
        assert_true(pack_close(pack, &err));
        pack = pack_open(path, 1, &err);
        assert_non_null(pack);
        other = begin(wishes[i]);
        until_pack(pack, &other);
        assert_true(pack_close(pack, &err));
        assert_int_equal(other.looks, 2);
        assert_int_equal(other.agreed, 2);
        assert_true(other.next == 18.0 && other.bound == until.bound);
        assert_int_equal(other.reached, i == 0);
    }
    remove(path);
    mem_free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(looks_are_at_fixed_places),
        cmocka_unit_test(two_looks_in_succession),
        cmocka_unit_test(bars_that_hold),
        cmocka_unit_test(many_looks_are_no_more_chances),
        cmocka_unit_test(resumed_for_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
