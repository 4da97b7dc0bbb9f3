/* The split of a sample between chains and independent samples: the parts of any sample
 * add up to the sample, whatever floor, ceiling, guess and share of large steps are; no
 * target is above the ceiling. Exact but for rounding. */

#include <string.h>

#include "integrator/split.h"
#include "math/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define PIXELS  16
#define SPLATS  8
#define DEPTH   5
#define SAMPLES 200

static const double floors[] = {0.0, 1e-3, 1.0, 50.0, (double)INFINITY};
static const double ceilings[] = {1e-2, 1.0, 30.0, (double)INFINITY};

/* A guess that has nothing to do with the samples. */
static void make_split(struct rng *rng, float inverse[PIXELS], struct split *split)
{
    for (int j = 0; j < PIXELS; j++)
        inverse[j] = (float)exp(6.0 * rng_double(rng) - 3.0);
    *split = (struct split){.inverse = inverse, .unit = 0.1 + rng_double(rng)};
    split->floor = floors[rng_u64(rng) % 5];
    split->ceiling = ceilings[rng_u64(rng) % 4];
    for (int k = 0; k <= DEPTH; k++) {
        split->techniques[k] = k + 1;
        split->large[k] = rng_double(rng);
    }
}

static void make_sample(struct rng *rng, struct contrib *c)
{
    int count = 1 + (int)(rng_u64(rng) % SPLATS);
    contrib_clear(c);
    for (int i = 0; i < count; i++) {
        int length = 1 + (int)(rng_u64(rng) % DEPTH);
        int t = 1 + (int)(rng_u64(rng) % (uint64_t)(length + 1));
        double size = exp(12.0 * rng_double(rng) - 6.0);
        contrib_add(c, (int)(rng_u64(rng) % PIXELS),
                    rgb(size * rng_double(rng), size * rng_double(rng), size),
                    length + 1 - t, t);
    }
}

static void copy(const struct contrib *from, struct contrib *to)
{
    contrib_clear(to);
    for (int i = 0; i < from->count; i++)
        contrib_add(to, from->splats[i].pixel, from->splats[i].value, from->splats[i].s,
                    from->splats[i].t);
}

static void check_value(double a, double b)
{
    assert_true(fabs(a - b) <= 1e-12 * fabs(b));
}

/* s F + large (1-s) F + (1 - large) (1-s) F = F, where large steps splat rest times what
 * the chain has. */
static void check_sum(struct rgb chain, double rest, double large, struct rgb passes,
                      struct rgb whole)
{
    double factor = 1.0 + rest * large;
    check_value(factor * chain.r + passes.r, whole.r);
    check_value(factor * chain.g + passes.g, whole.g);
    check_value(factor * chain.b + passes.b, whole.b);
}

static void test_whole_samples(void **state)
{
    (void)state;
    struct contrib sample, chain, passes;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    contrib_init(&sample, SPLATS);
    contrib_init(&chain, SPLATS);
    contrib_init(&passes, SPLATS);
    for (int n = 0; n < SAMPLES; n++) {
        float inverse[PIXELS];
        struct split split;
        make_split(&rng, inverse, &split);
        make_sample(&rng, &sample);
        copy(&sample, &chain);
        copy(&sample, &passes);
        double rho = split_relative(&split, &sample);
        split_for_chain(&split, 0, &chain);
        split_for_passes(&split, &passes);
        assert_true(chain.target <= split.unit * fmin(rho, split.ceiling) * (1 + 1e-12));
        if (chain.count == 0) { /* the chain has nothing */
            assert_true(split.floor == (double)INFINITY);
            check_value(passes.target, (1.0 - split.large[0]) * sample.target);
            continue;
        }
        for (int i = 0; i < sample.count; i++)
            check_sum(chain.splats[i].value, chain.rest, split.large[0],
                      passes.splats[i].value, sample.splats[i].value);
    }
    contrib_deinit(&sample);
    contrib_deinit(&chain);
    contrib_deinit(&passes);
}

/* A chain that picks one technique of n has n times its contribution, with probability
 * 1/n. */
static void test_single_techniques(void **state)
{
    (void)state;
    struct contrib sample, chain, passes;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    contrib_init(&sample, SPLATS);
    contrib_init(&chain, 1);
    contrib_init(&passes, SPLATS);
    for (int n = 0; n < SAMPLES; n++) {
        float inverse[PIXELS];
        struct split split;
        make_split(&rng, inverse, &split);
        split.by_technique = true;
        make_sample(&rng, &sample);
        copy(&sample, &passes);
        split_for_passes(&split, &passes);
        for (int i = 0; i < sample.count; i++) {
            const struct splat *s = &sample.splats[i];
            int length = s->s + s->t - 1, count = split.techniques[length];
            contrib_clear(&chain);
            contrib_add(&chain, s->pixel, rgb_scale(s->value, count), s->s, s->t);
            split_for_chain(&split, length, &chain);
            assert_true(chain.target <= split.unit * split.ceiling * (1 + 1e-12));
            if (chain.count == 0)
                continue;
            check_sum(rgb_scale(chain.splats[0].value, 1.0 / count), chain.rest,
                      split.large[length], passes.splats[i].value, s->value);
        }
    }
    contrib_deinit(&sample);
    contrib_deinit(&chain);
    contrib_deinit(&passes);
}

/* A length that one part alone renders. */
static void test_one_part(void **state)
{
    (void)state;
    float inverse[1] = {1.0f};
    struct split split = {.inverse = inverse, .unit = 1.0, .floor = 1.0, .ceiling = 2.0};
    struct contrib chain, passes;
    contrib_init(&chain, 1);
    contrib_init(&passes, 1);
    split.by_technique = true;
    split.techniques[2] = 3;
    for (int part = SPLIT_CHAINS; part <= SPLIT_PASSES; part++) {
        split.only[2] = (enum split_only)part;
        contrib_clear(&chain);
        contrib_add(&chain, 0, rgb_grey(6.0), 1, 2);
        contrib_clear(&passes);
        contrib_add(&passes, 0, rgb_grey(2.0), 1, 2);
        split_for_chain(&split, 2, &chain);
        split_for_passes(&split, &passes);
        bool chains = part == SPLIT_CHAINS;
        assert_true(chain.count == (chains ? 1 : 0));
        check_value(passes.target, chains ? 0.0 : 2.0 * rgb_luminance(rgb_grey(1.0)));
    }
    contrib_deinit(&chain);
    contrib_deinit(&passes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_samples),
        cmocka_unit_test(test_single_techniques),
        cmocka_unit_test(test_one_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
