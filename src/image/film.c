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

struct film *film_create(int width, int height)
{
    struct film *film = mem_alloc(1, sizeof *film);
    film->width = width;
    film->height = height;
    size_t pixels = film_pixels(film);
    film->round = mem_aligned(CACHE_LINE, FILM_STRIDE * pixels, sizeof *film->round);
    film->high = mem_alloc(3 * pixels, sizeof *film->high);
    film->low = mem_alloc(3 * pixels, sizeof *film->low);
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
    mem_free(film);
}

double film_bytes(int width, int height)
{
    return (double)width * height *
           ((FILM_STRIDE + 3) * sizeof(int64_t) + 3 * sizeof(uint32_t));
}

double film_lanes_bytes(int width, int height, int threads)
{
    return (double)width * height * FILM_STRIDE * sizeof(int64_t) * threads;
}

void film_add_lanes(struct film *film, int threads, double bytes)
{
    size_t numbers = FILM_STRIDE * film_pixels(film);
    if (film->lanes || film_lanes_bytes(film->width, film->height, threads) > bytes)
        return;
    film->lanes = mem_aligned(CACHE_LINE, (size_t)threads, sizeof *film->lanes);
    film->lane_count = threads;
    for (int i = 0; i < threads; i++)
        film->lanes[i] = (struct film){
            .width = film->width,
            .height = film->height,
            .round = mem_aligned(CACHE_LINE, numbers, sizeof *film->round),
            .whole = film,
        };
}

void film_clear(struct film *film)
{
    size_t pixels = film_pixels(film);
    memset(film->round, 0, FILM_STRIDE * pixels * sizeof *film->round);
    memset(film->high, 0, 3 * pixels * sizeof *film->high);
    memset(film->low, 0, 3 * pixels * sizeof *film->low);
    film->saturated = 0;
    for (int i = 0; i < film->lane_count; i++) {
        memset(film->lanes[i].round, 0, FILM_STRIDE * pixels * sizeof *film->round);
        film->lanes[i].saturated = 0;
    }
}

double film_clamp(struct film *film, double steps)
{
    __atomic_fetch_add(&film->saturated, 1, __ATOMIC_RELAXED);
    return isnan(steps) ? 0.0 : copysign(FILM_SPLAT_LIMIT, steps);
}

/* The lower 32 bits stay, so that only one word of the wide sum changes. Whoever finds
 * the sum beyond the limit takes it, once. */
void film_spill(struct film *film, int64_t *at)
{
    int64_t steps = __atomic_load_n(at, __ATOMIC_RELAXED);
    do {
        if (steps <= FILM_SPILL && steps >= -FILM_SPILL)
            return;
    } while (!__atomic_compare_exchange_n(at, &steps, steps & UINT32_MAX, false,
                                          __ATOMIC_RELAXED, __ATOMIC_RELAXED));
    ptrdiff_t place = at - film->round;
    struct film *whole = film->whole ? film->whole : film;
    int64_t *high = &whole->high[place / FILM_STRIDE * 3 + place % FILM_STRIDE];
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

static void fold_row(void *ctx, long y, int thread)
{
    (void)thread;
    struct film *film = ctx;
    size_t begin = (size_t)y * (size_t)film->width, end = begin + (size_t)film->width;
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
    return ((double)film->high[i] * 0x1p32 + (double)film->low[i]) / FILM_ONE;
}

struct rgb film_value(const struct film *film, int pixel)
{
    size_t i = 3 * (size_t)pixel;
    return rgb(channel_value(film, i), channel_value(film, i + 1),
               channel_value(film, i + 2));
}

void film_pack(struct pack *pack, struct film *film)
{
    size_t values = 3 * film_pixels(film);
    int64_t saturated = film_saturated(film);
    pack_int64s(pack, "saturated", &saturated, 1);
    pack_int64s(pack, "high", film->high, values);
    pack_uint32s(pack, "low", film->low, values);
    if (pack_reads(pack))
        film->saturated = saturated;
}
