/* Metropolis-Hastings: the books (every mutation weighs 1), black and broken states, and
 * the same bits for any number of threads. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/par.h"
#include "support/toy_target.h"

static struct toy toy = {8};
static const struct target toy_target = {toy_eval, &toy};

static double film_luminance(const struct film *film)
{
    double sum = 0.0;
    for (int i = 0; i < TOY_CELLS; i++)
        sum += rgb_luminance(film_value(film, i));
    return sum;
}

static void weight_of_one_splat(void **state)
{
    (void)state;
    struct chain_params kelemen = {0.25, 2.0, ESTIMATOR_KELEMEN};
    struct chain_params plain = {0.25, 2.0, ESTIMATOR_PLAIN};
    assert_true(splat_weight(&kelemen, 3.5) == 0.25);
    assert_true(splat_weight(&plain, 4.0) == 0.25);
    /* The dimmest target that double can hold still has a weight that it can hold. */
    assert_true(isfinite(splat_weight(&plain, 5e-324) * FILM_ONE * 1e6));
}

/* Plain splats are F/I times weights that sum to the number of mutations. */
static void every_mutation_weighs_one(void **state)
{
    (void)state;
    struct chain chain;
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_PLAIN, false);
    struct chain_params params = {0.3, 1.0, ESTIMATOR_PLAIN};
    toy_chain_init(&chain, &kernel_exponential);
    toy_start(&chain, &toy, 61, 0);
    for (int round = 0; round < 10; round++) {
        step_mh.advance(&chain, &params, &toy_target, &films.sinks, 100 + round);
        chain_flush(&chain, &params, &films.sinks);
        chain_flush(&chain, &params, &films.sinks); /* nothing is owed twice */
    }
    assert_true(fabs(film_luminance(films.chain) - 1045.0) < 1e-5);
    assert_true(film_luminance(films.large) == 0.0);
    const struct tally *t = &chain.tally;
    assert_int_equal(t->proposed[MOVE_SMALL] + t->proposed[MOVE_LARGE], 1045);
    for (int m = MOVE_LARGE; m <= MOVE_SMALL; m += MOVE_SMALL - MOVE_LARGE) {
        assert_true(t->accepted[m] <= t->nonzero[m] && t->nonzero[m] <= t->proposed[m]);
        assert_true(t->acceptance[m] <= (double)t->nonzero[m] && t->accepted[m] > 0);
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

/* The large film holds all large proposals, each with the weight of its own I. */
static void large_film_holds_every_large_step(void **state)
{
    (void)state;
    struct chain chain;
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {1.0, 1e-12, ESTIMATOR_KELEMEN};
    toy_chain_init(&chain, &kernel_exponential);
    chain_seed(&chain, &toy_target, 7, 0, 0);
    step_mh.advance(&chain, &params, &toy_target, &films.sinks, 500);
    chain_flush(&chain, &params, &films.sinks);
    double nonzero = (double)chain.tally.nonzero[MOVE_LARGE];
    assert_true(fabs(film_luminance(films.large) - nonzero) < 1e-5);
    assert_true(nonzero > 300 && nonzero < 450); /* 12 of 16 cells */
    assert_int_equal(chain.tally.proposed[MOVE_LARGE], 500);
    assert_true(chain.tally.large_sum_squares * 500 >
                chain.tally.large_sum * chain.tally.large_sum);
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

struct script {
    int evaluations, first_light;
    double value;
};

/* Black until the evaluation `first_light`, then `value`. */
static void scripted(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct script *s = ctx;
    (void)numbers;
    contrib_clear(out);
    if (s->evaluations++ >= s->first_light) {
        contrib_add(out, 0, (struct rgb){1.0, 1.0, 1.0}, 0, 0);
        out->target = s->value;
    }
}

static void run_script(struct chain *chain, struct script *script, long mutations)
{
    struct target target = {scripted, script};
    struct film_sinks films;
    film_sinks_create(&films, 1, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {0.5, 1.0, ESTIMATOR_KELEMEN};
    toy_chain_init(chain, &kernel_gaussian);
    chain_seed(chain, &target, 7, 0, 0);
    step_mh.advance(chain, &params, &target, &films.sinks, mutations);
    chain_flush(chain, &params, &films.sinks);
    film_sinks_destroy(&films);
}

static void black_start_takes_the_first_light(void **state)
{
    (void)state;
    struct chain chain;
    struct script script = {0, 51, 1e-300};
    run_script(&chain, &script, 50);
    assert_int_equal(tally_first(chain.tally.accepted), 0);
    assert_true(chain.tally.acceptance[MOVE_SMALL] + chain.tally.acceptance[MOVE_LARGE] ==
                0.0);
    assert_int_equal(chain.most_rejections_in_row, 50);
    chain_deinit(&chain);
    script.evaluations = 0;
    run_script(&chain, &script, 60);
    assert_int_equal(tally_first(chain.tally.accepted), 10);
    assert_int_equal(chain.most_rejections_in_row, 50);
    assert_int_equal(chain.rejections_in_row, 0);
    chain_deinit(&chain);
}

static void broken_targets_are_counted_and_refused(void **state)
{
    (void)state;
    const double broken[] = {(double)NAN, HUGE_VAL, -1.0};
    for (int i = 0; i < 3; i++) {
        struct chain chain;
        struct script script = {0, 1, broken[i]};
        run_script(&chain, &script, 40);
        assert_int_equal(tally_first(chain.tally.accepted), 0);
        assert_int_equal(tally_first(chain.tally.nonzero), 0);
        assert_int_equal(chain.contribs[0].nonfinite + chain.contribs[1].nonfinite, 40);
        assert_true(chain.tally.large_sum == 0.0);
        chain_deinit(&chain);
    }
}

enum { CHAINS = 7 };

struct job {
    struct chain *chains;
    const struct film_sinks *films;
};

static void advance_one(void *ctx, long index, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    struct chain_params params = {0.4, 0.9, ESTIMATOR_KELEMEN};
    struct chain *chain = &job->chains[index];
    chain_seed(chain, &toy_target, 3, (uint64_t)(10 * index), (uint64_t)index);
    step_mh.advance(chain, &params, &toy_target, &job->films->sinks, 2000);
    chain_flush(chain, &params, &job->films->sinks);
}

static void run_threads(int threads, struct rgb pixels[2 * TOY_CELLS], struct tally *sum)
{
    struct chain chains[CHAINS];
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
    for (int i = 0; i < CHAINS; i++)
        toy_chain_init(&chains[i], &kernel_exponential);
    par_for(CHAINS, threads, advance_one, &(struct job){chains, &films});
    *sum = (struct tally){0};
    for (int i = 0; i < CHAINS; i++) {
        tally_add(sum, &chains[i].tally);
        chain_deinit(&chains[i]);
    }
    for (int i = 0; i < TOY_CELLS; i++) {
        pixels[i] = film_value(films.chain, i);
        pixels[TOY_CELLS + i] = film_value(films.large, i);
    }
    film_sinks_destroy(&films);
}

static void same_bits_for_any_threads(void **state)
{
    (void)state;
    struct rgb one[2 * TOY_CELLS], more[2 * TOY_CELLS];
    struct tally sum_one, sum_more;
    run_threads(1, one, &sum_one);
    for (int threads = 2; threads <= 3; threads++) {
        run_threads(threads, more, &sum_more);
        assert_memory_equal(one, more, sizeof one);
        assert_memory_equal(&sum_one, &sum_more, sizeof sum_one);
    }
}

/* I scaled by a power of two: the very same decisions. */
static void scaled_eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    toy_eval(&toy, numbers, out);
    out->target *= *(const double *)ctx;
}

static void brightness_changes_no_decision(void **state)
{
    (void)state;
    double scales[] = {1.0, 0x1p-400, 0x1p400}, x[3][TOY_MAX];
    struct tally tallies[3];
    for (int i = 0; i < 3; i++) {
        struct chain chain;
        struct target target = {scaled_eval, &scales[i]};
        struct film_sinks films;
        film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
        struct chain_params params = {0.3, scales[i], ESTIMATOR_KELEMEN};
        toy_chain_init(&chain, &kernel_gaussian);
        chain_seed(&chain, &target, 5, 2, 1);
        step_mh.advance(&chain, &params, &target, &films.sinks, 3000);
        toy_state(&chain, &toy, x[i]);
        tallies[i] = chain.tally;
        chain_deinit(&chain);
        film_sinks_destroy(&films);
    }
    for (int i = 1; i < 3; i++) {
        assert_memory_equal(x[0], x[i], sizeof x[0]);
        assert_memory_equal(tallies[0].acceptance, tallies[i].acceptance,
                            sizeof tallies[0].acceptance);
        assert_true(tallies[i].large_sum == tallies[0].large_sum * scales[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_of_one_splat),
        cmocka_unit_test(every_mutation_weighs_one),
        cmocka_unit_test(large_film_holds_every_large_step),
        cmocka_unit_test(black_start_takes_the_first_light),
        cmocka_unit_test(broken_targets_are_counted_and_refused),
        cmocka_unit_test(same_bits_for_any_threads),
        cmocka_unit_test(brightness_changes_no_decision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
