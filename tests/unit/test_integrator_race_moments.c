/* What bdpt's samples tell of pt's second moment, against pt's own samples, as a ratio to
 * bdpt's: a lower bound that tells LEAST of what is above 1. Means over REPLICATES, false
 * alarms FALSE_ALARM for all tests together. Standard errors are below SEES (asserted): a
 * bound that is 10 % above the truth is seen. */

#include "integrator/pass_target.h"
#include "integrator/race_moments.h"
#include "math/accum.h"
#include "path/estimate.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define REPLICATES  24
#define SAMPLES     4000
#define DEPTH       4
#define PIXELS      (16 * 16) /* of test_scene */
#define FALSE_ALARM 1e-4
#define SEES        0.02
#define LEAST       0.2

/* Mean of the squared contributions, techniques apart. */
static double second_moment(const struct scene *scene, estimate_function estimate,
                            uint64_t number)
{
    struct target target = pass_target_create(scene, DEPTH, estimate);
    struct contrib c;
    struct rng rng;
    struct ustream_random stream;
    double sum = 0.0;
    contrib_init(&c, estimate_splats_techniques(DEPTH));
    rng_init(&rng, 5, RNG_TEST, number);
    ustream_random_init(&stream, &rng);
    for (int i = 0; i < SAMPLES; i++) {
        target.eval(target.ctx,
                    &(struct numbers){&stream.stream, &stream.stream, &stream.stream},
                    &c);
        for (int k = 0; k < c.count; k++)
            sum += pow(rgb_luminance(c.splats[k].value), 2.0);
    }
    contrib_deinit(&c);
    pass_target_destroy(&target);
    return sum / SAMPLES;
}

/* Over REPLICATES. */
static struct welford bound_of(const struct scene *scene)
{
    float scale[PIXELS];
    struct welford bound = {0};
    for (int i = 0; i < PIXELS; i++)
        scale[i] = 1.0f;
    for (uint64_t i = 0; i < REPLICATES; i++)
        welford_add(&bound, race_moments(scene, DEPTH, 11 + i, SAMPLES, scale));
    return bound;
}

static void check(const char *name, enum test_contents contents)
{
    struct scene *scene = test_scene(contents, false);
    struct welford pt = {0}, bdpt = {0}, bound = bound_of(scene);
    for (uint64_t i = 0; i < REPLICATES; i++) {
        welford_add(&pt, second_moment(scene, estimate_pt_layers, 2 * i));
        welford_add(&bdpt, second_moment(scene, estimate_bdpt_layers, 2 * i + 1));
    }
    double ratio = pt.mean / bdpt.mean;
    double se = ratio * hypot(welford_se(&pt) / pt.mean, welford_se(&bdpt) / bdpt.mean);
    double t = (bound.mean - ratio) / hypot(se, welford_se(&bound));
    printf("%s: %.4g +- %.2g, bound %.4g +- %.2g\n", name, ratio, se, bound.mean,
           welford_se(&bound));
    assert_true(se < SEES * ratio);
    assert_true(t < 0.0 ||
                stat_ok(name, stat_t_p(t, REPLICATES - 1.0), stat_sidak(FALSE_ALARM, 2)));
    assert_true(bound.mean - 1.0 > LEAST * (ratio - 1.0));
    scene_destroy(scene);
}

static void test_bound(void **state)
{
    (void)state;
    check("sun", TEST_SUN);
    check("parallel", TEST_PARALLEL);
}

/* A point light through glass: pt has no technique for some of the light. */
static void test_blind(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_POINT, false);
    struct welford bound = bound_of(scene);
    printf("blind: bound %.4g\n", bound.mean);
    assert_true(bound.mean > 1000.0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bound),
                                       cmocka_unit_test(test_blind)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
