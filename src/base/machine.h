#ifndef ETALON_BASE_MACHINE_H
#define ETALON_BASE_MACHINE_H

/* The machine, without names of hosts or people. */

#include <stddef.h>

/* The processor's name as the system gives it, zero-terminated and cut to size; "unknown"
 * if it gives none. */
void machine_cpu_model(char *name, size_t size);

/* Memory that can still be allocated, in bytes: what the system calls available, or less
 * if a control group (v2) or the limit of address space allows less. INFINITY if unknown.
 */
double machine_memory_available(void);
/* Resident memory of this process, in bytes (VmRSS). */
double machine_memory_now(void);
/* The most that this process had in memory at once so far, in bytes (VmHWM). */
double machine_memory_peak(void);

#endif
