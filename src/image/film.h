#ifndef ETALON_IMAGE_FILM_H
#define ETALON_IMAGE_FILM_H

/* The film adds integers: splats in a unit given by the caller (b_0 or 1), rounded to
 * 2^-36 of it, in 64 bits. Integer sums are exact and associative, so the result is the
 * same bits for any number of threads. A pixel's sum that reaches 2^24 units is moved to
 * a wide one at once, so that none can overflow (unless seven threads at once add splats
 * of 2^24 units each to the pixel of a film that they share). Splats below 2^-20 of a
 * unit go to a finer sum with steps of 2^-72, so that places with 1e-12 of the radiance
 * of bright ones are resolved too. The wide and the fine sums are touched, and so take
 * memory, only where there are such splats.
 *
 * Threads add atomically to one film, or each without atomics to a lane of its own: an
 * atomic addition stalls the core's pending memory accesses. */

#include "math/exact_sum.h"
#include "math/rgb.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define FILM_ONE         0x1p36 /* integer steps in one unit */
#define FILM_SPLAT_LIMIT 0x1p60 /* a splat beyond this many steps is clamped */
#define FILM_SPILL       (INT64_C(1) << 60)
#define FILM_SMALL       0x1p16 /* steps; a splat below goes to the finer sum */
#define FILM_FINE_BITS   36     /* a step is 2^36 fine ones */
#define FILM_STRIDE      4      /* no pixel lies across two cache lines */
#define FILM_LANES_BYTES 0x1p30 /* more lanes than fit share the film */

struct pack;

/* Rows whose sums are not only in `steps`. Others are not read: reading takes memory too.
 */
enum film_row { FILM_ROW_HIGH = 1, FILM_ROW_FINE = 2 };

struct film {
    int width, height;
    int64_t *steps; /* [height*width][FILM_STRIDE]; the first lane's */
    int64_t *high;  /* [height*width][3], spilled, in 2^32 steps; of all lanes, atomic */
    int64_t *fine;  /* [height*width][3], fine steps; of all lanes, atomic */
    uint8_t *rows;  /* [height]: enum film_row, what of high and fine is not 0; atomic */
    int64_t saturated;  /* splats that were clamped; atomic */
    struct film *whole; /* a lane, to which one thread adds: the film that it is of */
    struct film *lanes; /* [lane_count], their `steps` only */
    int lane_count;
};

/* A channel's sum in its one normal form: high * 2^32 + low steps, and 0 <= fine < 2^36
 * fine ones. */
struct film_sum {
    int64_t high;
    uint32_t low;
    int64_t fine;
};

struct film *film_create(int width, int height);
/* Memory: of a film without lanes; the part of it (wide and fine sums) that is touched
 * only where splats are very large or small; and of lanes for `threads` threads. */
double film_bytes(int width, int height);
double film_rare_bytes(int width, int height);
double film_lanes_bytes(int width, int height, int threads);
void film_destroy(struct film *film);
void film_clear(struct film *film);

/* Gives each of `threads` threads a lane, if this many bytes hold them. */
void film_add_lanes(struct film *film, int threads, double bytes);
/* The film that this thread splats on: its lane, or the shared film. */
static inline struct film *film_lane(struct film *film, int thread)
{
    return film->lanes ? &film->lanes[thread] : film;
}

/* What film_add_channel does outside the usual range of splats.
 * film_splat_out_of_range: below FILM_SMALL it adds the splat to the fine sum and returns
 * what this carries over, mostly 0; beyond FILM_SPLAT_LIMIT it counts a saturated splat
 * and returns the limit with the sign of steps, or 0 for a NaN. film_spill moves a
 * channel's sum into the wide one. */
double film_splat_out_of_range(struct film *film, const int64_t *at, double steps);
void film_spill(struct film *film, int64_t *at);

/* A splat is at most 2^60 steps, and a sum beyond 2^60 is moved at once: no sum of one
 * thread can pass 2^63. */
static inline void film_add_channel(struct film *film, int64_t *at, double steps)
{
    double size = fabs(steps);
    if (!(size <= FILM_SPLAT_LIMIT && size >= FILM_SMALL)) {
        if (size == 0.0)
            return;
        steps = film_splat_out_of_range(film, at, steps);
    }
    int64_t rounded = (int64_t)(steps + copysign(0.5, steps));
    int64_t before;
    if (film->whole) {
        before = *at;
        *at = before + rounded;
    } else {
        before = __atomic_fetch_add(at, rounded, __ATOMIC_RELAXED);
    }
    if (before > FILM_SPILL || before < -FILM_SPILL)
        film_spill(film, at);
}

/* Adds value * weight (in film units, finite) to a pixel; thread-safe but on a lane. */
static inline void film_splat(struct film *film, int pixel, struct rgb value,
                              double weight)
{
    int64_t *at = film->steps + FILM_STRIDE * (int64_t)pixel;
    double scale = weight * FILM_ONE;
    film_add_channel(film, at, value.r * scale);
    film_add_channel(film, at + 1, value.g * scale);
    film_add_channel(film, at + 2, value.b * scale);
}

/* Prefetches the cache line of a pixel that will be splatted on soon. */
static inline void film_prefetch(const struct film *film, int pixel)
{
    __builtin_prefetch(film->steps + FILM_STRIDE * (int64_t)pixel, 1);
}

/* Splats clamped so far, lanes included. */
int64_t film_saturated(const struct film *film);
/* Sum of a pixel's channel, and the pixel's value in film units, rounded once. Not
 * concurrent with film_splat. */
struct film_sum film_channel(const struct film *film, int pixel, int channel);
struct rgb film_value(const struct film *film, int pixel);
/* The exact sum of one channel, in steps of 2^-72 of a unit. */
exact_sum film_exact(const struct film *film, int pixel, int channel);
/* Multiplies all sums, rounded to a step. */
void film_scale(struct film *film, double factor);
/* To or from a checkpoint (base/pack.h); read into a film of the same size, without
 * splats unless the pack adds. */
void film_pack(struct pack *pack, struct film *film);

#endif
