#include "base/par.h"

#include <omp.h>

int par_threads_available(void)
{
    return omp_get_max_threads();
}

int par_threads(long wanted)
{
    return wanted > 0 ? (int)wanted : par_threads_available();
}

void par_for(long count, int threads, void (*body)(void *ctx, long index, int thread),
             void *ctx)
{
    if (threads <= 1 || count <= 1) {
        for (long i = 0; i < count; i++)
            body(ctx, i, 0);
        return;
    }
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (long i = 0; i < count; i++)
        body(ctx, i, omp_get_thread_num());
}
