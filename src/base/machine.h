#ifndef ETALON_BASE_MACHINE_H
#define ETALON_BASE_MACHINE_H

/* What the program runs on, without names of hosts or people. */

#include <stddef.h>

/* The processor's name as the system gives it, zero-terminated and cut to size; "unknown"
 * if it gives none. */
void machine_cpu_model(char *name, size_t size);

#endif
