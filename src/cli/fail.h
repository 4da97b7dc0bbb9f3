#ifndef ETALON_CLI_FAIL_H
#define ETALON_CLI_FAIL_H

#include "base/err.h"

/* Prints one line "etalon: error: file:line:col: message" to stderr; returns the exit
 * status: 2 for wrong usage, else 1. */
int fail(const struct err *err);

#endif
