#ifndef ETALON_BASE_PAR_H
#define ETALON_BASE_PAR_H

/* The only user of OpenMP: a parallel loop with dynamic scheduling. Results must depend
 * on the index alone, never on the thread; `thread` is for scratch space only. */

int par_threads_available(void);
/* As many as are wanted; 0: all. */
int par_threads(long wanted);

/* Calls body(ctx, index, thread) for index in [0,count), thread in [0,threads). */
void par_for(long count, int threads, void (*body)(void *ctx, long index, int thread),
             void *ctx);

#endif
