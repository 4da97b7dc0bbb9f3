#include "image/film.h"

#include "base/mem.h"
#include "base/pack.h"

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
    film->steps = mem_take(plan, CACHE_LINE, FILM_STRIDE * pixels, sizeof *film->steps);
    film->high = mem_take(plan, 0, 3 * pixels, sizeof *film->high);
    film->fine = mem_take(plan, 0, 3 * pixels, sizeof *film->fine);
    film->rows = mem_take(plan, 0, (size_t)film->height, sizeof *film->rows);
}

static void lane_array(struct film *lane, struct mem_plan *plan)
{
    lane->steps = mem_take(plan, CACHE_LINE, FILM_STRIDE * film_pixels(lane),
                           sizeof *lane->steps);
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
    for (int i = 1; i < film->lane_count; i++)
        mem_free(film->lanes[i].steps);
    mem_free(film->lanes);
    mem_free(film->steps);
    mem_free(film->high);
    mem_free(film->fine);
    mem_free(film->rows);
    mem_free(film);
}

double film_bytes(int width, int height)
{
    struct mem_plan plan = {.take = false};
    film_arrays(&(struct film){.width = width, .height = height}, &plan);
    return plan.bytes;
}

double film_rare_bytes(int width, int height)
{
    return (double)width * height * 2 * 3 * sizeof(int64_t);
}

double film_lanes_bytes(int width, int height, int threads)
{
    struct mem_plan plan = {.take = false};
    lane_array(&(struct film){.width = width, .height = height}, &plan);
    return plan.bytes * (threads - 1); /* the first one is the film's own */
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
        if (i == 0)
            film->lanes[i].steps = film->steps;
        else
            lane_array(&film->lanes[i], &(struct mem_plan){.take = true});
    }
}

void film_clear(struct film *film)
{
    size_t pixels = film_pixels(film);
    memset(film->steps, 0, FILM_STRIDE * pixels * sizeof *film->steps);
    memset(film->high, 0, 3 * pixels * sizeof *film->high);
    memset(film->fine, 0, 3 * pixels * sizeof *film->fine);
    memset(film->rows, 0, (size_t)film->height * sizeof *film->rows);
    film->saturated = 0;
    for (int i = 0; i < film->lane_count; i++) {
        memset(film->lanes[i].steps, 0, FILM_STRIDE * pixels * sizeof *film->steps);
        film->lanes[i].saturated = 0;
    }
}

static ptrdiff_t channel_of(const struct film *film, const int64_t *at)
{
    ptrdiff_t place = at - film->steps;
    return place / FILM_STRIDE * 3 + place % FILM_STRIDE;
}

/* Notes that the row of a channel has sums of this kind. */
static void mark_row(struct film *whole, int64_t channel, enum film_row kind)
{
    uint8_t *row = &whole->rows[channel / 3 / whole->width];
    if (!(__atomic_load_n(row, __ATOMIC_RELAXED) & (uint8_t)kind))
        __atomic_fetch_or(row, (uint8_t)kind, __ATOMIC_RELAXED);
}

/* The whole steps of a fine sum. */
static int64_t fine_carry(int64_t fine)
{
    return fine >> FILM_FINE_BITS;
}

/* A small splat is at most 2^52 fine steps, so a sum beyond 2^60 is rare; its whole steps
 * are returned. The thread that finds the sum takes them, exactly once. */
static int64_t add_small(struct film *whole, ptrdiff_t channel, double steps)
{
    double exact = steps * (double)(INT64_C(1) << FILM_FINE_BITS);
    int64_t fine = (int64_t)(exact + copysign(0.5, exact)), *at = &whole->fine[channel];
    int64_t sum = __atomic_add_fetch(at, fine, __ATOMIC_RELAXED);
    mark_row(whole, channel, FILM_ROW_FINE);
    if (sum <= FILM_SPILL && sum >= -FILM_SPILL)
        return 0;
    int64_t carry = fine_carry(sum);
    __atomic_fetch_sub(at, carry * (INT64_C(1) << FILM_FINE_BITS), __ATOMIC_RELAXED);
    return carry;
}

double film_splat_out_of_range(struct film *film, const int64_t *at, double steps)
{
    struct film *whole = film->whole ? film->whole : film;
    if (fabs(steps) < FILM_SMALL) /* exact: a carry is below 2^26 */
        return (double)add_small(whole, channel_of(film, at), steps);
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
    ptrdiff_t channel = channel_of(film, at);
    mark_row(whole, channel, FILM_ROW_HIGH);
    __atomic_fetch_add(&whole->high[channel], steps >> 32, __ATOMIC_RELAXED);
}

int64_t film_saturated(const struct film *film)
{
    int64_t sum = film->saturated;
    for (int i = 0; i < film->lane_count; i++)
        sum += film->lanes[i].saturated;
    return sum;
}

/* Adds steps = floor(steps / 2^32) * 2^32 + the rest, for either sign. */
static void add_steps(struct film_sum *sum, int64_t steps)
{
    uint64_t low = (uint64_t)sum->low + ((uint64_t)steps & UINT32_MAX);
    sum->high += (steps >> 32) + (int64_t)(low >> 32);
    sum->low = (uint32_t)low;
}

static inline struct film_sum channel_sum(const struct film *film, int pixel, int channel,
                                          uint8_t row)
{
    int64_t at = FILM_STRIDE * (int64_t)pixel + channel;
    int64_t index = 3 * (int64_t)pixel + channel;
    int64_t fine = row & FILM_ROW_FINE ? film->fine[index] : 0, carry = fine_carry(fine);
    struct film_sum sum = {row & FILM_ROW_HIGH ? film->high[index] : 0, 0,
                           fine - carry * (INT64_C(1) << FILM_FINE_BITS)};
    add_steps(&sum, carry);
    add_steps(&sum, film->steps[at]);
    for (int i = 1; i < film->lane_count; i++)
        add_steps(&sum, film->lanes[i].steps[at]);
    return sum;
}

struct film_sum film_channel(const struct film *film, int pixel, int channel)
{
    return channel_sum(film, pixel, channel, film->rows[pixel / film->width]);
}

/* The high part is exact in a double up to 2^53 (2^49 units), so only the sum rounds. */
static inline double sum_value(struct film_sum sum)
{
    double fine = (double)sum.fine * (1.0 / (double)(INT64_C(1) << FILM_FINE_BITS));
    return ((double)sum.high * 0x1p32 + ((double)sum.low + fine)) / FILM_ONE;
}

struct rgb film_value(const struct film *film, int pixel)
{
    uint8_t row = film->rows[pixel / film->width];
    return rgb(sum_value(channel_sum(film, pixel, 0, row)),
               sum_value(channel_sum(film, pixel, 1, row)),
               sum_value(channel_sum(film, pixel, 2, row)));
}

/* All sums in arrays, for a checkpoint: it does not tell how many lanes there were. */
struct film_sums {
    int64_t *high, *fine; /* [height*width][3] */
    uint32_t *low;
};

static void sums_init(struct film_sums *sums, size_t values)
{
    sums->high = mem_alloc(values, sizeof *sums->high);
    sums->low = mem_alloc(values, sizeof *sums->low);
    sums->fine = mem_alloc(values, sizeof *sums->fine);
}

static void sums_deinit(struct film_sums *sums)
{
    mem_free(sums->high);
    mem_free(sums->low);
    mem_free(sums->fine);
}

static void sums_from_film(struct film_sums *sums, const struct film *film)
{
    for (size_t i = 0; i < 3 * film_pixels(film); i++) {
        struct film_sum sum = film_channel(film, (int)(i / 3), (int)(i % 3));
        sums->high[i] = sum.high;
        sums->low[i] = sum.low;
        sums->fine[i] = sum.fine;
    }
}

/* Sums of a damaged file may wrap. */
static void add_to(int64_t *sum, int64_t value)
{
    *sum = (int64_t)((uint64_t)*sum + (uint64_t)value);
}

/* These add to a channel; what is 0 is not added: the memory stays untouched. */
static void add_high(void *ctx, size_t i, int64_t value)
{
    struct film *film = ctx;
    add_to(&film->high[i], value);
    mark_row(film, (int64_t)i, FILM_ROW_HIGH);
}

static void add_low(void *ctx, size_t i, int64_t value)
{
    struct film *film = ctx;
    add_to(&film->steps[i / 3 * FILM_STRIDE + i % 3], value);
}

static void add_fine(void *ctx, size_t i, int64_t value)
{
    struct film *film = ctx;
    add_to(&film->fine[i], value);
    mark_row(film, (int64_t)i, FILM_ROW_FINE);
}

static void sums_to_film(const struct film_sums *sums, struct film *film)
{
    for (size_t i = 0; i < 3 * film_pixels(film); i++) {
        add_low(film, i, sums->low[i]);
        if (sums->high[i] != 0)
            add_high(film, i, sums->high[i]);
    }
}

exact_sum film_exact(const struct film *film, int pixel, int channel)
{
    struct film_sum sum = film_channel(film, pixel, channel);
    exact_sum steps = exact_add(exact_times(sum.high, INT64_C(1) << 32), sum.low);
    return exact_add(exact_times(steps, INT64_C(1) << FILM_FINE_BITS), sum.fine);
}

void film_scale(struct film *film, double factor)
{
    size_t values = 3 * film_pixels(film);
    int64_t saturated = film_saturated(film);
    struct film_sums sums;
    sums_init(&sums, values);
    for (size_t i = 0; i < values; i++) {
        struct film_sum sum = film_channel(film, (int)(i / 3), (int)(i % 3));
        double steps = rint(sum_value(sum) * factor * FILM_ONE);
        double high = floor(steps * 0x1p-32);
        sums.high[i] = (int64_t)high;
        sums.low[i] = (uint32_t)(steps - high * 0x1p32);
    }
    film_clear(film);
    film->saturated = saturated;
    sums_to_film(&sums, film);
    sums_deinit(&sums);
}

static void write_sums(struct pack *pack, const struct film *film, size_t values)
{
    struct film_sums sums;
    sums_init(&sums, values);
    sums_from_film(&sums, film);
    pack_int64s(pack, "high", sums.high, values);
    pack_uint32s(pack, "low", sums.low, values);
    pack_int64s(pack, "fine", sums.fine, values);
    sums_deinit(&sums);
}

void film_pack(struct pack *pack, struct film *film)
{
    size_t values = 3 * film_pixels(film);
    int64_t saturated = film_saturated(film);
    pack_sum_int64s(pack, "saturated", &saturated, 1);
    if (!pack_reads(pack)) {
        write_sums(pack, film, values);
        return;
    }
    film->saturated = saturated;
    pack_each_int64(pack, "high", values, add_high, film);
    pack_each_uint32(pack, "low", values, add_low, film);
    pack_each_int64(pack, "fine", values, add_fine, film);
}
