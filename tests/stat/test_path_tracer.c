/* estimate_pt against a path tracer by hand (support/pt_oracle.h), sample by sample and
 * channel by channel, on the same numbers. Both compute every direction, cosine, BSDF
 * value and emission by the same operations, so that these are equal in all bits. What
 * differs is the order in which terms are made of them: products, quotients and sums of
 * positive doubles, whose relative errors add up by at most U = 2^-53 an operation.
 *
 * - Light hit by chance, estimate_pt: 7 (1/d^2, two for its density, the ratio, the sum,
 *   the weight, its product with the value).
 * - The same, oracle: 5 (both densities, their sum, the ratio, the product).
 * - Next-event estimation, estimate_pt: 12, of them 5 for the value (1/d^2, two for the
 *   geometric term, the density, the product), 6 for the weight (1/d^2, two for the other
 *   density, the ratio, the sum, the weight), 1 for the product of the two.
 * - The same, oracle: 5 (the cosines, a density, their sum, the ratio, the product).
 *
 * A term thus differs by at most 17, and one an addition on each side for the sum of all
 * terms: a path of k edges has k hits and k - 1 connections. One U more covers terms of
 * second order. The bound holds for every sample: there is no false alarm.
 *
 * Power: of faults 1 + 2^-k planted into the weight of either kind of term, those down to
 * 2^-47 are seen. */

#include "support/pt_oracle.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define SAMPLES 20000
#define DEPTH   6
#define U       0x1p-53
#define TERM    17
#define TERMS   (2 * DEPTH - 1)
#define BOUND   (TERM + 2 * (TERMS - 1) + 1)

static struct rgb splat_sum(const struct contrib *c)
{
    struct rgb sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < c->count; i++)
        sum = rgb_add(sum, c->splats[i].value);
    return sum;
}

/* |a - b| over the larger, in U. */
static double apart(double a, double b)
{
    double most = fmax(fabs(a), fabs(b));
    return most > 0.0 ? fabs(a - b) / (U * most) : 0.0;
}

static double samples_apart(const struct contrib *a, const struct contrib *b)
{
    struct rgb x = splat_sum(a), y = splat_sum(b);
    return fmax(apart(x.r, y.r), fmax(apart(x.g, y.g), apart(x.b, y.b)));
}

static void compare(enum test_contents contents)
{
    struct scene *scene = test_scene(contents, false);
    struct rng rng[2];
    struct ustream_random u[2];
    struct subpaths paths[2];
    struct contrib out[2];
    long lit = 0, beyond = 0;
    double worst = 0.0;
    for (int i = 0; i < 2; i++) {
        rng_init(&rng[i], 21, RNG_TEST, contents);
        ustream_random_init(&u[i], &rng[i]);
        subpaths_init(&paths[i], scene, DEPTH);
        contrib_init(&out[i], estimate_splats(DEPTH));
    }
    for (long i = 0; i < SAMPLES; i++) {
        for (int j = 0; j < 2; j++) {
            struct numbers numbers = {&u[j].stream, &u[j].stream, &u[j].stream};
            (j ? pt_oracle : estimate_pt)(&paths[j], &numbers, &out[j]);
        }
        double distance = samples_apart(&out[0], &out[1]);
        worst = fmax(worst, distance);
        lit += out[0].count > 0;
        beyond += distance > BOUND;
        assert_int_equal(paths[0].pixel, paths[1].pixel);
    }
    printf(
        "%-10s %ld of %d samples are lit; the worst is %.1f U apart, bound %d; beyond it "
        "%ld\n",
        test_contents_name[contents], lit, SAMPLES, worst, BOUND, beyond);
    assert_true(lit > SAMPLES / 4);
    assert_int_equal(beyond, 0);
    assert_int_equal(out[0].nonfinite + out[1].nonfinite, 0);
    for (int i = 0; i < 2; i++) {
        contrib_deinit(&out[i]);
        subpaths_deinit(&paths[i]);
    }
    scene_destroy(scene);
}

static void test_samples(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++)
        compare((enum test_contents)i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_samples)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
