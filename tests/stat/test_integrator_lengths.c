/* Chains of each mutation alone, with a tenth of independent paths, by path length. A
 * pool of independent paths has the mean W of f/p; chains that start at paths of it drawn
 * by f/p, and keep f, spend at length k a share S_k of their time with E[W S_k] = b_k,
 * however small the pool is and however long they run: a pool's paths weighed by f/p,
 * each followed by steps that keep f. The pool itself has a mean of b_k. So of each
 * replicate, a pool and its chains, the difference has the mean 0, and t-tests over
 * replicates need no table; that pools agree with bdpt's estimator is a test of its own.
 * (Means of S_k without W are off by what the ratio of two sums is: 2 % for pools of
 * 1500, by 14 standard errors in the long form.)
 *
 * False-alarm rate of this file: FALSE_ALARM. What each test sees is printed: the change
 * of b_k that fails it in nine of ten runs. With ETALON_LONG all scenes, and LONGER
 * times as many replicates. */

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
#define POOL        1500
#define CHAINS      24 /* of one pool */
#define STEPS       40
#define REPLICATES  360
#define LONGER      21 /* the long form, times as many */
#define SEED        17

/* b of 1, 2, ... edges by bdpt's estimator, with standard errors: the tables of
 * test_integrator_chains.c. */
static const struct {
    enum test_contents contents;
    double b[DEPTH], se[DEPTH];
} scenes[] = {
    {TEST_POINT,
     {0.186499, 0.149949, 0.0467592, 0.0343525, 0.0163278},
     {5e-4, 5e-5, 2e-5, 3e-5, 2e-5}},
    {TEST_DIFFUSE,
     {0.146846, 0.0972357, 0.030628, 0.0137324, 0.00545959},
     {5e-4, 2e-5, 1e-5, 7e-6, 3e-6}},
    {TEST_PANES,
     {0.127525, 0.468693, 0.0386295, 0.0145717, 0.00677665},
     {4e-4, 4e-4, 5e-5, 2e-5, 1e-5}},
};
#define SCENES ((int)(sizeof scenes / sizeof scenes[0]))

static const struct {
    const char *name;
    double weights[MLT_MOVES];
    bool weighted;
} designs[] = {
    {"lens", {1, 0, 0, 0, 0}, false},
    {"caustic", {0, 1, 0, 0, 0}, false},
    {"multichain", {0, 0, 1, 0, 0}, false},
    {"bidirectional, uniform", {0, 0, 0, 1, 0}, false},
    {"bidirectional, weighted", {0, 0, 0, 1, 0}, true},
    {"lens sub-path", {0, 0, 0, 0, 1}, false},
    {"numbers", {0, 0, 0, 0, 0, 1}, false},
};
#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))

static bool is_long(void)
{
    return getenv("ETALON_LONG") != NULL;
}

/* Steps of numbers are in the long form only. */
static int design_count(void)
{
    return is_long() ? DESIGNS : DESIGNS - 1;
}

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    full_path_sample(ctx, numbers, out);
}

/* Independent paths: f/p of all up to each, W, and what paths of each length add to W. */
struct pool {
    double sums[POOL], mean, b[DEPTH];
};

static void trace_pool(const struct target *target, uint64_t first, struct pool *pool)
{
    const struct path_space *space = target->ctx;
    double share = space->paths.scene->emission_scale / POOL, sum = 0.0;
    struct contrib out;
    contrib_init(&out, 1);
    memset(pool->b, 0, sizeof pool->b);
    for (uint64_t i = 0; i < POOL; i++) {
        struct rng rng;
        struct ustream_random u;
        rng_init(&rng, SEED, RNG_BOOTSTRAP, first + i);
        ustream_random_init(&u, &rng);
        struct numbers numbers = {&u.stream, &u.stream, &u.stream};
        target->eval(target->ctx, &numbers, &out);
        if (out.target > 0.0)
            pool->b[space->sampled.edges - 1] += share * out.target;
        sum += out.target;
        pool->sums[i] = sum;
    }
    pool->mean = share * sum;
    contrib_deinit(&out);
}

/* W times the time that chains of the pool spend at each length, over the pool's b. */
static void run_chains(const struct target *target, const struct mlt_options *options,
                       const struct pool *pool, uint64_t replicate,
                       struct welford difference[DEPTH])
{
    struct chain_params params = {0.1, 1.0, ESTIMATOR_PLAIN};
    struct chain_sinks sinks = {.tape = NULL};
    struct chain chain;
    struct rng rng;
    double count[DEPTH] = {0.0};
    rng_init(&rng, SEED, RNG_TEST, replicate);
    chain_init(&chain, &state_mlt, options, 1);
    double shift = rng_double(&rng);
    for (int i = 0, path = 0; i < CHAINS; i++) {
        while (pool->sums[path] < (i + shift) / CHAINS * pool->sums[POOL - 1])
            path++;
        chain_seed(&chain, target, SEED, replicate * POOL + (uint64_t)path,
                   replicate * CHAINS + (uint64_t)i);
        for (int j = 0; j < STEPS; j++) {
            step_mh.advance(&chain, &params, target, &sinks, 1);
            count[mlt_state_current(chain.state)->edges - 1] += 1.0;
        }
    }
    for (int k = 0; k < DEPTH; k++)
        welford_add(&difference[k],
                    pool->mean * count[k] / (CHAINS * STEPS) - pool->b[k]);
    chain_deinit(&chain);
}

/* Of one scene: of pools, and of chains less pools by design. */
struct outcome {
    struct welford b[DEPTH], difference[DESIGNS][DEPTH];
};

static void run_scene(const struct scene *scene, int replicates, struct outcome *o)
{
    static struct pool pool;
    struct path_space space;
    struct target target = {eval, &space};
    struct mlt_options options = {
        .scene = scene, .depth = DEPTH, .mutation = {{0.5, 6.0}, {0.003, 0.5}, false}};
    kernel_init(&options.kernel, &kernel_exponential, 0.0, 0.01, 0.1);
    path_space_init(&space, scene, 1, DEPTH);
    for (uint64_t i = 0; i < (uint64_t)replicates; i++) {
        trace_pool(&target, i * POOL, &pool);
        for (int k = 0; k < DEPTH; k++)
            welford_add(&o->b[k], pool.b[k]);
        for (int d = 0; d < design_count(); d++) {
            memcpy(options.weights, designs[d].weights, sizeof options.weights);
            options.mutation.weighted = designs[d].weighted;
            run_chains(&target, &options, &pool, i, o->difference[d]);
        }
    }
    path_space_deinit(&space);
}

/* `known`: NULL, or standard errors of the truth. */
static bool check(const char *name, const struct welford of[DEPTH], const double *truth,
                  const double *known, const double *unit, double level)
{
    double least = 1.0, sees[DEPTH];
    bool ok = true;
    for (int k = 0; k < DEPTH; k++) {
        double freedom = of[k].count - 1.0;
        double se = hypot(welford_se(&of[k]), known ? known[k] : 0.0);
        double p = stat_t_p((of[k].mean - truth[k]) / se, freedom);
        char line[120];
        snprintf(line, sizeof line, "%s, %d edges: %.3g +- %.2g for %.3g", name, k + 1,
                 of[k].mean, se, truth[k]);
        if (is_long())
            printf("%s, z %.2f\n", line, (of[k].mean - truth[k]) / se);
        least = fmin(least, p);
        sees[k] = 100.0 * stat_t_seen(level, freedom, 0.9) * se / unit[k];
        ok = stat_ok(line, p, level) && ok;
    }
    printf("%s: least p %.2g; sees %.1f %% of b of 2 edges, %.1f %% of %d\n", name, least,
           sees[1], sees[DEPTH - 1], DEPTH);
    return ok;
}

static bool check_scene(int s, const struct outcome *o, double level)
{
    const double none[DEPTH] = {0.0};
    char name[64];
    snprintf(name, sizeof name, "%s, independent paths",
             test_contents_name[scenes[s].contents]);
    bool ok = check(name, o->b, scenes[s].b, scenes[s].se, scenes[s].b, level);
    for (int d = 0; d < design_count(); d++) {
        snprintf(name, sizeof name, "%s, %s", test_contents_name[scenes[s].contents],
                 designs[d].name);
        ok = check(name, o->difference[d], none, NULL, scenes[s].b, level) && ok;
    }
    return ok;
}

static void lengths_have_their_shares(void **state)
{
    (void)state;
    int count = is_long() ? SCENES : 1;
    int replicates = is_long() ? LONGER * REPLICATES : REPLICATES;
    double level = stat_sidak(FALSE_ALARM, SCENES * (DESIGNS + 1) * DEPTH);
    bool ok = true;
    for (int s = 0; s < count; s++) {
        struct outcome outcome = {0};
        struct scene *scene = test_scene(scenes[s].contents, false);
        run_scene(scene, replicates, &outcome);
        ok = check_scene(s, &outcome, level) && ok;
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
