#ifndef ETALON_BASE_PAR_H
#define ETALON_BASE_PAR_H

/* The only user of OpenMP: a parallel loop with dynamic scheduling. Results must depend
 * on the index alone, never on the thread; `thread` is for scratch space only. */

int par_threads_available(void);
/* As many as are wanted; 0: all. */
int par_threads(long wanted);

/* Must be called first in a program. By default, threads that wait at the end of a loop
 * spin for milliseconds, which on a busy machine is a third of all CPU time and is
 * counted as ours. OpenMP reads the spin time from the environment when it is loaded, so
 * the program executes itself again with it set, unless the environment sets it already.
 */
void par_wait_asleep(char *const *argv);

/* Calls body(ctx, index, thread) for index in [0,count), thread in [0,threads). */
void par_for(long count, int threads, void (*body)(void *ctx, long index, int thread),
             void *ctx);

#endif
