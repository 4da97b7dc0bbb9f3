#include "image/film.h"

#include "base/mem.h"
#include "base/pack.h"
#include "base/par.h"

#include <stddef.h>
#include <string.h>

enum { CACHE_LINE = 64 };

static size_t film_pixels(const struct film *film)
{
    return (size_t)film->width * (size_t)film->height;
}

static void film_arrays(struct film *film, struct mem_plan *plan)
{
    size_t pixels = film_pixels(film);
    film->round = mem_take(plan, CACHE_LINE, FILM_STRIDE * pixels, sizeof *film->round);
    film->high = mem_take(plan, 0, 3 * pixels, sizeof *film->high);
    film->low = mem_take(plan, 0, 3 * pixels, sizeof *film->low);
    film->fine = mem_take(plan, 0, 3 * pixels, sizeof *film->fine);
}

static void lane_array(struct film *lane, struct mem_plan *plan)
{
    lane->round = mem_take(plan, CACHE_LINE, FILM_STRIDE * film_pixels(lane),
                           sizeof *lane->round);
}

struct film *film_create(int width, int height)
{
    struct film *film = mem_alloc(1, sizeof *film);
    film->width = width;
    film->height = height;
    film_arrays(film, &(struct mem_plan){.take = true});
    return film;
}

void film_destroy(struct film *film)
{
    if (!film)
        return;
    for (int i = 0; i < film->lane_count; i++)
        mem_free(film->lanes[i].round);
    mem_free(film->lanes);
    mem_free(film->round);
    mem_free(film->high);
    mem_free(film->low);
    mem_free(film->fine);
    mem_free(film);
}

double film_bytes(int width, int height)
{
    struct mem_plan plan = {.take = false};
    film_arrays(&(struct film){.width = width, .height = height}, &plan);
    return plan.bytes;
}

double film_fine_bytes(int width, int height)
{
    return (double)width * height * 3 * sizeof(int64_t);
}

double film_lanes_bytes(int width, int height, int threads)
{
    struct mem_plan plan = {.take = false};
    lane_array(&(struct film){.width = width, .height = height}, &plan);
    return plan.bytes * threads;
}

void film_add_lanes(struct film *film, int threads, double bytes)
{
    if (film->lanes || film_lanes_bytes(film->width, film->height, threads) > bytes)
        return;
    film->lanes = mem_aligned(CACHE_LINE, (size_t)threads, sizeof *film->lanes);
    film->lane_count = threads;
    for (int i = 0; i < threads; i++) {
        film->lanes[i] = (struct film){
            .width = film->width, .height = film->height, .whole = film};
        lane_array(&film->lanes[i], &(struct mem_plan){.take = true});
    }
}

void film_clear(struct film *film)
{
    size_t pixels = film_pixels(film);
    memset(film->round, 0, FILM_STRIDE * pixels * sizeof *film->round);
    memset(film->high, 0, 3 * pixels * sizeof *film->high);
    memset(film->low, 0, 3 * pixels * sizeof *film->low);
    memset(film->fine, 0, 3 * pixels * sizeof *film->fine);
    film->saturated = 0;
    for (int i = 0; i < film->lane_count; i++) {
        memset(film->lanes[i].round, 0, FILM_STRIDE * pixels * sizeof *film->round);
        film->lanes[i].saturated = 0;
    }
}

static ptrdiff_t channel_of(const struct film *film, const int64_t *at)
{
    ptrdiff_t place = at - film->round;
    return place / FILM_STRIDE * 3 + place % FILM_STRIDE;
}

/* The whole steps of a fine sum, which fold_fine carries over. */
static int64_t fine_carry(int64_t fine)
{
    return fine >> FILM_FINE_BITS;
}

/* A small splat is at most 2^52 fine steps, so a sum beyond 2^60 is rare; its whole steps
 * are moved to the wide sum. The thread that finds the sum moves it, exactly once. */
static void add_small(struct film *whole, ptrdiff_t channel, double steps)
{
    double exact = steps * (double)(INT64_C(1) << FILM_FINE_BITS);
    int64_t fine = (int64_t)(exact + copysign(0.5, exact)), *at = &whole->fine[channel];
    int64_t sum = __atomic_add_fetch(at, fine, __ATOMIC_RELAXED);
    if (sum <= FILM_SPILL && sum >= -FILM_SPILL)
        return;
    int64_t carry = fine_carry(sum);
    __atomic_fetch_sub(at, carry * (INT64_C(1) << FILM_FINE_BITS), __ATOMIC_RELAXED);
    int64_t *round = &whole->round[channel / 3 * FILM_STRIDE + channel % 3];
    __atomic_fetch_add(round, carry, __ATOMIC_RELAXED);
}

double film_splat_out_of_range(struct film *film, const int64_t *at, double steps)
{
    if (fabs(steps) < FILM_SMALL) {
        add_small(film->whole ? film->whole : film, channel_of(film, at), steps);
        return 0.0;
    }
    __atomic_fetch_add(&film->saturated, 1, __ATOMIC_RELAXED);
    return isnan(steps) ? 0.0 : copysign(FILM_SPLAT_LIMIT, steps);
}

/* The lower 32 bits stay, so that only one word of the wide sum changes. The thread that
 * finds the sum beyond the limit moves it, exactly once. */
void film_spill(struct film *film, int64_t *at)
{
    int64_t steps = __atomic_load_n(at, __ATOMIC_RELAXED);
    do {
        if (steps <= FILM_SPILL && steps >= -FILM_SPILL)
            return;
    } while (!__atomic_compare_exchange_n(at, &steps, steps & UINT32_MAX, false,
                                          __ATOMIC_RELAXED, __ATOMIC_RELAXED));
    struct film *whole = film->whole ? film->whole : film;
    int64_t *high = &whole->high[channel_of(film, at)];
    __atomic_fetch_add(high, steps >> 32, __ATOMIC_RELAXED);
}

/* steps = floor(steps / 2^32) * 2^32 + the rest, for either sign. */
static void fold_round(struct film *film, int64_t *round, size_t begin, size_t end)
{
    for (size_t pixel = begin; pixel < end; pixel++) {
        for (size_t channel = 0; channel < 3; channel++) {
            int64_t *steps = &round[FILM_STRIDE * pixel + channel];
            size_t i = 3 * pixel + channel;
            uint64_t low = (uint64_t)film->low[i] + ((uint64_t)*steps & UINT32_MAX);
            film->high[i] += (*steps >> 32) + (int64_t)(low >> 32);
            film->low[i] = (uint32_t)low;
            *steps = 0;
        }
    }
}

/* Leaves less than a step in the fine sums. */
static void fold_fine(struct film *film, size_t begin, size_t end)
{
    for (size_t i = 3 * begin; i < 3 * end; i++) {
        int64_t carry = fine_carry(film->fine[i]);
        if (carry == 0)
            continue;
        film->fine[i] -= carry * (INT64_C(1) << FILM_FINE_BITS);
        film->round[i / 3 * FILM_STRIDE + i % 3] += carry;
    }
}

static void fold_row(void *ctx, long y, int thread)
{
    (void)thread;
    struct film *film = ctx;
    size_t begin = (size_t)y * (size_t)film->width, end = begin + (size_t)film->width;
    fold_fine(film, begin, end);
    fold_round(film, film->round, begin, end);
    for (int i = 0; i < film->lane_count; i++)
        fold_round(film, film->lanes[i].round, begin, end);
}

void film_fold(struct film *film, int threads)
{
    par_for(film->height, threads, fold_row, film);
}

int64_t film_saturated(const struct film *film)
{
    int64_t sum = film->saturated;
    for (int i = 0; i < film->lane_count; i++)
        sum += film->lanes[i].saturated;
    return sum;
}

/* The high part is exact in a double up to 2^53 (2^49 units), so only the sum rounds. */
static double channel_value(const struct film *film, size_t i)
{
    double fine = ldexp((double)film->fine[i], -FILM_FINE_BITS);
    return ((double)film->high[i] * 0x1p32 + ((double)film->low[i] + fine)) / FILM_ONE;
}

struct rgb film_value(const struct film *film, int pixel)
{
    size_t i = 3 * (size_t)pixel;
    return rgb(channel_value(film, i), channel_value(film, i + 1),
               channel_value(film, i + 2));
}

exact_sum film_exact(const struct film *film, int pixel, int channel)
{
    size_t i = 3 * (size_t)pixel + (size_t)channel;
    exact_sum steps = exact_add(exact_times(film->high[i], INT64_C(1) << 32),
                                film->low[i]);
    return exact_add(exact_times(steps, INT64_C(1) << FILM_FINE_BITS), film->fine[i]);
}

void film_scale(struct film *film, double factor)
{
    for (size_t i = 0; i < 3 * film_pixels(film); i++) {
        double steps = rint(channel_value(film, i) * factor * FILM_ONE);
        double high = floor(steps * 0x1p-32);
        film->high[i] = (int64_t)high;
        film->low[i] = (uint32_t)(steps - high * 0x1p32);
        film->fine[i] = 0;
    }
}

/* Moves what the sums of two lower words carry. */
static void add_low(struct film *film, const uint32_t *low)
{
    for (size_t i = 0; i < 3 * film_pixels(film); i++) {
        film->high[i] += film->low[i] > UINT32_MAX - low[i];
        film->low[i] += low[i];
    }
}

static void pack_low(struct pack *pack, struct film *film)
{
    size_t values = 3 * film_pixels(film);
    if (!pack_adds(pack)) {
        pack_uint32s(pack, "low", film->low, values);
        return;
    }
    uint32_t *low = mem_alloc(values, sizeof *low);
    pack_uint32s(pack, "low", low, values);
    add_low(film, low);
    mem_free(low);
}

void film_pack(struct pack *pack, struct film *film)
{
    size_t values = 3 * film_pixels(film);
    int64_t saturated = film_saturated(film);
    pack_sum_int64s(pack, "saturated", &saturated, 1);
    pack_sum_int64s(pack, "high", film->high, values);
    pack_low(pack, film);
    pack_sum_int64s(pack, "fine", film->fine, values);
    if (pack_reads(pack))
        film->saturated = saturated;
}
