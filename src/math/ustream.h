#ifndef ETALON_MATH_USTREAM_H
#define ETALON_MATH_USTREAM_H

/* "Next u": where path code gets its numbers from. A random event asks once for all its
 * numbers, at its fixed place (path/dims.h), so that a number keeps its meaning when the
 * path changes length. Path code does not know whether the numbers come from a Markov
 * chain, a generator or a test. Numbers that were asked for count as used. */

#include "math/rng.h"

struct ustream {
    /* `count` (1..USTREAM_MAX_COUNT) numbers in [0,1) for places [place, place+count);
     * the answer is valid until the next call. */
    const double *(*take)(struct ustream *self, int place, int count);
};

#define USTREAM_MAX_COUNT 8

static inline const double *ustream_take(struct ustream *s, int place, int count)
{
    return s->take(s, place, count);
}

/* The numbers of one path: [Hachisuka14, section 4] keeps the same three streams. */
struct numbers {
    struct ustream *camera, *light, *connect;
};

/* Independent numbers straight from a generator; places are ignored. */
struct ustream_random {
    struct ustream stream; /* must be first */
    struct rng *rng;
    double values[USTREAM_MAX_COUNT];
};

void ustream_random_init(struct ustream_random *s, struct rng *rng);

/* The same, which also counts the random events. */
struct ustream_counted {
    struct ustream stream; /* must be first */
    struct ustream_random inner;
    long *events;
};

void ustream_counted_init(struct ustream_counted *s, struct rng *rng, long *events);

#endif
