#ifndef ETALON_IMAGE_FILM_H
#define ETALON_IMAGE_FILM_H

/* The film adds integers: splats in a unit given by the caller (b_0 or 1), rounded to
 * 2^-36 of it, in 64-bit atomics. Integer sums are exact and associative, so the result
 * is the same bits for any number of threads. film_fold moves the round's sums into a
 * wider accumulator; between two folds a pixel holds up to 2^26 units. */

#include "math/rgb.h"

#include <math.h>
#include <stdint.h>

#define FILM_ONE         0x1p36 /* integer steps in one unit */
#define FILM_SPLAT_LIMIT 0x1p60 /* a splat beyond this many steps is clamped */

struct film {
    int width, height;
    int64_t *round; /* [height*width][3], since the last fold */
    int64_t *high;  /* [height*width][3], folded: total = high * 2^32 + low */
    int64_t *low;
    int64_t saturated; /* splats clamped or pixels that overflowed; atomic */
};

struct film *film_create(int width, int height);
void film_destroy(struct film *film);
void film_clear(struct film *film);

void film_saturate(struct film *film); /* counts one */

static inline void film_add_channel(struct film *film, int64_t *at, double steps)
{
    if (!(fabs(steps) <= FILM_SPLAT_LIMIT)) {
        film_saturate(film);
        steps = copysign(FILM_SPLAT_LIMIT, steps);
    }
    __atomic_fetch_add(at, llrint(steps), __ATOMIC_RELAXED);
}

/* Adds value * weight (in film units, finite) to a pixel; thread-safe. */
static inline void film_splat(struct film *film, int pixel, struct rgb value,
                              double weight)
{
    int64_t *at = film->round + 3 * (int64_t)pixel;
    double scale = weight * FILM_ONE;
    film_add_channel(film, at, value.r * scale);
    film_add_channel(film, at + 1, value.g * scale);
    film_add_channel(film, at + 2, value.b * scale);
}

/* Not concurrent with film_splat. */
void film_fold(struct film *film, int threads);
/* The pixel's folded sum in film units. */
struct rgb film_value(const struct film *film, int pixel);

#endif
