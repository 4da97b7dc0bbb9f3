#include "image/contrib.h"

#include "base/mem.h"
#include "base/pack.h"

#include <limits.h>

static void contrib_arrays(struct contrib *c, struct mem_plan *plan)
{
    c->splats = mem_take(plan, MEM_APART, (size_t)c->capacity, sizeof *c->splats);
}

void contrib_init(struct contrib *c, int capacity)
{
    *c = (struct contrib){.capacity = capacity};
    contrib_arrays(c, &(struct mem_plan){.take = true});
}

void contrib_keep_weights(struct contrib *c)
{
    c->weights = mem_alloc((size_t)c->capacity, sizeof *c->weights);
}

void contrib_deinit(struct contrib *c)
{
    mem_free(c->splats);
    mem_free(c->weights);
    *c = (struct contrib){0};
}

double contrib_bytes(int capacity)
{
    struct mem_plan plan = {.take = false};
    contrib_arrays(&(struct contrib){.capacity = capacity}, &plan);
    return plan.bytes;
}

static void pack_splat(struct pack *pack, struct splat *splat, long pixels)
{
    long pixel = splat->pixel;
    int s = splat->s, t = splat->t;
    pack_long(pack, "pixel", &pixel, 0, pixels - 1);
    pack_int(pack, "s", &s, INT16_MIN, INT16_MAX);
    pack_int(pack, "t", &t, INT16_MIN, INT16_MAX);
    pack_double(pack, "r", &splat->value.r);
    pack_double(pack, "g", &splat->value.g);
    pack_double(pack, "b", &splat->value.b);
    splat->pixel = (int32_t)pixel;
    splat->s = (int16_t)s;
    splat->t = (int16_t)t;
}

void contrib_pack(struct pack *pack, struct contrib *c, long pixels)
{
    int failure = (int)c->failure;
    pack_double(pack, "target", &c->target);
    pack_int(pack, "failure", &failure, 0, FAILURES - 1);
    pack_int(pack, "splats", &c->count, 0, c->capacity);
    pack_long(pack, "nonfinite", &c->nonfinite, 0, LONG_MAX);
    for (int i = 0; i < c->count && pack_ok(pack); i++)
        pack_splat(pack, &c->splats[i], pixels);
    c->failure = (enum failure)failure;
}
