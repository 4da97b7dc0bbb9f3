#include "math/ustream.h"

#include <assert.h>

static const double *random_take(struct ustream *self, int place, int count)
{
    struct ustream_random *s = (struct ustream_random *)self;
    (void)place;
    assert(count >= 1 && count <= USTREAM_MAX_COUNT);
    for (int i = 0; i < count; i++)
        s->values[i] = rng_double(s->rng);
    return s->values;
}

void ustream_random_init(struct ustream_random *s, struct rng *rng)
{
    s->stream.take = random_take;
    s->rng = rng;
}

static const double *counted_take(struct ustream *self, int place, int count)
{
    struct ustream_counted *s = (struct ustream_counted *)self;
    ++*s->events;
    return random_take(&s->inner.stream, place, count);
}

void ustream_counted_init(struct ustream_counted *s, struct rng *rng, long *events)
{
    s->stream.take = counted_take;
    ustream_random_init(&s->inner, rng);
    s->events = events;
}
