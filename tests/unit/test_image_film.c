/* The film's promise: exact sums, the same bits in any order and for any number of
 * threads, and no overflow unseen. */
#include "base/mem.h"
#include "base/par.h"
#include "image/contrib.h"
#include "image/film.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

enum { WIDTH = 16, HEIGHT = 5, PIXELS = WIDTH * HEIGHT, SPLATS = 60000 };

struct job {
    struct film *film;
    const struct splat *splats;
    const double *weights;
    const int *order;
};

static void splat_one(void *ctx, long index, int thread)
{
    const struct job *job = ctx;
    int i = job->order[index];
    film_splat(film_lane(job->film, thread), job->splats[i].pixel, job->splats[i].value,
               job->weights[i]);
}

/* Sizes over twelve decades, both signs. */
static void make_splats(struct splat *splats, double *weights, int *order)
{
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int i = 0; i < SPLATS; i++) {
        splats[i].pixel = (int32_t)(rng_u64(&rng) % PIXELS);
        splats[i].value = rgb(rng_double(&rng), -rng_double(&rng),
                              1e3 * rng_double(&rng));
        weights[i] = pow(10.0, -9.0 * rng_double(&rng));
        order[i] = i;
    }
}

static void shuffle(int *order, uint64_t index)
{
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, index);
    for (int i = SPLATS - 1; i > 0; i--) {
        int j = (int)(rng_u64(&rng) % (uint64_t)(i + 1));
        int swap = order[i];
        order[i] = order[j];
        order[j] = swap;
    }
}

static bool same_sums(const struct film *a, const struct film *b)
{
    for (int i = 0; i < 3 * PIXELS; i++) {
        struct film_sum x = film_channel(a, i / 3, i % 3);
        struct film_sum y = film_channel(b, i / 3, i % 3);
        if (x.high != y.high || x.low != y.low || x.fine != y.fine)
            return false;
    }
    return true;
}

static void sums_do_not_depend_on_order_or_threads(void **state)
{
    (void)state;
    static struct splat splats[SPLATS];
    static double weights[SPLATS];
    static int order[SPLATS];
    make_splats(splats, weights, order);
    struct film *first = film_create(WIDTH, HEIGHT), *film = film_create(WIDTH, HEIGHT);
    struct job job = {first, splats, weights, order};
    for (long i = 0; i < SPLATS; i++)
        splat_one(&job, i, 0);
    job.film = film;
    for (uint64_t run = 0; run < 12; run++) {
        int threads = 1 + (int)(run % 3), rounds = 1 + (int)(run / 3);
        shuffle(order, run);
        film_clear(film);
        if (run == 6) /* from here on each thread has its own lane */
            film_add_lanes(film, 3, FILM_LANES_BYTES);
        for (int round = 0; round < rounds; round++) {
            long begin = SPLATS * (long)round / rounds;
            struct job part = job;
            part.order = order + begin;
            par_for(SPLATS * (round + 1L) / rounds - begin, threads, splat_one, &part);
        }
        assert_true(same_sums(first, film));
    }
    assert_true(first->saturated == 0 && film->saturated == 0);
    film_destroy(first);
    film_destroy(film);
}

static double channel(struct rgb value, int c)
{
    return c == 0 ? value.r : c == 1 ? value.g : value.b;
}

/* Each splat is off by at most half a step of 2^-36; sums add nothing to that. */
static void sums_are_exact_to_half_a_step_a_splat(void **state)
{
    (void)state;
    static struct splat splats[SPLATS];
    static double weights[SPLATS];
    static int order[SPLATS];
    static long double sum[PIXELS][3];
    static long count[PIXELS];
    make_splats(splats, weights, order);
    struct film *film = film_create(WIDTH, HEIGHT);
    for (int i = 0; i < SPLATS; i++) {
        int pixel = splats[i].pixel;
        film_splat(film, pixel, splats[i].value, weights[i]);
        count[pixel]++;
        for (int c = 0; c < 3; c++)
            sum[pixel][c] += (long double)channel(splats[i].value, c) *
                             (long double)weights[i];
    }
    for (int pixel = 0; pixel < PIXELS; pixel++)
        for (int c = 0; c < 3; c++) {
            double value = channel(film_value(film, pixel), c);
            long double bound = 0x1p-37L * count[pixel] + 0x1p-52L * fabsl(sum[pixel][c]);
            assert_true(fabsl((long double)value - sum[pixel][c]) <= bound);
        }
    film_destroy(film);
}

/* What 2^40 splats of weight 1e-9 and 2^40 of weight 1 would leave: 2^20 times the
 * integer that 2^20 such splats add up to, with a spill wherever a splat would have made
 * one. */
static void a_trillion_splats_lose_nothing(void **state)
{
    (void)state;
    struct film *film = film_create(2, 1);
    film_splat(film, 0, rgb(1.0, -1.0, 0.0), 1e-9);
    film_splat(film, 1, rgb(1.0, -1.0, 0.0), 1.0);
    int64_t fine = film->fine[0], steps = film->steps[FILM_STRIDE];
    assert_true(fabs((double)fine - 1e-9 * 0x1p72) <= 1.0 && (double)steps == FILM_ONE);
    assert_true(film->fine[1] == -fine && film->steps[FILM_STRIDE + 1] == -steps);
    film_clear(film);
    film->rows[0] = FILM_ROW_FINE;
    for (long turn = 0; turn < 1L << 20; turn++) {
        /* 2^20 small splats carry over what makes whole steps, as those of a splat do. */
        int64_t both = fine << 20;
        film->steps[0] += both >> FILM_FINE_BITS;
        film->steps[1] -= both >> FILM_FINE_BITS;
        film->fine[0] += both & (((int64_t)1 << FILM_FINE_BITS) - 1);
        film->fine[1] -= both & (((int64_t)1 << FILM_FINE_BITS) - 1);
        film->steps[FILM_STRIDE] += steps << 20;
        film->steps[FILM_STRIDE + 1] -= steps << 20;
        for (int i = 0; i < 2; i++)
            film_spill(film, &film->steps[FILM_STRIDE + i]);
        for (int pixel = 0; pixel < 2; pixel++)
            film->steps[FILM_STRIDE * pixel + 2] += turn & 1 ? 1 : -1;
    }
    const double weights[2] = {1e-9, 1.0};
    for (int pixel = 0; pixel < 2; pixel++) {
        struct rgb value = film_value(film, pixel);
        double expected = 0x1p40 * weights[pixel];
        assert_true(fabs(value.r - expected) <= 0x1p-33 + 0x1p-50 * expected);
        assert_true(value.g == -value.r && value.b == 0.0);
    }
    film_destroy(film);
}

static void splat_small(void *ctx, long index, int thread)
{
    struct film *film = ctx;
    (void)index;
    film_splat(film_lane(film, thread), 0, rgb(1.0, 1e-3, -1e-6), 0x0.fffp-20);
}

/* Splats below 2^-20 units: 2^18 of them, of which the fine sum alone could hold 2^11, on
 * a film of all threads and on lanes, within a last bit of their sum. */
static void small_splats_keep_their_size(void **state)
{
    (void)state;
    const long count = 1L << 18;
    const double sizes[3] = {1.0, 1e-3, -1e-6};
    for (int lanes = 0; lanes < 2; lanes++) {
        struct film *film = film_create(1, 1);
        if (lanes)
            film_add_lanes(film, 2, FILM_LANES_BYTES);
        par_for(count, 2, splat_small, film);
        for (int c = 0; c < 3; c++) {
            double expected = sizes[c] * 0x0.fffp-20 * (double)count;
            double bound = 0x1p-73 * (double)count + 0x1p-50 * fabs(expected);
            assert_true(fabs(channel(film_value(film, 0), c) - expected) <= bound);
        }
        assert_true(film_saturated(film) == 0);
        film_destroy(film);
    }
}

/* Three lanes and the wide sum, each with any number that splats may leave there. */
static void sums_are_exact_against_wide_integers(void **state)
{
    (void)state;
    struct film *film = film_create(1, 1);
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    film_add_lanes(film, 3, FILM_LANES_BYTES);
    film->rows[0] = FILM_ROW_HIGH | FILM_ROW_FINE;
    for (int round = 0; round < 10000; round++) {
        for (int c = 0; c < 3; c++) {
            int64_t fine = (int64_t)rng_u64(&rng) >> (3 + rng_u64(&rng) % 60);
            int64_t high = (int64_t)rng_u64(&rng) >> (rng_u64(&rng) % 63);
            __extension__ __int128 sum = (__int128)high * (INT64_C(1) << 32);
            film->high[c] = high;
            film->fine[c] = fine;
            sum += fine >> FILM_FINE_BITS;
            for (int lane = 0; lane < 3; lane++) {
                int64_t steps = (int64_t)rng_u64(&rng) >> (3 + rng_u64(&rng) % 60);
                film->lanes[lane].steps[c] = steps;
                sum += steps;
            }
            struct film_sum s = film_channel(film, 0, c);
            assert_true(s.high == (int64_t)(sum >> 32) && s.low == (uint32_t)sum);
            assert_true(s.fine >= 0 && s.fine < (int64_t)1 << FILM_FINE_BITS);
            assert_true((s.fine - fine) % ((int64_t)1 << FILM_FINE_BITS) == 0);
            double expected = (double)((long double)sum / 0x1p36L);
            double value = channel(film_value(film, 0), c);
            assert_true(fabs(value - expected) <= 0x1p-52 * fabs(expected) + 0x1p-36);
        }
    }
    film_destroy(film);
}

static void clamped_splats_are_counted(void **state)
{
    (void)state;
    struct film *film = film_create(1, 1);
    film_splat(film, 0, rgb(0x1p24, -0x1p24, 0x1p23), 1.0); /* at the limit: legal */
    assert_true(film->saturated == 0);
    film_clear(film);
    film_splat(film, 0, rgb(0x1.001p24, -1e300, 1.0), 1.0);
    assert_true(film->saturated == 2);
    struct rgb value = film_value(film, 0);
    assert_true(value.r == 0x1p24 && value.g == -0x1p24 && value.b == 1.0);
    film_splat(film, 0, rgb((double)NAN, (double)INFINITY, (double)-INFINITY), 1.0);
    assert_true(film->saturated == 5);
    value = film_value(film, 0);
    assert_true(value.r == 0x1p24 && value.g == 0.0 && value.b == 1.0 - 0x1p24);
    film_clear(film);
    value = film_value(film, 0);
    assert_true(film->saturated == 0 && rgb_is_black(value));
    film_destroy(film);
}

struct heap {
    struct film *film;
    double sign;
};

static void heap_up(void *ctx, long index, int thread)
{
    const struct heap *heap = ctx;
    (void)index;
    film_splat(film_lane(heap->film, thread), 0, rgb(heap->sign * 0x1p23, 1.5, 0.0), 1.0);
}

/* A pixel that would overflow spills into the wide sum: 2^15 splats of
 * 2^23 units are 2^38, where 2^27 fill 64 bits. */
static void full_pixels_spill(void **state)
{
    (void)state;
    for (int run = 0; run < 4; run++) {
        struct heap heap = {film_create(2, 1), run % 2 ? 1.0 : -1.0};
        if (run >= 2)
            film_add_lanes(heap.film, 3, FILM_LANES_BYTES);
        par_for(1L << 15, 3, heap_up, &heap);
        struct rgb value = film_value(heap.film, 0);
        assert_true(value.r == heap.sign * 0x1p38 && value.g == 1.5 * 0x1p15);
        assert_true(value.b == 0.0 && rgb_is_black(film_value(heap.film, 1)));
        assert_true(film_saturated(heap.film) == 0);
        film_destroy(heap.film);
    }
}

static void contrib_sums_what_it_keeps(void **state)
{
    (void)state;
    struct contrib c;
    contrib_init(&c, 3);
    contrib_add(&c, 7, rgb(1.0, 2.0, 3.0), 2, 5);
    contrib_add(&c, 8, rgb(0.0, 0.0, 0.0), 0, 2);
    contrib_add(&c, 8, rgb((double)NAN, 0.0, 0.0), 0, 2);
    contrib_add(&c, 8, rgb(1.0, (double)INFINITY, 0.0), 0, 2);
    contrib_add(&c, 9, rgb(0.0, 1.0, 0.0), 1, 1);
    assert_int_equal(c.count, 2);
    assert_true(c.nonfinite == 2);
    double first = 0.2126 + 2.0 * 0.7152 + 3.0 * 0.0722;
    assert_true(fabs(c.target - (first + 0.7152)) < 1e-15);
    assert_true(c.splats[0].pixel == 7 && c.splats[0].s == 2 && c.splats[0].t == 5);
    assert_true(c.splats[1].pixel == 9 && c.splats[1].value.g == 1.0);
    contrib_clear(&c);
    assert_true(c.count == 0 && c.target == 0.0 && c.nonfinite == 2 && c.capacity == 3);
    contrib_deinit(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_do_not_depend_on_order_or_threads),
        cmocka_unit_test(sums_are_exact_to_half_a_step_a_splat),
        cmocka_unit_test(a_trillion_splats_lose_nothing),
        cmocka_unit_test(small_splats_keep_their_size),
        cmocka_unit_test(sums_are_exact_against_wide_integers),
        cmocka_unit_test(clamped_splats_are_counted),
        cmocka_unit_test(full_pixels_spill),
        cmocka_unit_test(contrib_sums_what_it_keeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
