#include "base/mem.h"

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define HUGE_PAGE ((size_t)2 << 20)

/* Any thread can run out of memory in any function, so this state is global. */
static struct {
    void *block;
    size_t bytes;
    bool exhausted;
} reserve;

/* _exit, not exit: other threads may be running, and exit handlers would destroy their
 * data.
 */
static _Noreturn void out_of_memory(size_t count, size_t size)
{
    fprintf(stderr, "etalon: out of memory (%zu x %zu bytes)\n", count, size);
    fflush(stdout);
    _exit(1);
}

static bool release(void)
{
    void *block = __atomic_exchange_n(&reserve.block, NULL, __ATOMIC_ACQ_REL);
    if (block)
        munmap(block, reserve.bytes);
    return block != NULL;
}

bool mem_reserve(size_t bytes)
{
    release();
    __atomic_store_n(&reserve.exhausted, false, __ATOMIC_RELEASE);
    void *block = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS,
                       -1, 0);
    if (block == MAP_FAILED)
        return false;
    reserve.bytes = bytes;
    __atomic_store_n(&reserve.block, block, __ATOMIC_RELEASE);
    return true;
}

void mem_release_reserve(void)
{
    release();
}

bool mem_exhausted(void)
{
    return __atomic_load_n(&reserve.exhausted, __ATOMIC_ACQUIRE);
}

/* True if the allocation may succeed now: another thread may have released the reserve.
 * Under a lock, so that no thread sees neither the reserve nor its memory. */
static bool make_room(void)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    if (release())
        __atomic_store_n(&reserve.exhausted, true, __ATOMIC_RELEASE);
    pthread_mutex_unlock(&lock);
    return mem_exhausted();
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
    size_t bytes = checked_bytes(count, size);
    void *p = calloc(1, bytes);
    if (!p && make_room())
        p = calloc(1, bytes);
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
    if (posix_memalign(&p, align, bytes) != 0 &&
        (!make_room() || posix_memalign(&p, align, bytes) != 0))
        out_of_memory(count, size);
    if (huge) /* a hint: if it is refused, nothing changes */
        madvise(p, bytes, MADV_HUGEPAGE);
    memset(p, 0, bytes);
    return p;
}

void *mem_take(struct mem_plan *plan, size_t align, size_t count, size_t size)
{
    plan->bytes += (double)count * (double)size;
    if (!plan->take)
        return NULL;
    return align > 0 ? mem_aligned(align, count, size) : mem_alloc(count, size);
}

void *mem_resize(void *p, size_t count, size_t size)
{
    size_t bytes = checked_bytes(count, size);
    void *moved = realloc(p, bytes);
    if (!moved && make_room())
        moved = realloc(p, bytes);
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
