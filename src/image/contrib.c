#include "image/contrib.h"

#include "base/mem.h"

void contrib_init(struct contrib *c, int capacity)
{
    *c = (struct contrib){.capacity = capacity};
    c->splats = mem_aligned(MEM_APART, (size_t)capacity, sizeof *c->splats);
}

void contrib_deinit(struct contrib *c)
{
    mem_free(c->splats);
    *c = (struct contrib){0};
}
