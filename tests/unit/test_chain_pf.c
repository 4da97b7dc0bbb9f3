/* The steps after a failed proposal: the books, chains that cannot move, broken targets,
 * and the same decisions for any brightness and number of threads. What density they
 * keep: tests/stat/test_chain_pf.c. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/par.h"
#include "support/pf_toy.h"

static const double edges[] = {0., .1, .3, .5, .6, .8, .9, .4};
static const struct step_type *const steps[] = {&step_mh, &step_pf_paper, &step_pf_exact};

#define STEPS  3
#define PIXELS 8

static struct rgb film_total(struct film *film)
{
    struct rgb sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < PIXELS; i++)
        sum = rgb_add(sum, film_value(film, i));
    return sum;
}

static int64_t sum_failures(const struct tally *t, enum move move)
{
    int64_t sum = 0;
    for (int i = 0; i < FAILURES; i++)
        sum += t->failures[move][i];
    return sum;
}

static void check_tally(const struct tally *t, const struct step_type *step, long first)
{
    int64_t failed = sum_failures(t, MOVE_SMALL) + sum_failures(t, MOVE_LARGE);
    assert_int_equal(t->proposed[MOVE_SMALL] + t->proposed[MOVE_LARGE], first);
    assert_true(failed > first / 20 && failed < first);
    assert_int_equal(t->excluded, step == &step_pf_paper ? failed : 0);
    assert_int_equal(t->proposed[MOVE_SECOND_STAGE], step == &step_pf_exact ? failed : 0);
    for (enum move m = MOVE_LARGE; m <= MOVE_SMALL; m++) {
        assert_int_equal(t->nonzero[m] + sum_failures(t, m), t->proposed[m]);
        assert_true(t->accepted[m] <= t->nonzero[m]);
        assert_true(t->acceptance[m] <= (double)t->nonzero[m]);
        assert_int_equal(t->failures[m][FAILURE_NONE], 0);
        assert_int_equal(t->failures[m][FAILURE_ZERO], 0);
        if (t->proposed[m] > 0)
            for (int i = FAILURE_CAMERA_PATH; i <= FAILURE_BLOCKED; i++)
                assert_true(t->failures[m][i] > 0);
    }
    assert_true(step == &step_pf_paper ? t->final_failures == 0
                                       : t->final_failures <= failed);
    assert_true(step != &step_mh || t->final_failures == failed);
}

/* Plain splats are F/I times weights that sum to the number of states, and the picture of
 * failures counts each first proposal once. */
static void every_state_weighs_one(void **state)
{
    (void)state;
    struct pf_toy toy = pf_box(0.06, 8);
    struct target target = {pf_eval, &toy};
    struct chain_params params = {0.3, 1.0, ESTIMATOR_PLAIN};
    for (int s = 0; s < STEPS; s++) {
        struct chain chain;
        struct film_sinks films;
        film_sinks_create(&films, PIXELS, ESTIMATOR_PLAIN, true);
        pf_chain_init(&chain, &toy, KERNEL_SECOND_STAGE);
        rng_init(&chain.rng, 61, RNG_TEST, 0);
        double x[PF_MAX_DIMS];
        pf_sample(&toy, &chain.rng, x);
        pf_start(&chain, &toy, x);
        for (int round = 0; round < 10; round++) {
            steps[s]->advance(&chain, &params, &target, &films.sinks, 1000 + round);
            chain_flush(&chain, &params, &films.sinks);
        }
        const struct tally *t = &chain.tally;
        check_tally(t, steps[s], 10045);
        assert_true(fabs(rgb_luminance(film_total(films.chain)) -
                         (double)(10045 - t->excluded)) < 1e-4);
        struct rgb failures = film_total(films.failures);
        assert_true(failures.g == 10045.0 && failures.b == 0.0);
        assert_true(failures.r ==
                    (double)(10045 - t->nonzero[MOVE_SMALL] - t->nonzero[MOVE_LARGE]));
        chain_deinit(&chain);
        film_sinks_destroy(&films);
    }
}

/* The picture of failures is for looking at: it changes nothing else. */
static void failures_film_changes_nothing(void **state)
{
    (void)state;
    struct pf_toy toy = pf_penumbra(0.05, edges, PIXELS);
    struct target target = {pf_eval, &toy};
    struct chain_params params = {0.3, 1.0, ESTIMATOR_KELEMEN};
    for (int s = 0; s < STEPS; s++) {
        struct tally tallies[2];
        for (int with = 0; with < 2; with++) {
            struct chain chain;
            struct film_sinks films;
            film_sinks_create(&films, PIXELS, ESTIMATOR_KELEMEN, with);
            pf_chain_init(&chain, &toy, KERNEL_SECOND_STAGE);
            chain_seed(&chain, &target, 7, 0, 0);
            steps[s]->advance(&chain, &params, &target, &films.sinks, 500);
            tallies[with] = chain.tally;
            chain_deinit(&chain);
            film_sinks_destroy(&films);
        }
        assert_memory_equal(&tallies[0], &tallies[1], sizeof tallies[0]);
    }
}

/* After the first `light` evaluations a target of `value`, for every state alike. */
struct script {
    int evaluations, light;
    double value;
};

static void scripted(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct script *s = ctx;
    ustream_take(numbers->camera, 0, 2);
    contrib_clear(out);
    if (s->evaluations++ < s->light) {
        contrib_add(out, 0, (struct rgb){1.0, 1.0, 1.0}, 0, 0);
    } else if (s->value != 0.0) {
        contrib_add(out, 0, (struct rgb){1.0, 1.0, 1.0}, 0, 0);
        out->target = s->value;
    }
}

/* The weight that the chain film has got. */
static double run_script(struct chain *chain, const struct step_type *step,
                         struct script *script, long mutations)
{
    const int capacity[PSS_STREAMS] = {2, 0, 0};
    struct kernel kernel;
    struct target target = {scripted, script};
    struct film_sinks films;
    film_sinks_create(&films, PIXELS, ESTIMATOR_PLAIN, false);
    struct chain_params params = {0.5, 1.0, ESTIMATOR_PLAIN};
    kernel_init(&kernel, &kernel_gaussian, 0.0, 0.0, 0.0);
    pss_chain_init(chain, capacity, 1, &kernel);
    chain_seed(chain, &target, 7, 0, 0);
    step->advance(chain, &params, &target, &films.sinks, mutations);
    chain_flush(chain, &params, &films.sinks);
    double weight = film_total(films.chain).g;
    film_sinks_destroy(&films);
    return weight;
}

static void chain_that_cannot_move_ends(void **state)
{
    (void)state;
    for (int s = 0; s < STEPS; s++) {
        struct chain chain;
        struct script script = {0, 1, 0.0};
        double weight = run_script(&chain, steps[s], &script, 1000);
        const struct tally *t = &chain.tally;
        bool paper = steps[s] == &step_pf_paper, exact = steps[s] == &step_pf_exact;
        assert_int_equal(t->proposed[MOVE_SMALL] + t->proposed[MOVE_LARGE], 1000);
        assert_int_equal(t->proposed[MOVE_SECOND_STAGE], exact ? 1000 : 0);
        assert_int_equal(t->excluded, paper ? 1000 : 0);
        assert_int_equal(t->final_failures, paper ? 0 : 1000);
        assert_int_equal(tally_moves(t), 0);
        assert_int_equal(chain.most_rejections_in_row, 1000);
        assert_true(weight == (paper ? 0.0 : 1000.0));
        chain_deinit(&chain);
    }
}

/* A start without a contribution is left at the first light, at second tries too. */
static void black_start_takes_the_first_light(void **state)
{
    (void)state;
    for (int s = 0; s < STEPS; s++) {
        struct chain chain;
        struct script dark = {0, 0, 0.0}, dim = {0, 0, 1e-300};
        run_script(&chain, steps[s], &dark, 50);
        assert_int_equal(tally_first(chain.tally.accepted), 0);
        struct target target = {scripted, &dim};
        struct film_sinks films;
        film_sinks_create(&films, PIXELS, ESTIMATOR_PLAIN, false);
        struct chain_params params = {0.5, 1.0, ESTIMATOR_PLAIN};
        steps[s]->advance(&chain, &params, &target, &films.sinks, 1);
        assert_int_equal(tally_first(chain.tally.accepted), 1);
        chain_deinit(&chain);
        film_sinks_destroy(&films);
    }
}

static void broken_targets_are_counted_and_refused(void **state)
{
    (void)state;
    const double broken[] = {(double)NAN, HUGE_VAL, -1.0};
    for (int i = 0; i < 3 * STEPS; i++) {
        struct chain chain;
        struct script script = {0, 1, broken[i / STEPS]};
        run_script(&chain, steps[i % STEPS], &script, 40);
        const struct tally *t = &chain.tally;
        long paths = steps[i % STEPS] == &step_pf_exact ? 80 : 40;
        assert_int_equal(tally_moves(t), 0);
        assert_int_equal(t->failures[0][FAILURE_ZERO] + t->failures[1][FAILURE_ZERO] +
                             t->failures[2][FAILURE_ZERO],
                         paths);
        assert_int_equal(chain.contribs[0].nonfinite + chain.contribs[1].nonfinite,
                         paths);
        chain_deinit(&chain);
    }
}

struct scaled {
    struct pf_toy *toy;
    double scale;
};

static void scaled_eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct scaled *scaled = ctx;
    pf_eval(scaled->toy, numbers, out);
    out->target *= scaled->scale;
}

static void brightness_changes_no_decision(void **state)
{
    (void)state;
    struct pf_toy toy = pf_box(0.06, 8);
    const double scales[] = {1.0, 0x1p-400, 0x1p400};
    for (int s = 0; s < STEPS; s++) {
        struct tally tallies[3];
        double x[3][PF_MAX_DIMS] = {{0}};
        for (int i = 0; i < 3; i++) {
            struct scaled scaled = {&toy, scales[i]};
            struct target target = {scaled_eval, &scaled};
            struct chain chain;
            struct film_sinks films;
            film_sinks_create(&films, PIXELS, ESTIMATOR_KELEMEN, false);
            struct chain_params params = {0.3, scales[i], ESTIMATOR_KELEMEN};
            pf_chain_init(&chain, &toy, KERNEL_SECOND_STAGE);
            chain_seed(&chain, &target, 5, 2, 1);
            steps[s]->advance(&chain, &params, &target, &films.sinks, 3000);
            pf_state(&chain, &toy, x[i]);
            tallies[i] = chain.tally;
            chain_deinit(&chain);
            film_sinks_destroy(&films);
        }
        assert_true(tallies[0].accepted[MOVE_SMALL] > 500);
        assert_true(steps[s] != &step_pf_exact ||
                    tallies[0].accepted[MOVE_SECOND_STAGE] > 100);
        for (int i = 1; i < 3; i++) {
            assert_memory_equal(x[0], x[i], sizeof x[0]);
            assert_memory_equal(tallies[0].acceptance, tallies[i].acceptance,
                                sizeof tallies[0].acceptance);
            assert_memory_equal(tallies[0].accepted, tallies[i].accepted,
                                sizeof tallies[0].accepted);
        }
    }
}

enum { CHAINS = 7 };

struct job {
    struct pf_toy *toy;
    const struct step_type *step;
    struct chain *chains;
    const struct film_sinks *films;
};

static void advance_one(void *ctx, long index, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    struct target target = {pf_eval, job->toy};
    struct chain_params params = {0.4, 0.9, ESTIMATOR_KELEMEN};
    struct chain *chain = &job->chains[index];
    chain_seed(chain, &target, 3, (uint64_t)(10 * index), (uint64_t)index);
    job->step->advance(chain, &params, &target, &job->films->sinks, 2000);
    chain_flush(chain, &params, &job->films->sinks);
}

static void run_threads(const struct step_type *step, int threads,
                        struct rgb pixels[3 * PIXELS], struct tally *sum)
{
    struct pf_toy toy = pf_penumbra(0.05, edges, PIXELS);
    struct chain chains[CHAINS];
    struct film_sinks films;
    film_sinks_create(&films, PIXELS, ESTIMATOR_KELEMEN, true);
    struct film *all[] = {films.chain, films.large, films.failures};
    for (int i = 0; i < CHAINS; i++)
        pf_chain_init(&chains[i], &toy, KERNEL_SECOND_STAGE);
    par_for(CHAINS, threads, advance_one, &(struct job){&toy, step, chains, &films});
    *sum = (struct tally){0};
    for (int i = 0; i < CHAINS; i++) {
        tally_add(sum, &chains[i].tally);
        chain_deinit(&chains[i]);
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        pixels[i] = film_value(all[i / PIXELS], i % PIXELS);
    film_sinks_destroy(&films);
}

static void same_bits_for_any_threads(void **state)
{
    (void)state;
    for (int s = 0; s < STEPS; s++) {
        struct rgb one[3 * PIXELS], more[3 * PIXELS];
        struct tally sum_one, sum_more;
        run_threads(steps[s], 1, one, &sum_one);
        run_threads(steps[s], 3, more, &sum_more);
        assert_memory_equal(one, more, sizeof one);
        assert_memory_equal(&sum_one, &sum_more, sizeof sum_one);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_state_weighs_one),
        cmocka_unit_test(failures_film_changes_nothing),
        cmocka_unit_test(chain_that_cannot_move_ends),
        cmocka_unit_test(black_start_takes_the_first_light),
        cmocka_unit_test(broken_targets_are_counted_and_refused),
        cmocka_unit_test(brightness_changes_no_decision),
        cmocka_unit_test(same_bits_for_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
