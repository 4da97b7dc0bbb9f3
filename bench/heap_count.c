/* A shared object for LD_PRELOAD: counts what a program, its libraries included, takes
 * from the heap and gives back. The counts lie in the file that HEAP_COUNT names, mapped
 * and shared (heap_count.h), so that another process reads them at any time and this one
 * has neither a thread nor output more than without. It goes by glibc's own functions. */

#include "heap_count.h"

#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

/* Until the file is mapped: the loader allocates before any constructor has run. */
static struct heap_count own;
static struct heap_count *count = &own;

static void add(_Atomic int64_t *to, int64_t n)
{
    atomic_fetch_add_explicit(to, n, memory_order_relaxed);
}

static void *taken(void *block)
{
    if (block == NULL)
        return NULL;
    add(&count->calls, 1);
    add(&count->blocks, 1);
    add(&count->bytes, (int64_t)malloc_usable_size(block));
    return block;
}

static void given_back(int64_t bytes)
{
    add(&count->blocks, -1);
    add(&count->bytes, -bytes);
}

void *malloc(size_t size)
{
    return taken(__libc_malloc(size));
}

void *calloc(size_t n, size_t size)
{
    return taken(__libc_calloc(n, size));
}

void *memalign(size_t alignment, size_t size)
{
    return taken(__libc_memalign(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return taken(__libc_memalign(alignment, size));
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    void *got = taken(__libc_memalign(alignment, size));
    if (got == NULL)
        return ENOMEM;
    *block = got;
    return 0;
}

/* realloc(block, 0) frees, as glibc's does. */
void *realloc(void *old, size_t size)
{
    int64_t before = (int64_t)malloc_usable_size(old);
    void *block = __libc_realloc(old, size);
    if (old && (block || size == 0))
        given_back(before);
    return taken(block);
}

void free(void *block)
{
    if (block == NULL)
        return;
    given_back((int64_t)malloc_usable_size(block));
    __libc_free(block);
}

__attribute__((constructor)) static void map_file(void)
{
    const char *path = getenv("HEAP_COUNT");
    int fd = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (fd < 0)
        return;
    void *at = mmap(NULL, sizeof own, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (at == MAP_FAILED)
        return;
    memcpy(at, &own, sizeof own);
    count = at;
}
