/* The second, narrower proposal and lazy numbers: a number that one half of the states
 * use misses steps of two widths, and must catch up by the right amount. The chain is
 * held against its exact density and, on the way there, against a plain rendering in
 * which both numbers step every time; wrong renderings are run beside it to show that
 * they would be seen. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/film_sinks.h"
#include "support/stat_test.h"

#define REPLICATES 100000
#define SIGMA      0.06
#define BARS       60 /* narrower than a small step */
#define CELLS      60
#define LEVEL      stat_sidak(1e-3, 7)
#define SEEN       1e-9 /* what the p-value of a wrong way must lie below */

/* By bars of u0, in turn lit, u1, dark, u1: f is 2 and 0 where lit and dark, and
 * steps(u1) in those that ask for u1. Each half has mean 1. */
static const double steps[10] = {5, 0, 0, 0, 3, 1.5, 0, 0, .5, 0};

static bool asks(double u0)
{
    return (int)(BARS * u0) % 2;
}

static double density(const double u[2])
{
    if (asks(u[0]))
        return steps[(int)(10 * u[1])];
    return (int)(BARS * u[0]) % 4 ? 0.0 : 2.0;
}

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    (void)ctx;
    contrib_clear(out);
    double u[2] = {*ustream_take(numbers->camera, 0, 1), 0.0};
    if (asks(u[0]))
        u[1] = *ustream_take(numbers->light, 1, 1);
    double f = density(u);
    contrib_add(out, 0, (struct rgb){f, f, f}, 0, 0);
    out->target = f;
}

struct run {
    double p_large;
    int second_stage; /* of the kernel */
    int mutations;
    bool exact_start; /* an exact sample of f, else a point of a lit bar */
    uint64_t seed;
};

static void start(const struct run *run, struct rng *rng, double u[2])
{
    u[0] = 28.5 / BARS;
    u[1] = 0.15;
    if (!run->exact_start)
        return;
    do {
        u[0] = rng_double(rng);
        u[1] = rng_double(rng);
    } while (rng_double(rng) * 5.0 >= density(u));
}

/* Where u1 is used its twentieths; else its tenths times quarters of a bar. */
static int cell_of(const double u[2])
{
    double bar = BARS * u[0] - floor(BARS * u[0]);
    return asks(u[0]) ? (int)(20 * u[1]) : 20 + 4 * (int)(10 * u[1]) + (int)(4 * bar);
}

static double exact_p(const double *counts)
{
    double expected[CELLS];
    for (int i = 0; i < CELLS; i++)
        expected[i] = REPLICATES * (i < 20 ? steps[i / 2] / 40.0 : 1.0 / 80.0);
    return stat_chi2_p(counts, expected, CELLS);
}

/* The chain under test; in the end the unused number is asked for as well. */
static void run_chain(const struct run *run, double *counts)
{
    const int capacity[PSS_STREAMS] = {1, 2, 0};
    struct kernel kernel;
    struct chain chain;
    kernel_init(&kernel, &kernel_gaussian, SIGMA, 0.0, 0.0);
    kernel.second_stage = run->second_stage;
    pss_chain_init(&chain, capacity, 1, &kernel);
    struct film_sinks films;
    film_sinks_create(&films, 1, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {run->p_large, 1.0, ESTIMATOR_KELEMEN};
    struct target target = {eval, NULL};
    struct pss_stream *camera = &pss_of(&chain)->streams[PSS_CAMERA];
    struct pss_stream *light = &pss_of(&chain)->streams[PSS_LIGHT];
    for (uint64_t r = 0; r < REPLICATES; r++) {
        double u[2];
        rng_init(&chain.rng, run->seed, RNG_TEST, r);
        start(run, &chain.rng, u);
        pss_reset(pss_of(&chain));
        camera->current[0] = u[0];
        light->current[1] = u[1];
        camera->stamp[0] = light->stamp[1] = 0;
        contrib_clear(chain.current);
        chain.current->target = density(u);
        step_pf_exact.advance(&chain, &params, &target, &films.sinks, run->mutations);
        struct numbers numbers = pss_numbers(pss_of(&chain));
        pss_begin(pss_of(&chain), false);
        ustream_take(numbers.camera, 0, 1);
        ustream_take(numbers.light, 1, 1);
        pss_reject(pss_of(&chain));
        counts[cell_of((double[]){camera->current[0], light->current[1]})]++;
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

/* --- plain renderings -----------------------------------------------------------------
 */

enum way {
    EAGER,
    NO_RATIO,    /* eager, but the second proposal accepted by the targets alone */
    ROLLED_BACK, /* lazy, the catch-up lost with a rejected proposal */
    ROUGH_CLOCK, /* lazy, a second-stage step that was missed taken for a small one */
};

struct walker {
    const struct run *run;
    enum way way;
    struct kernel kernel;
    struct rng rng;
    double u[2], batch[KERNEL_BATCH];
    int left;      /* of the batch */
    double missed; /* variance that u[1] has not seen, in small steps; -1: a large step */
};

static double small_step(struct walker *w, double x, double width)
{
    if (w->left == 0) {
        w->kernel.type->draw(&w->kernel, &w->rng, w->batch);
        w->left = KERNEL_BATCH;
    }
    return kernel_wrap(x + width * w->batch[--w->left]);
}

static bool is_used(const struct walker *w, double u0)
{
    return w->way == EAGER || w->way == NO_RATIO || asks(u0);
}

static double caught_up(struct walker *w)
{
    if (w->missed < 0.0)
        return rng_double(&w->rng);
    return w->missed > 0.0 ? small_step(w, w->u[1], sqrt(w->missed)) : w->u[1];
}

static void move_to(struct walker *w, const double y[2], bool used, double missed)
{
    w->u[0] = y[0];
    if (used) {
        w->u[1] = y[1];
        w->missed = 0.0;
    } else if (missed < 0.0) {
        w->missed = -1.0;
    } else if (w->missed >= 0.0) {
        w->missed += missed;
    }
}

/* log of q1(y|z)/q1(y|x), from nearest images: others lie 8 sigma off. */
static double log_ratio(double y, double z, double x)
{
    double far = y - z - nearbyint(y - z), near = y - x - nearbyint(y - x);
    return (near * near - far * far) / (2.0 * SIGMA * SIGMA);
}

static void try_second_stage(struct walker *w, const double x[2], const double y[2],
                             bool large)
{
    double width = 1.0 / w->run->second_stage, log_q = 0.0;
    double z[2] = {small_step(w, x[0], width), small_step(w, x[1], width)};
    bool used = is_used(w, z[0]) || (!large && asks(y[0]));
    if (!large && w->way != NO_RATIO) {
        log_q = log_ratio(y[0], z[0], x[0]);
        if (asks(y[0]))
            log_q += log_ratio(y[1], z[1], x[1]);
    }
    if (rng_double(&w->rng) < density(z) / density(x) * exp(log_q))
        move_to(w, z, used, w->way == ROUGH_CLOCK ? 1.0 : width * width);
}

static void mutate(struct walker *w)
{
    bool large = rng_double(&w->rng) < w->run->p_large;
    double x[2] = {w->u[0], caught_up(w)}, y[2];
    for (int i = 0; i < 2; i++)
        y[i] = large ? rng_double(&w->rng) : small_step(w, x[i], 1.0);
    bool used = is_used(w, y[0]);
    if (used && !large && w->way != ROLLED_BACK)
        move_to(w, x, true, 0.0);
    if (density(y) == 0.0)
        try_second_stage(w, x, y, large);
    else if (rng_double(&w->rng) < density(y) / density(x))
        move_to(w, y, used, large ? -1.0 : 1.0);
}

static void run_way(const struct run *run, enum way way, double *counts)
{
    struct walker w = {.run = run, .way = way};
    kernel_init(&w.kernel, &kernel_gaussian, SIGMA, 0.0, 0.0);
    for (uint64_t r = 0; r < REPLICATES; r++) {
        rng_init(&w.rng, run->seed + 1, RNG_TEST, r);
        start(run, &w.rng, w.u);
        w.missed = 0.0;
        w.left = 0;
        for (int i = 0; i < run->mutations; i++)
            mutate(&w);
        w.u[1] = caught_up(&w);
        counts[cell_of(w.u)]++;
    }
}

/* --- tests ----------------------------------------------------------------------------
 */

static void stays_stationary(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct run run = {i % 2 ? 0.3 : 0.02, i / 2 ? 1 : KERNEL_SECOND_STAGE, 60, true,
                          51};
        double lazy[CELLS] = {0};
        run_chain(&run, lazy);
        assert_true(stat_ok("exact, at rest", exact_p(lazy), LEVEL));
    }
}

/* After a few mutations from one point, where laws still differ from the target's. */
static void moves_as_eager_does(void **state)
{
    (void)state;
    for (int p = 0; p < 2; p++) {
        struct run run = {p ? 0.3 : 0.02, KERNEL_SECOND_STAGE, 12, false, 53};
        double lazy[CELLS] = {0}, eager[CELLS] = {0};
        run_chain(&run, lazy);
        run_way(&run, EAGER, eager);
        double p_value = stat_chi2_two_p(lazy, eager, CELLS);
        assert_true(stat_ok("exact, against eager", p_value, LEVEL));
        assert_true(exact_p(lazy) < SEEN);
    }
}

static void wrong_ways_are_seen(void **state)
{
    (void)state;
    struct run rest = {0.02, KERNEL_SECOND_STAGE, 60, true, 55},
               on_the_way = {0.02, KERNEL_SECOND_STAGE, 12, false, 57},
               wide = {0.02, 1, 60, true, 55};
    double eager[CELLS] = {0}, no_ratio[CELLS] = {0}, rolled_back[CELLS] = {0};
    run_way(&rest, EAGER, eager);
    run_way(&wide, NO_RATIO, no_ratio);
    run_way(&rest, ROLLED_BACK, rolled_back);
    print_message("at rest: eager p = %.3g, no ratio %.3g, rolled back %.3g\n",
                  exact_p(eager), exact_p(no_ratio), exact_p(rolled_back));
    assert_true(stat_ok("eager, at rest", exact_p(eager), LEVEL));
    assert_true(exact_p(no_ratio) < SEEN && exact_p(rolled_back) < SEEN);

    double right[CELLS] = {0}, rough[CELLS] = {0};
    run_way(&on_the_way, EAGER, right);
    run_way(&on_the_way, ROUGH_CLOCK, rough);
    double p_value = stat_chi2_two_p(right, rough, CELLS);
    print_message("on the way: rough clock against eager p = %.3g\n", p_value);
    assert_true(p_value < SEEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stays_stationary),
        cmocka_unit_test(moves_as_eager_does),
        cmocka_unit_test(wrong_ways_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
