#ifndef ETALON_BASE_MEM_H
#define ETALON_BASE_MEM_H

/* Heap memory. Exhaustion ends the process with one line on stderr and status 1 (nothing
 * that is asked for comes unchecked from a file header: readers check counts against the
 * file's size first), unless there is a reserve. Release everything with mem_free;
 * mem_free(NULL) is legal. */

#include <stdbool.h>
#include <stddef.h>

/* What different threads write must lie this far apart: two cache lines, for they are
 * fetched in pairs. */
#define MEM_APART 128

void *mem_alloc(size_t count, size_t size); /* zeroed; overflow-checked */
/* Zeroed; align: a power of 2. What takes megabytes lies on huge pages, if the system has
 * some: splats go anywhere, and the processor knows few pages by heart. */
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

/* Sets memory aside, which is not touched, for what must not fail. The first allocation
 * that fails releases it and is tried again; mem_exhausted tells of that until the next
 * mem_reserve, and the caller is to come to an end with what was released. One for the
 * whole process. False if there is not as much. */
bool mem_reserve(size_t bytes);
void mem_release_reserve(void); /* to be used; legal without one */
bool mem_exhausted(void);

/* Makes room for `need` elements, doubling *capacity; returns the (moved) array. */
void *mem_grow(void *p, size_t *capacity, size_t need, size_t size);

#endif
