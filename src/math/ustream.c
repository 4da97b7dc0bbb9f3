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
