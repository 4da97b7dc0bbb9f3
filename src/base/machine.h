#ifndef ETALON_BASE_MACHINE_H
#define ETALON_BASE_MACHINE_H

/* What the program runs on, without names of hosts or people. */

#include <stddef.h>

/* The processor's name as the system gives it, zero-terminated and cut to size; "unknown"
 * if it gives none. */
void machine_cpu_model(char *name, size_t size);

/* Bytes that may still be taken: what the system calls available, or less where a control
 * group (v2) or the limit of address space leaves less. INFINITY if nothing tells. */
double machine_memory_available(void);
/* What this process has in memory, in bytes (VmRSS). */
double machine_memory_now(void);
/* The most that this process had in memory at once so far, in bytes (VmHWM). */
double machine_memory_peak(void);

#endif
