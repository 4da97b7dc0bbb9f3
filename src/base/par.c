#include "base/par.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

int par_threads_available(void)
{
    return omp_get_max_threads();
}

int par_threads(long wanted)
{
    return wanted > 0 ? (int)wanted : par_threads_available();
}

void par_wait_asleep(char *const *argv)
{
    static const char *const names[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT",
                                        "KMP_BLOCKTIME"};
    for (int i = 0; i < 3; i++)
        if (getenv(names[i]))
            return;
    setenv("GOMP_SPINCOUNT", "1000", 1); /* of gcc's runtime; some tens of microseconds */
    setenv("KMP_BLOCKTIME", "0", 1);     /* clang's */
    execv("/proc/self/exe", argv); /* if that fails, the program runs with the defaults */
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
