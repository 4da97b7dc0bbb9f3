/* Spans of time: what was splatted between two looks, whatever was joined since. */
#include "convergence/time_spans.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 20, REPLICAS = 5, LOOKS = 75 };

/* A run of 75 looks, of 2 lengths each: spans are joined twice, and the last few looks
 * are in none yet. Every sequence times its spans' lengths is what was added. */
static void spans_hold_what_was_splatted_per(bool own)
{
    struct replicas *r = replicas_create(WIDTH, HEIGHT, REPLICAS, 3, true);
    struct time_spans b;
    struct rng rng;
    double added[LOOKS][REPLICAS][6] = {0}, x[REPLICAS * TIME_SPANS_MOST];
    rng_init(&rng, 1, RNG_TEST, 0);
    time_spans_init(&b, r, 2.0);
    assert_int_equal(b.tile, TILE_LEAST);
    assert_int_equal(b.columns, 3);
    assert_int_equal(b.rows, 2);
    for (int look = 0; look < LOOKS; look++) {
        for (int i = 0; i < 200; i++) {
            int replica = (int)(rng_u64(&rng) % REPLICAS), amount = i % 7 - 1;
            int x0 = (int)(rng_u64(&rng) % WIDTH), y0 = (int)(rng_u64(&rng) % HEIGHT);
            replica_add(&r->lanes[i % 3], (replica * HEIGHT + y0) * WIDTH + x0,
                        amount * REPLICAS_ONE, 0);
            added[look][replica][y0 / TILE_LEAST * 3 + x0 / TILE_LEAST] += amount;
        }
        for (int lane = 0; lane < 3; lane++)
            replica_flush(&r->lanes[lane]);
        time_spans_take(&b, r, 2.0 * (look + 1), own, 2);
    }
    assert_int_equal(b.count, 9);
    assert_true(b.length == 16.0);
    for (int i = 0; i < b.count; i++) {
        double all = 0.0;
        for (int j = 8 * i * REPLICAS * 6; j < 8 * (i + 1) * REPLICAS * 6; j++)
            all += (&added[0][0][0])[j];
        assert_true(b.lengths[i] == (own ? all / REPLICAS : 16.0));
    }
    for (int tile = -1; tile < 6; tile++) {
        time_spans_sequences(&b, tile, x);
        for (int replica = 0; replica < REPLICAS; replica++)
            for (int i = 0; i < b.count; i++) {
                double sum = 0.0;
                for (int look = 8 * i; look < 8 * i + 8; look++)
                    for (int t = 0; t < 6; t++)
                        sum += t == tile || tile < 0 ? added[look][replica][t] : 0.0;
                assert_true(x[replica * b.count + i] == sum / b.lengths[i]);
            }
    }
    time_spans_deinit(&b);
    replicas_destroy(r);
}

static void spans_hold_what_was_splatted(void **state)
{
    (void)state;
    spans_hold_what_was_splatted_per(false);
    spans_hold_what_was_splatted_per(true);
}

/* Parts that are brighter and brighter, all alike, do not change per brightness of the
 * span; one part that is brighter than the others does so either way. */
static void brightness_that_all_follow(void **state)
{
    (void)state;
    for (int own = 0; own < 2; own++) {
        struct replicas *r = replicas_create(16, 16, 4, 1, true);
        struct time_spans b;
        double x[REPLICAS * TIME_SPANS_MOST];
        time_spans_init(&b, r, 1.0);
        for (int span = 0; span < 8; span++) {
            for (int replica = 0; replica < 4; replica++)
                replica_add(&r->lanes[0], replica * 256,
                            (8 + span) * (replica == 3 ? 5 : 1) * REPLICAS_ONE, 0);
            replica_flush(&r->lanes[0]);
            time_spans_take(&b, r, span + 1.0, own == 1, 1);
        }
        time_spans_sequences(&b, 0, x);
        for (int i = 0; i < 8; i++) {
            assert_true(x[i] == (own ? 0.5 : 8.0 + i));
            assert_true(x[3 * 8 + i] == 5.0 * x[i]);
        }
        time_spans_deinit(&b);
        replicas_destroy(r);
    }
}

static void large_films_have_no_more_tiles(void **state)
{
    (void)state;
    struct replicas like = {.width = 4000, .height = 300, .count = 4};
    struct time_spans b;
    time_spans_init(&b, &like, 1.0);
    assert_true(b.tile > TILE_LEAST && b.tiles <= TILES_MOST);
    assert_true(b.columns * b.tile >= 4000 && (b.columns - 1) * b.tile < 4000);
    time_spans_deinit(&b);
}

/* Half as many, until they fit; lanes only if they do too. */
static void memory_is_bounded(void **state)
{
    (void)state;
    assert_int_equal(replicas_that_fit(1280, 720, 8), 8);
    assert_int_equal(replicas_that_fit(8000, 4000, 8), 4);
    assert_true(replicas_bytes(8000, 4000, 8, 2, true) == 8000.0 * 4000.0 * 4 * 8);
    assert_true(replicas_bytes(1280, 720, 8, 2, true) == 1280.0 * 720.0 * 8 * 8 * 2);
    assert_true(replicas_bytes(1280, 720, 8, 2, false) == 1280.0 * 720.0 * 8 * 8);
}

/* 990 splats of 1 step and 10 of 1024: half of one per cent is five of those. */
static void energy_of_the_brightest(void **state)
{
    (void)state;
    struct replicas *r = replicas_create(2, 2, 4, 1, true);
    assert_true(isnan(replicas_top(r, 0.5)));
    for (int i = 0; i < 1000; i++)
        replica_count_brightness(&r->lanes[0], i < 990 ? 1.0 : 1024.0);
    assert_true(fabs(replicas_top(r, 0.005) - 5120.0 / 11230.0) < 1e-12);
    assert_true(fabs(replicas_top(r, 1.0) - 1.0) < 1e-12);
    replicas_destroy(r);
}

/* Splats far below a step, and of either sign: the sum of many is right on average, with
 * no more than the variance of rounding, whether they differ or are all the same, in one
 * place or in many. Five sigma, fifteen times: a false alarm in 100000. */
static void small_splats_are_not_lost(void **state)
{
    (void)state;
    const double sizes[] = {1e-3, 0.1, 0.5, -0.3, 1000.7};
    enum { SPLATS = 40000, PIXELS = 1024 };
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int i = 0; i < 15; i++) {
        struct replicas *r = replicas_create(16, 16, 4, 1, true);
        double exact = 0.0, sum = 0.0, variance = 0.0;
        for (int j = 0; j < SPLATS; j++) {
            double u = i < 5 ? rng_double(&rng) : 0.5;
            uint64_t random_bits = rng_u64(&rng);
            double steps = sizes[i % 5] * (0.5 + u), part = steps - floor(steps);
            int64_t at = i < 10 ? 3 : j % PIXELS;
            replica_add(&r->lanes[0], at, steps,
                        i < 10 ? random_bits : (uint64_t)(j / PIXELS));
            exact += steps;
            variance += part * (1.0 - part);
        }
        replica_flush(&r->lanes[0]);
        for (int j = 0; j < PIXELS; j++)
            sum += REPLICAS_ONE * replicas_value(r, j / 256, j % 256);
        assert_true(fabs(sum - exact) <= 5.0 * sqrt(variance));
        replicas_destroy(r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spans_hold_what_was_splatted),
        cmocka_unit_test(brightness_that_all_follow),
        cmocka_unit_test(large_films_have_no_more_tiles),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(energy_of_the_brightest),
        cmocka_unit_test(small_splats_are_not_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
