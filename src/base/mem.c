#include "base/mem.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define HUGE_PAGE ((size_t)2 << 20)

static _Noreturn void out_of_memory(size_t count, size_t size)
{
    fprintf(stderr, "etalon: out of memory (%zu x %zu bytes)\n", count, size);
    exit(1);
}

/* At least one byte, so that an empty array has an address of its own. */
static size_t checked_bytes(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > PTRDIFF_MAX)
        out_of_memory(count, size);
    return bytes ? bytes : 1;
}

void *mem_alloc(size_t count, size_t size)
{
    void *p = calloc(1, checked_bytes(count, size));
    if (!p)
        out_of_memory(count, size);
    return p;
}

void *mem_aligned(size_t align, size_t count, size_t size)
{
    size_t bytes = checked_bytes(count, size);
    if (align < sizeof(void *))
        align = sizeof(void *);
    bool huge = bytes >= HUGE_PAGE;
    if (huge && align < HUGE_PAGE)
        align = HUGE_PAGE;
    void *p;
    if (posix_memalign(&p, align, bytes) != 0)
        out_of_memory(count, size);
    if (huge) /* a wish: where it is refused, all is as before */
        madvise(p, bytes, MADV_HUGEPAGE);
    memset(p, 0, bytes);
    return p;
}

void *mem_resize(void *p, size_t count, size_t size)
{
    void *moved = realloc(p, checked_bytes(count, size));
    if (!moved)
        out_of_memory(count, size);
    return moved;
}

void mem_free(void *p)
{
    free(p);
}

void *mem_grow(void *p, size_t *capacity, size_t need, size_t size)
{
    if (need <= *capacity)
        return p;
    size_t grown = *capacity < 8 ? 8 : *capacity;
    while (grown < need)
        grown = grown > SIZE_MAX / 2 ? need : grown * 2;
    p = mem_resize(p, grown, size);
    *capacity = grown;
    return p;
}
