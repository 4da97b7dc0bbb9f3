/* One unit of work (chain/state.h): a mutation and an independent sample that trace the
 * same paths count the same; a jump, which traces two, counts both. Exact. */

#include <string.h>

#include "chain/chain.h"
#include "chain/pss_jump.h"
#include "integrator/markov/pilot.h"
#include "integrator/passes.h"
#include "path/estimate.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define SEED    7
#define SAMPLES 256
#define DEPTH   5

struct sampler {
    struct subpaths paths;
    estimate_function estimate;
};

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct sampler *s = ctx;
    s->estimate(&s->paths, numbers, out);
}

static double work_of_passes(const struct scene *scene, const struct target *target,
                             long count)
{
    struct pilot pilot;
    struct pilot_job job = {.targets = target,
                            .threads = 1,
                            .max_splats = estimate_splats(DEPTH),
                            .seed = SEED,
                            .factor = 1.0};
    pilot_init(&pilot, scene->camera.width, scene->camera.height, 1);
    pilot_trace(&pilot, &job, count);
    double work = pilot.work;
    pilot_deinit(&pilot);
    return work;
}

/* Large steps whose random numbers are those of the pilot's samples. */
static double work_of_mutations(const struct target *target, long count)
{
    struct pss_options options = {.capacity = {dims_camera_capacity(DEPTH),
                                               dims_light_capacity(DEPTH),
                                               dims_connect_capacity(DEPTH)}};
    struct chain chain;
    double work = 0.0;
    kernel_init(&options.kernel, &kernel_exponential, 0.0, 0.0, 0.0);
    chain_init(&chain, &state_pss, &options, estimate_splats(DEPTH));
    for (long i = 0; i < count; i++) {
        rng_init(&chain.rng, SEED, RNG_GUESS, (uint64_t)i);
        state_pss.rng_changed(chain.state);
        state_pss.propose(chain.state, target, MOVE_LARGE, chain.proposed);
        work += state_pss.work(chain.state, chain.proposed);
    }
    chain_deinit(&chain);
    return work;
}

static void check_estimate(estimate_function estimate)
{
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        struct sampler sampler = {.estimate = estimate};
        struct target target = {eval, &sampler};
        subpaths_init(&sampler.paths, scene, DEPTH);
        double passes = work_of_passes(scene, &target, SAMPLES);
        assert_true(passes >= SAMPLES * WORK_EVENT);
        assert_true(work_of_mutations(&target, SAMPLES) == passes);
        subpaths_deinit(&sampler.paths);
        scene_destroy(scene);
    }
}

static void test_large_step_and_pass(void **state)
{
    (void)state;
    check_estimate(estimate_bdpt);
    check_estimate(estimate_pt);
}

/* A toy whose samples take the same numbers in three events, on both sides of a jump. */
static void eval_toy(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    (void)ctx;
    contrib_clear(out);
    ustream_take(numbers->camera, 0, 2);
    ustream_take(numbers->camera, 2, 1);
    ustream_take(numbers->connect, 0, 1);
    contrib_add(out, 0, rgb_grey(1.0), 0, 0);
}

static enum inversion invert_toy(void *ctx, const struct numbers *current,
                                 struct rng *rng, struct found *found,
                                 struct contrib *again)
{
    (void)rng;
    eval_toy(ctx, current, again);
    found->camera.kept = 3;
    found->connect.kept = 1;
    return INVERSION_OTHER;
}

static void test_jump(void **state)
{
    (void)state;
    struct pss_options options = {
        .capacity = {3, 1, 1}, .jump = 1.0, .invert = invert_toy};
    struct target target = {eval_toy, NULL};
    struct chain chain;
    kernel_init(&options.kernel, &kernel_exponential, 0.0, 0.0, 0.0);
    chain_init(&chain, &state_pss_jump, &options, 1);
    rng_init(&chain.rng, SEED, RNG_TEST, 0);
    chain.state->type->propose(chain.state, &target, MOVE_LARGE, chain.proposed);
    double once = chain.state->type->work(chain.state, chain.proposed);
    assert_true(once == 3.0 * WORK_EVENT);
    chain.state->type->accept(chain.state);
    struct proposal p = chain.state->type->propose(chain.state, &target, MOVE_LOCAL,
                                                   chain.proposed);
    assert_int_equal(p.move, MOVE_JUMP);
    assert_true(chain.state->type->work(chain.state, chain.proposed) == 2.0 * once);
    chain_deinit(&chain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_large_step_and_pass),
        cmocka_unit_test(test_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
