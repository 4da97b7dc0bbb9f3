#ifndef ETALON_BASE_MEM_H
#define ETALON_BASE_MEM_H

/* Heap memory. Exhaustion ends the process with one line on stderr and status 1 (nothing
 * that is asked for comes unchecked from a file header: readers check counts against the
 * file's size first), unless there is a reserve. Release everything with mem_free;
 * mem_free(NULL) is legal. */

#include <stdbool.h>
#include <stddef.h>

/* Least distance of data that different threads write: two cache lines, as they are
 * fetched in pairs. */
#define MEM_APART 128

void *mem_alloc(size_t count, size_t size); /* zeroed; overflow-checked */
/* Zeroed; align: a power of 2. Blocks of megabytes lie on huge pages if the system has
 * some: splats go to random addresses, and the TLB holds few pages. */
void *mem_aligned(size_t align, size_t count, size_t size);
/* The arrays of a module, written down once for two uses: its constructor takes them, and
 * its forecast sums their bytes without taking any. The function that names them calls
 * mem_take for each, which returns NULL while bytes are only summed. align: 0, or as for
 * mem_aligned. */
struct mem_plan {
    bool take;
    double bytes;
};
void *mem_take(struct mem_plan *plan, size_t align, size_t count, size_t size);
void *mem_resize(void *p, size_t count, size_t size); /* new tail not zeroed */
void mem_free(void *p);

/* Reserves memory, without touching it, for work that must not fail. The first allocation
 * that fails releases the reserve and is repeated; mem_exhausted returns true until the
 * next mem_reserve, and the caller must finish with what was released. One reserve for
 * the whole process. False if there is not enough memory. */
bool mem_reserve(size_t bytes);
void mem_release_reserve(void); /* so that it can be used; legal without one */
bool mem_exhausted(void);

/* Makes room for `need` elements, doubling *capacity; returns the (moved) array. */
void *mem_grow(void *p, size_t *capacity, size_t need, size_t size);

#endif
