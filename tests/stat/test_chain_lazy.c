/* Lazy numbers have the law of eager ones, at rest and on the way there. The second
 * number of this toy exists for one half of the states only. Two wrong ways to be lazy
 * are run beside the right one, to show that these tests would see them. False-alarm rate
 * of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/stat_test.h"
#include "support/film_sinks.h"

#define CELLS 10 /* a side: of u1, for u0 in the used half, then for the other half */
#define LEVEL stat_sidak(1e-3, 10)
#define SEEN  1e-9 /* what a wrong way's p-value must lie below */

/* f(u0,u1) = steps(u1) for u0 < .5, where it has mean 1, and 1 elsewhere. */
static const double steps[CELLS] = {5, 0, 0, 0, 3, 1.5, 0, 0, .5, 0};

static double density(double u0, double u1)
{
    return u0 < 0.5 ? steps[(int)(CELLS * u1)] : 1.0;
}

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    (void)ctx;
    contrib_clear(out);
    double u0 = *ustream_take(numbers->camera, 0, 1);
    double f = density(u0, u0 < 0.5 ? *ustream_take(numbers->light, 1, 1) : 0.0);
    contrib_add(out, 0, (struct rgb){f, f, f}, 0, 0);
}

struct run {
    const struct kernel_type *kernel;
    double p_large;
    int mutations;
    bool exact_start; /* an exact sample of f, else (.75, .15) */
    uint64_t seed;
};

#define REPLICATES 20000

static void start(const struct run *run, struct rng *rng, double u[2])
{
    u[0] = 0.75;
    u[1] = 0.15;
    if (!run->exact_start)
        return;
    do {
        u[0] = rng_double(rng);
        u[1] = rng_double(rng);
    } while (rng_double(rng) * 5.0 >= density(u[0], u[1]));
}

static void count(double *counts, const double u[2])
{
    counts[(u[0] < 0.5 ? 0 : CELLS) + (int)(CELLS * u[1])]++;
}

static void kernel_of(const struct run *run, struct kernel *k)
{
    kernel_init(k, run->kernel, 0.06, 1.0 / 128, 1.0 / 8);
}

/* The chain under test; in the end the unused number is asked for as well. */
static void run_chain(const struct run *run, double *counts)
{
    const int capacity[PSS_STREAMS] = {1, 2, 0};
    struct kernel kernel;
    struct chain chain;
    kernel_of(run, &kernel);
    pss_chain_init(&chain, capacity, 1, &kernel);
    struct film_sinks films;
    film_sinks_create(&films, 1, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {run->p_large, 1.0, ESTIMATOR_KELEMEN};
    struct target target = {eval, NULL};
    double *u0 = &pss_of(&chain)->streams[PSS_CAMERA].current[0];
    double *u1 = &pss_of(&chain)->streams[PSS_LIGHT].current[1];
    for (uint64_t r = 0; r < REPLICATES; r++) {
        double u[2];
        rng_init(&chain.rng, run->seed, RNG_TEST, r);
        start(run, &chain.rng, u);
        pss_reset(pss_of(&chain));
        *u0 = u[0];
        *u1 = u[1];
        pss_of(&chain)->streams[PSS_CAMERA].stamp[0] = 0;
        pss_of(&chain)->streams[PSS_LIGHT].stamp[1] = 0;
        contrib_clear(chain.current);
        chain.current->target = density(u[0], u[1]);
        step_mh.advance(&chain, &params, &target, &films.sinks, run->mutations);
        struct numbers numbers = pss_numbers(pss_of(&chain));
        pss_begin(pss_of(&chain), false);
        ustream_take(numbers.camera, 0, 1);
        ustream_take(numbers.light, 1, 1);
        pss_reject(pss_of(&chain));
        count(counts, (double[]){*u0, *u1});
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

enum way { EAGER, ROLLED_BACK, NOT_CAUGHT_UP };

struct walker {
    const struct run *run;
    enum way way;
    struct kernel kernel;
    struct rng rng;
    double u[2], batch[KERNEL_BATCH];
    int left;   /* of the batch */
    int missed; /* accepted small steps that u[1] has not seen; -1: a large step */
};

static double small_step(struct walker *w, double x)
{
    if (w->left == 0) {
        w->kernel.type->draw(&w->kernel, &w->rng, w->batch);
        w->left = KERNEL_BATCH;
    }
    return kernel_wrap(x + w->batch[--w->left]);
}

static double caught_up(struct walker *w)
{
    double x = w->missed < 0 ? rng_double(&w->rng) : w->u[1];
    for (int i = 0; i < w->missed && w->way == ROLLED_BACK; i++)
        x = small_step(w, x);
    return x;
}

/* One mutation by a plain rendering of each way. */
static void mutate(struct walker *w)
{
    bool large = rng_double(&w->rng) < w->run->p_large;
    double y[2];
    y[0] = large ? rng_double(&w->rng) : small_step(w, w->u[0]);
    bool touched = w->way == EAGER || y[0] < 0.5;
    if (touched)
        y[1] = large ? rng_double(&w->rng) : small_step(w, caught_up(w));
    else
        y[1] = w->u[1];
    double ratio = density(y[0], y[1]) / density(w->u[0], w->u[1]);
    if (rng_double(&w->rng) >= ratio)
        return; /* rolled back: what was caught up is lost as well */
    w->u[0] = y[0];
    w->u[1] = y[1];
    if (touched)
        w->missed = 0;
    else if (large)
        w->missed = -1;
    else if (w->missed >= 0)
        w->missed++;
}

static void run_way(const struct run *run, enum way way, double *counts)
{
    struct walker w = {.run = run, .way = way};
    kernel_of(run, &w.kernel);
    for (uint64_t r = 0; r < REPLICATES; r++) {
        rng_init(&w.rng, run->seed + 1, RNG_TEST, r);
        start(run, &w.rng, w.u);
        w.missed = 0;
        w.left = 0;
        for (int i = 0; i < run->mutations; i++)
            mutate(&w);
        w.u[1] = caught_up(&w);
        count(counts, w.u);
    }
}

static double exact_p(const double *counts)
{
    double expected[2 * CELLS];
    for (int i = 0; i < 2 * CELLS; i++)
        expected[i] = REPLICATES * (i < CELLS ? steps[i] : 1.0) / (2 * CELLS);
    return stat_chi2_p(counts, expected, 2 * CELLS);
}

static double used_share(const double *counts)
{
    double used = 0.0;
    for (int i = 0; i < CELLS; i++)
        used += counts[i] / REPLICATES;
    return used;
}

static void stays_stationary(void **state)
{
    (void)state;
    for (int t = 0; kernel_types[t]; t++) {
        for (int p = 0; p < 2; p++) {
            struct run run = {kernel_types[t], p ? 0.3 : 0.02, 60, true, 31};
            double lazy[2 * CELLS] = {0};
            run_chain(&run, lazy);
            assert_true(stat_ok("lazy, at rest", exact_p(lazy), LEVEL));
        }
    }
}

static void rolling_back_is_seen(void **state)
{
    (void)state;
    struct run run = {&kernel_gaussian, 0.02, 60, true, 33};
    double eager[2 * CELLS] = {0}, rolled[2 * CELLS] = {0};
    run_way(&run, EAGER, eager);
    run_way(&run, ROLLED_BACK, rolled);
    print_message("used in .5 of the states: eager %.4f, rolled back %.4f\n",
                  used_share(eager), used_share(rolled));
    assert_true(stat_ok("eager, at rest", exact_p(eager), LEVEL));
    assert_true(exact_p(rolled) < SEEN);
}

/* After a few mutations from one point, where laws still differ from the target's. */
static void moves_as_eager_does(void **state)
{
    (void)state;
    for (int t = 0; kernel_types[t]; t++) {
        for (int p = 0; p < 2; p++) {
            struct run run = {kernel_types[t], p ? 0.3 : 0.02, 12, false, 35};
            double lazy[2 * CELLS] = {0}, eager[2 * CELLS] = {0};
            run_chain(&run, lazy);
            run_way(&run, EAGER, eager);
            double p_value = stat_chi2_two_p(lazy, eager, 2 * CELLS);
            assert_true(stat_ok("lazy against eager", p_value, LEVEL));
            assert_true(exact_p(lazy) < SEEN);
        }
    }
}

static void missing_catch_up_is_seen(void **state)
{
    (void)state;
    struct run run = {&kernel_gaussian, 0.02, 12, false, 37};
    double eager[2 * CELLS] = {0}, stale[2 * CELLS] = {0};
    run_way(&run, EAGER, eager);
    run_way(&run, NOT_CAUGHT_UP, stale);
    assert_true(stat_chi2_two_p(stale, eager, 2 * CELLS) < SEEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stays_stationary),
        cmocka_unit_test(rolling_back_is_seen),
        cmocka_unit_test(moves_as_eager_does),
        cmocka_unit_test(missing_catch_up_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
