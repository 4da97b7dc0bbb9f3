#include "cli/interrupt.h"

#include <stddef.h>

/* A signal handler can reach nothing else. */
static volatile sig_atomic_t interrupted;

static void handle(int number)
{
    (void)number;
    interrupted = 1;
}

const volatile sig_atomic_t *interrupt_install(void)
{
    struct sigaction action = {.sa_handler = handle, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    return &interrupted;
}
