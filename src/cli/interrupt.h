#ifndef ETALON_CLI_INTERRUPT_H
#define ETALON_CLI_INTERRUPT_H

#include <signal.h>

/* Installs handlers: the first SIGINT or SIGTERM sets the returned flag; a second one
 * ends the process as usual. */
const volatile sig_atomic_t *interrupt_install(void);

#endif
