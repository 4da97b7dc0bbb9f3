#ifndef ETALON_IMAGE_FILM_H
#define ETALON_IMAGE_FILM_H

/* The film adds integers: splats in a unit given by the caller (b_0 or 1), rounded to
 * 2^-36 of it, in 64 bits. Integer sums are exact and associative, so the result is the
 * same bits for any number of threads. film_fold moves the round's sums into a wider
 * accumulator; between two folds a pixel holds up to 2^26 units.
 *
 * Threads add atomically to one film, or each without atomics to a lane of its own, which
 * the fold collects: a locked addition waits for all that the core has under way. */

#include "math/rgb.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define FILM_ONE         0x1p36 /* integer steps in one unit */
#define FILM_SPLAT_LIMIT 0x1p60 /* a splat beyond this many steps is clamped */
#define FILM_FULL        (INT64_C(1) << 62)
#define FILM_STRIDE      4      /* no pixel lies across two cache lines */
#define FILM_LANES_BYTES 0x1p30 /* more lanes than fit share the film */

struct film {
    int width, height;
    int64_t *round;     /* [height*width][FILM_STRIDE], steps since the last fold */
    int64_t *high;      /* [height*width][3], folded: steps = high * 2^32 + low */
    uint32_t *low;      /* [height*width][3] */
    int64_t saturated;  /* splats that were clamped or met a full pixel; atomic */
    bool exclusive;     /* a lane: one thread adds */
    struct film *lanes; /* [lane_count], their `round` only */
    int lane_count;
};

struct film *film_create(int width, int height);
/* What one takes, without lanes. */
double film_bytes(int width, int height);
void film_destroy(struct film *film);
void film_clear(struct film *film);

/* Gives each of `threads` threads a lane, if this many bytes hold them. */
void film_add_lanes(struct film *film, int threads, double bytes);
/* What this thread shall splat on: its lane, or the film that all share. */
static inline struct film *film_lane(struct film *film, int thread)
{
    return film->lanes ? &film->lanes[thread] : film;
}

/* The rare cases: count one; film_clamp returns the limit with the sign of steps, 0 for
 * a NaN. */
void film_saturate(struct film *film);
double film_clamp(struct film *film, double steps);

/* A splat is at most 2^60 steps, so no sum can pass 2^63 unseen: it was beyond
 * FILM_FULL before. */
static inline void film_add_channel(struct film *film, int64_t *at, double steps)
{
    if (!(fabs(steps) <= FILM_SPLAT_LIMIT))
        steps = film_clamp(film, steps);
    int64_t rounded = (int64_t)(steps + copysign(0.5, steps));
    int64_t before;
    if (film->exclusive) {
        before = *at;
        *at = before + rounded;
    } else {
        before = __atomic_fetch_add(at, rounded, __ATOMIC_RELAXED);
    }
    if (before > FILM_FULL || before < -FILM_FULL)
        film_saturate(film);
}

/* Adds value * weight (in film units, finite) to a pixel; thread-safe but on a lane. */
static inline void film_splat(struct film *film, int pixel, struct rgb value,
                              double weight)
{
    int64_t *at = film->round + FILM_STRIDE * (int64_t)pixel;
    double scale = weight * FILM_ONE;
    film_add_channel(film, at, value.r * scale);
    film_add_channel(film, at + 1, value.g * scale);
    film_add_channel(film, at + 2, value.b * scale);
}

/* Tells the memory that a pixel will be splatted on before long. */
static inline void film_expect(const struct film *film, int pixel)
{
    __builtin_prefetch(film->round + FILM_STRIDE * (int64_t)pixel, 1);
}

/* Moves the round's sums into the wide ones. Not concurrent with film_splat. */
void film_fold(struct film *film, int threads);
/* The pixel's folded sum in film units, rounded once. */
struct rgb film_value(const struct film *film, int pixel);

#endif
