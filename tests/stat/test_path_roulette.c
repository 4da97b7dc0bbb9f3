/* Russian roulette on bdpt's shadow rays: the mean is that of testing every connection,
 * part of the film by part; no more rays are spent than asked for. */

#include "base/mem.h"
#include "math/accum.h"
#include "path/estimate.h"
#include "path/estimate_roulette.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>

#define FALSE_ALARM 1e-4 /* of each test function as a whole */
#define BATCHES     50
#define DEPTH       6
#define RAYS        3.0
#define CELLS       17 /* 4 x 4 blocks of the 16 x 16 film, and all */

static void add_sample(struct subpaths *p, long index, double sign, struct contrib *out,
                       double cells[CELLS])
{
    struct rng rng;
    struct ustream_random u;
    rng_init(&rng, 31, RNG_TEST, (uint64_t)index);
    ustream_random_init(&u, &rng);
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    estimate_bdpt(p, &numbers, out);
    for (int j = 0; j < out->count; j++) {
        int pixel = out->splats[j].pixel;
        double value = sign * rgb_luminance(out->splats[j].value);
        cells[pixel / 64 * 4 + pixel % 16 / 4] += value;
        cells[CELLS - 1] += value;
    }
}

/* Both from the same numbers, the roulette's own being the last: most of the noise is
 * common to both and drops out of the difference. */
static void gather(const struct scene *scene, long paths, struct welford cells[CELLS],
                   struct welford *whole)
{
    struct subpaths every, some;
    struct contrib out;
    subpaths_init(&every, scene, DEPTH);
    subpaths_init(&some, scene, DEPTH);
    estimate_bdpt_roulette(&some, RAYS);
    contrib_init(&out, estimate_splats(DEPTH));
    long index = 0, each = paths / BATCHES;
    for (int batch = 0; batch < BATCHES; batch++) {
        double sums[CELLS] = {0.0}, total[CELLS] = {0.0};
        for (long i = 0; i < each; i++, index++) {
            add_sample(&every, index, 1.0, &out, total);
            add_sample(&some, index, 1.0, &out, sums);
        }
        for (int i = 0; i < CELLS; i++)
            welford_add(&cells[i], (sums[i] - total[i]) / (double)each);
        welford_add(whole, total[CELLS - 1] / (double)each);
    }
    assert_int_equal(out.nonfinite, 0);
    contrib_deinit(&out);
    subpaths_deinit(&every);
    subpaths_deinit(&some);
}

/* Printed: what a bias of the whole film is seen from on, four standard errors. */
static void test_mean(void **state)
{
    (void)state;
    long paths = getenv("ETALON_LONG") ? 2000000 : 25000;
    double level = stat_sidak(FALSE_ALARM, CELLS * TEST_CONTENTS);
    for (int k = 0; k < TEST_CONTENTS; k++) {
        struct scene *scene = test_scene((enum test_contents)k, false);
        struct welford cells[CELLS] = {{0}}, whole = {0};
        const char *name = test_contents_name[k];
        gather(scene, paths, cells, &whole);
        const struct welford *all = &cells[CELLS - 1];
        printf("%s: %.3g of the film, seen from %.2g on\n", name, all->mean / whole.mean,
               4.0 * welford_se(all) / whole.mean);
        for (int i = 0; i < CELLS; i++) {
            double se = welford_se(&cells[i]);
            double z = se > 0.0 ? cells[i].mean / se : 0.0;
            assert_true(stat_ok(name, stat_t_p(z, BATCHES - 1), level));
        }
        scene_destroy(scene);
    }
}

/* Of 20 connections that share the light evenly, K or one more or less are kept, each as
 * often as the others; large ones always. */
static void test_choice(void **state)
{
    (void)state;
    enum { COUNT = 21, TRIALS = 100000 };
    struct subpaths paths = {.max_depth = DEPTH};
    struct rng rng;
    struct ustream_random u;
    double kept[COUNT] = {0.0}, level = stat_sidak(FALSE_ALARM, COUNT);
    rng_init(&rng, 32, RNG_TEST, 0);
    ustream_random_init(&u, &rng);
    estimate_bdpt_roulette(&paths, RAYS);
    struct roulette *r = paths.roulette;
    for (int i = 0; i < TRIALS; i++) {
        for (int k = r->count = 0; k < COUNT; k++) {
            struct connection x = {rgb_grey(k == 7 ? 20.0 : 1.0), 1.0, 0, true};
            struct ray_endpoint none = {0};
            roulette_add(r, &x, k, 1, &none);
        }
        roulette_choose(r, 5.0, &u.stream);
        assert_in_range(r->count, 2, 3);
        for (int k = 0; k < r->count; k++)
            kept[r->pending[k].s] += 1.0 / TRIALS;
    }
    for (int k = 0; k < COUNT; k++) {
        double q = k == 7 ? 1.0 : RAYS / 45.0;
        double se = sqrt(q * (1.0 - q) / TRIALS);
        if (k == 7)
            assert_float_equal(kept[k], 1.0, 1e-9);
        else
            assert_true(stat_ok("share", stat_z_p((kept[k] - q) / se), level));
    }
    mem_free(paths.roulette);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean),
        cmocka_unit_test(test_choice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
