#ifndef ETALON_BASE_RANKS_H
#define ETALON_BASE_RANKS_H

/* Several processes that compute one run: the ranks of MPI, in a program that was built
 * with MPI=1 (the only user of MPI) and started by mpirun. Else there is one. */

#include "base/text.h"

#include <signal.h>

/* Joins the other processes; at the end all of them leave. */
void ranks_begin(void);
void ranks_end(void);
int ranks_own(void); /* from 0 */
int ranks_count(void);

/* Sets *bits to the bits that any rank has set. All ranks must call it. False if another
 * one is gone, or does not come although *stop is set (NULL: never). */
bool ranks_agree(unsigned *bits, const volatile sig_atomic_t *stop);

/* Rank 0 gets the bytes of every other rank, one after the other, by take(), which
 * returns false on failure; the rest are received all the same. All ranks must call it.
 */
typedef bool (*ranks_take)(void *ctx, int rank, const struct text *bytes);
bool ranks_gather(const struct text *own, ranks_take take, void *ctx);

#endif
