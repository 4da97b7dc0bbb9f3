/* Chains of each mutation alone, with a tenth of independent paths, against bdpt by path
 * length: in equilibrium a chain is at paths of k edges for the share b_k/b of its time.
 * Chains start at paths drawn from POOL independent ones by f/p, so they begin in
 * equilibrium but for an error of the order of 1/POOL. Each replicate has a pool of its
 * own; its shares are pooled to t-tests over replicates.
 *
 * False-alarm rate of this file: FALSE_ALARM. What each test sees is printed: the change
 * of a share that fails it in nine of ten runs. With ETALON_LONG all scenes, and sixteen
 * times as many replicates: a quarter of that. */

#include "integrator/mlt_state.h"
#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "chain/chain.h"

#define FALSE_ALARM 1e-4
#define DEPTH       5
#define POOL        1500 /* of the long form four times as many */
#define CHAINS      8    /* of one pool */
#define STEPS       120
#define REPLICATES  120
#define SEED        17

/* b of 1, 2, ... edges by bdpt's estimator: the tables of test_integrator_chains.c. */
static const struct {
    enum test_contents contents;
    double b[DEPTH];
} scenes[] = {
    {TEST_POINT, {0.186499, 0.149949, 0.0467592, 0.0343525, 0.0163278}},
    {TEST_DIFFUSE, {0.146846, 0.0972357, 0.030628, 0.0137324, 0.00545959}},
    {TEST_PANES, {0.127525, 0.468693, 0.0386295, 0.0145717, 0.00677665}},
};
#define SCENES ((int)(sizeof scenes / sizeof scenes[0]))

static const struct {
    const char *name;
    double weights[MUTATIONS];
    bool weighted;
} designs[] = {
    {"lens", {1, 0, 0, 0, 0}, false},
    {"caustic", {0, 1, 0, 0, 0}, false},
    {"multichain", {0, 0, 1, 0, 0}, false},
    {"bidirectional, uniform", {0, 0, 0, 1, 0}, false},
    {"bidirectional, weighted", {0, 0, 0, 1, 0}, true},
    {"lens sub-path", {0, 0, 0, 0, 1}, false},
};
#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))

static bool is_long(void)
{
    return getenv("ETALON_LONG") != NULL;
}

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    full_path_sample(ctx, numbers, out);
}

/* Sums of f/p over the paths of a pool. */
static void trace_pool(const struct target *target, uint64_t first, int pool,
                       double *sums)
{
    struct contrib out;
    double sum = 0.0;
    contrib_init(&out, 1);
    for (uint64_t i = 0; i < (uint64_t)pool; i++) {
        struct rng rng;
        struct ustream_random u;
        rng_init(&rng, SEED, RNG_BOOTSTRAP, first + i);
        ustream_random_init(&u, &rng);
        struct numbers numbers = {&u.stream, &u.stream, &u.stream};
        target->eval(target->ctx, &numbers, &out);
        sum += out.target;
        sums[i] = sum;
    }
    contrib_deinit(&out);
}

/* Time that chains of one pool spend at each length. */
static void run_pool(const struct target *target, const struct mlt_options *options,
                     uint64_t replicate, struct welford share[DEPTH])
{
    static double sums[4 * POOL];
    int pool = is_long() ? 4 * POOL : POOL;
    struct chain_params params = {0.1, 1.0, ESTIMATOR_PLAIN};
    struct chain_sinks sinks = {.tape = NULL};
    struct chain chain;
    struct rng rng;
    double count[DEPTH] = {0.0};
    uint64_t first = replicate * (uint64_t)pool;
    trace_pool(target, first, pool, sums);
    rng_init(&rng, SEED, RNG_TEST, replicate);
    chain_init(&chain, &state_mlt, options, 1);
    double shift = rng_double(&rng);
    for (int i = 0, path = 0; i < CHAINS; i++) {
        while (sums[path] < (i + shift) / CHAINS * sums[pool - 1])
            path++;
        chain_seed(&chain, target, SEED, first + (uint64_t)path,
                   replicate * CHAINS + (uint64_t)i);
        for (int j = 0; j < STEPS; j++) {
            step_mh.advance(&chain, &params, target, &sinks, 1);
            count[mlt_state_current(chain.state)->edges - 1] += 1.0;
        }
    }
    for (int k = 0; k < DEPTH; k++)
        welford_add(&share[k], count[k] / (CHAINS * STEPS));
    chain_deinit(&chain);
}

static bool check(int s, const struct scene *scene, int d, double level)
{
    struct path_space space;
    struct target target = {eval, &space};
    struct mlt_options options = {
        .scene = scene, .depth = DEPTH, .mutation = {{0.5, 6.0}, {0.003, 0.5}, false}};
    struct welford share[DEPTH] = {{0}};
    double b = 0.0, least = 1.0, sees[DEPTH];
    bool ok = true;
    int replicates = is_long() ? 16 * REPLICATES : REPLICATES;
    memcpy(options.weights, designs[d].weights, sizeof options.weights);
    options.mutation.weighted = designs[d].weighted;
    path_space_init(&space, scene, 1, DEPTH);
    for (int i = 0; i < replicates; i++)
        run_pool(&target, &options, (uint64_t)i, share);
    for (int k = 0; k < DEPTH; k++)
        b += scenes[s].b[k];
    for (int k = 0; k < DEPTH; k++) {
        double se = welford_se(&share[k]), truth = scenes[s].b[k] / b;
        double p = stat_t_p((share[k].mean - truth) / se, replicates - 1);
        char line[120];
        snprintf(line, sizeof line, "%s, %s, %d edges: %.5f +- %.5f for %.5f",
                 test_contents_name[scenes[s].contents], designs[d].name, k + 1,
                 share[k].mean, se, truth);
        least = fmin(least, p);
        sees[k] = 100.0 * stat_t_seen(level, replicates - 1, 0.9) * se / truth;
        ok = stat_ok(line, p, level) && ok;
    }
    printf("%s, %s: least p %.2g; sees %.0f %% of the share of 2 edges, %.0f %% of %d\n",
           test_contents_name[scenes[s].contents], designs[d].name, least, sees[1],
           sees[DEPTH - 1], DEPTH);
    path_space_deinit(&space);
    return ok;
}

static void lengths_have_their_shares(void **state)
{
    (void)state;
    int count = is_long() ? SCENES : 1;
    double level = stat_sidak(FALSE_ALARM, SCENES * DESIGNS * DEPTH);
    bool ok = true;
    for (int s = 0; s < count; s++) {
        struct scene *scene = test_scene(scenes[s].contents, false);
        for (int d = 0; d < DESIGNS; d++)
            ok = check(s, scene, d, level) && ok;
        scene_destroy(scene);
    }
    assert_true(ok);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_have_their_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
