/* The lazy state: what a mutation may change, what survives it, and what is refused. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/pss.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

struct fixture {
    struct rng rng;
    struct pss pss;
    struct numbers numbers;
};

static void setup(struct fixture *f, const struct kernel_type *type)
{
    const int capacity[PSS_STREAMS] = {40, 20, 300};
    struct kernel kernel;
    kernel_init(&kernel, type, 0.0, 0.0, 0.0);
    rng_init(&f->rng, 5, RNG_TEST, 0);
    pss_init(&f->pss, capacity, &kernel, &f->rng);
    f->numbers = pss_numbers(&f->pss);
}

static double take_one(struct ustream *s, int place)
{
    return *ustream_take(s, place, 1);
}

/* A large step hands out the generator's own sequence, across batches and streams. */
static void large_step_is_the_plain_sequence(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    struct rng copy = f.rng;
    pss_begin(&f.pss, true);
    for (int i = 0; i < 30; i++) {
        const double *u = ustream_take(f.numbers.connect, 7 * i, 7);
        for (int j = 0; j < 7; j++)
            assert_true(u[j] == rng_double(&copy));
        if (i < 20)
            assert_true(take_one(f.numbers.light, i) == rng_double(&copy));
    }
    pss_deinit(&f.pss);
}

static void rejection_keeps_the_current_state(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_exponential);
    struct pss_stream *s = &f.pss.streams[PSS_CAMERA];
    double before[6];
    pss_begin(&f.pss, true);
    memcpy(before, ustream_take(f.numbers.camera, 0, 6), sizeof before);
    pss_accept(&f.pss);
    assert_memory_equal(s->current, before, sizeof before);
    for (int i = 0; i < 200; i++) {
        pss_begin(&f.pss, i % 2);
        assert_memory_not_equal(ustream_take(f.numbers.camera, 0, 6), before,
                                sizeof before);
        pss_reject(&f.pss);
        assert_memory_equal(s->current, before, sizeof before);
    }
    pss_deinit(&f.pss);
}

static void acceptance_takes_what_was_asked_for(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_exponential);
    struct pss_stream *s = &f.pss.streams[PSS_CAMERA];
    pss_begin(&f.pss, true);
    ustream_take(f.numbers.camera, 0, 8);
    pss_accept(&f.pss);
    double before[8], proposed[3];
    memcpy(before, s->current, sizeof before);
    pss_begin(&f.pss, false);
    memcpy(proposed, ustream_take(f.numbers.camera, 2, 3), sizeof proposed);
    for (int i = 0; i < 3; i++) {
        double d = proposed[i] - before[2 + i];
        d -= nearbyint(d);
        assert_true(fabs(d) > 1.0 / 1025 && fabs(d) < 1.0 / 63.9);
    }
    pss_accept(&f.pss);
    assert_memory_equal(s->current + 2, proposed, sizeof proposed);
    assert_memory_equal(s->current, before, 2 * sizeof *before);
    assert_memory_equal(s->current + 5, before + 5, 3 * sizeof *before);
    pss_deinit(&f.pss);
}

/* Accepts `mutations` steps that ask for place 0 of the camera stream only. */
static void accept_without(struct fixture *f, int mutations, bool large)
{
    for (int i = 0; i < mutations; i++) {
        pss_begin(&f->pss, large);
        take_one(f->numbers.camera, 0);
        pss_accept(&f->pss);
    }
}

static double distance(double a, double b)
{
    return fabs(a - b - nearbyint(a - b));
}

static void catch_up_survives_rejection(void **state)
{
    (void)state;
    for (int t = 0; kernel_types[t]; t++) {
        struct fixture f;
        setup(&f, kernel_types[t]);
        double *number = &f.pss.streams[PSS_LIGHT].current[3];
        pss_begin(&f.pss, true);
        take_one(f.numbers.camera, 0);
        double drawn = take_one(f.numbers.light, 3);
        pss_accept(&f.pss);
        accept_without(&f, 9, false);
        assert_true(*number == drawn); /* nothing asked for, nothing spent */
        pss_begin(&f.pss, false);
        take_one(f.numbers.light, 3);
        pss_reject(&f.pss);
        double caught_up = *number;
        assert_true(caught_up != drawn && distance(caught_up, drawn) < 9.0 / 64);
        for (int i = 0; i < 5; i++) {
            pss_begin(&f.pss, i % 2);
            take_one(f.numbers.light, 3);
            pss_reject(&f.pss);
            assert_true(*number == caught_up);
        }
        pss_deinit(&f.pss);
    }
}

static void accepted_large_step_makes_the_rest_stale(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_exponential);
    double *number = &f.pss.streams[PSS_LIGHT].current[3], drawn;
    int far = 0;
    for (int i = 0; i < 100; i++) {
        pss_begin(&f.pss, true);
        take_one(f.numbers.camera, 0);
        drawn = take_one(f.numbers.light, 3);
        pss_accept(&f.pss);
        accept_without(&f, 1, true);
        pss_begin(&f.pss, false);
        take_one(f.numbers.light, 3);
        pss_reject(&f.pss);
        far += distance(*number, drawn) > 0.125; /* probability 3/4 */
    }
    assert_in_range(far, 55, 95);

    /* A rejected large step leaves everything as it was. */
    drawn = *number;
    pss_begin(&f.pss, true);
    take_one(f.numbers.light, 3);
    pss_reject(&f.pss);
    pss_begin(&f.pss, false);
    take_one(f.numbers.light, 3);
    assert_true(*number == drawn);
    pss_deinit(&f.pss);
}

/* A whole event is asked for of which only a part is up to date. */
static void partly_stale_block(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    struct pss_stream *s = &f.pss.streams[PSS_CONNECT];
    pss_begin(&f.pss, true);
    ustream_take(f.numbers.connect, 0, 2);
    pss_accept(&f.pss);
    double before[2] = {s->current[0], s->current[1]};
    pss_begin(&f.pss, false);
    ustream_take(f.numbers.connect, 0, 4);
    pss_accept(&f.pss);
    for (int i = 0; i < 4; i++)
        assert_int_equal(s->stamp[i], f.pss.clock);
    assert_true(distance(before[0], s->current[0]) < 0.1);
    assert_true(distance(before[1], s->current[1]) < 0.1);
    assert_int_equal(s->stamp[4], -1);
    pss_deinit(&f.pss);
}

/* A mutation that nobody ended leaves no trace in the next. */
static void beginning_forgets(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    pss_begin(&f.pss, true);
    take_one(f.numbers.light, 3);
    pss_begin(&f.pss, true);
    take_one(f.numbers.light, 4);
    pss_accept(&f.pss);
    assert_int_equal(f.pss.streams[PSS_LIGHT].stamp[3], -1);
    assert_int_equal(f.pss.streams[PSS_LIGHT].stamp[4], f.pss.clock);
    pss_deinit(&f.pss);
}

/* The second of two proposals steps from the same state, a tenth as far, and what only
 * the first was asked for comes along. */
static void second_stage_follows_a_failed_step(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    struct pss_stream *s = &f.pss.streams[PSS_CAMERA];
    pss_begin(&f.pss, true);
    ustream_take(f.numbers.camera, 0, 8);
    pss_accept(&f.pss);
    int64_t before = f.pss.clock;
    double x[8], y[4], z[8];
    memcpy(x, s->current, sizeof x);
    pss_begin(&f.pss, false);
    memcpy(y, ustream_take(f.numbers.camera, 0, 4), sizeof y);
    pss_begin_second_stage(&f.pss);
    take_one(f.numbers.camera, 6);
    ustream_take(f.numbers.camera, 2, 2);
    double log_ratio = pss_second_stage_log_ratio(&f.pss), expected = 0.0;
    assert_memory_equal(s->current, x, sizeof x);
    pss_accept(&f.pss);
    memcpy(z, s->current, sizeof z);
    assert_int_equal(f.pss.clock, before + 1);
    for (int i = 0; i < 8; i++) {
        bool moved = i < 4 || i == 6;
        assert_int_equal(s->stamp[i], before + moved);
        assert_true((z[i] != x[i]) == moved && distance(z[i], x[i]) < 0.01);
        if (i < 4)
            expected += pow(distance(y[i], x[i]), 2) - pow(distance(y[i], z[i]), 2);
    }
    expected /= 2.0 * f.pss.kernel.sigma * f.pss.kernel.sigma;
    assert_true(fabs(log_ratio - expected) < 1e-9 && expected != 0.0);
    /* What missed both steps catches up by both. */
    pss_begin(&f.pss, false);
    assert_int_equal(f.pss.variance, KERNEL_SECOND_STAGE * KERNEL_SECOND_STAGE);
    take_one(f.numbers.camera, 7);
    assert_true(s->current[7] != x[7]);
    pss_deinit(&f.pss);
}

static void nothing_is_kept_of_a_failed_large_step(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    struct pss_stream *s = &f.pss.streams[PSS_CAMERA];
    pss_begin(&f.pss, true);
    ustream_take(f.numbers.camera, 0, 3);
    pss_accept(&f.pss);
    double x[3];
    memcpy(x, s->current, sizeof x);
    pss_begin(&f.pss, true);
    ustream_take(f.numbers.camera, 0, 3);
    pss_begin_second_stage(&f.pss);
    ustream_take(f.numbers.camera, 0, 2);
    assert_true(pss_second_stage_log_ratio(&f.pss) == 0.0);
    pss_accept(&f.pss);
    assert_true(distance(s->current[0], x[0]) < 0.01);
    assert_true(distance(s->current[1], x[1]) < 0.01);
    assert_true(s->current[2] == x[2]);
    pss_deinit(&f.pss);
}

/* Numbers handed out earlier in a mutation stay valid to its end. */
static void earlier_numbers_stay(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, &kernel_gaussian);
    for (int large = 1; large >= 0; large--) {
        pss_begin(&f.pss, large);
        const double *first = ustream_take(f.numbers.connect, 0, 3);
        double copy[3];
        memcpy(copy, first, sizeof copy);
        for (int i = 1; i < 90; i++)
            ustream_take(f.numbers.connect, 3 * i, 3);
        assert_memory_equal(first, copy, sizeof copy);
        pss_accept(&f.pss);
    }
    pss_deinit(&f.pss);
}

/* True if asking for such a block ends the process instead of writing out of bounds. */
static bool refused(int first_place, int place, int count)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        struct fixture f;
        (void)!freopen("/dev/null", "w", stderr);
        signal(SIGABRT, SIG_DFL); /* the test runner's own handler would hide it */
        setup(&f, &kernel_gaussian);
        pss_begin(&f.pss, true);
        if (first_place >= 0)
            ustream_take(f.numbers.light, first_place, 1);
        ustream_take(f.numbers.light, place, count);
        _exit(0);
    }
    int status;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

static void out_of_capacity_stops_the_process(void **state)
{
    (void)state;
    assert_false(refused(-1, 19, 1));
    assert_false(refused(-1, 12, 8));
    assert_true(refused(-1, 20, 1));
    assert_true(refused(-1, 13, 8));
    assert_true(refused(-1, -1, 1));
    assert_true(refused(-1, 0, 0));
    assert_true(refused(-1, 0, 9));
    assert_true(refused(-1, INT32_MAX, 8));
#ifndef NDEBUG
    assert_true(refused(4, 3, 2)); /* a place asked for twice */
#endif
    assert_false(refused(4, 5, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_step_is_the_plain_sequence),
        cmocka_unit_test(rejection_keeps_the_current_state),
        cmocka_unit_test(acceptance_takes_what_was_asked_for),
        cmocka_unit_test(catch_up_survives_rejection),
        cmocka_unit_test(accepted_large_step_makes_the_rest_stale),
        cmocka_unit_test(partly_stale_block),
        cmocka_unit_test(beginning_forgets),
        cmocka_unit_test(second_stage_follows_a_failed_step),
        cmocka_unit_test(nothing_is_kept_of_a_failed_large_step),
        cmocka_unit_test(earlier_numbers_stay),
        cmocka_unit_test(out_of_capacity_stops_the_process),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
