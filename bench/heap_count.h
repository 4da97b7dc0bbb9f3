#ifndef ETALON_BENCH_HEAP_COUNT_H
#define ETALON_BENCH_HEAP_COUNT_H

#include <stdint.h>

/* What heap_count.c counts, mapped by it and by heap_watch.c. */
struct heap_count {
    _Atomic int64_t bytes;  /* live, as malloc_usable_size has them */
    _Atomic int64_t blocks; /* live */
    _Atomic int64_t calls;  /* of malloc and its kin since the beginning */
};

#endif
