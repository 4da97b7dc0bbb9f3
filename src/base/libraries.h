#ifndef ETALON_BASE_LIBRARIES_H
#define ETALON_BASE_LIBRARIES_H

/* What libraries read from the environment when they are loaded.
 *
 * OpenMP: by default, threads that wait at the end of a loop spin for milliseconds, which
 * on a busy machine is a third of all CPU time and is counted as ours.
 * malloc (glibc): huge pages, where the system leaves them to those who ask. Embree's
 * trees lie on the heap, and each ray visits many places of them. */

/* Must be called first in a program, which executes itself again with these settings. One
 * whose environment already says how threads wait is left as it is, so that a debugger
 * need not follow it. */
void libraries_prepare(char *const *argv);

#endif
