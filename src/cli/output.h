#ifndef ETALON_CLI_OUTPUT_H
#define ETALON_CLI_OUTPUT_H

/* Whether a file can be written at the end, asked before the work begins. */

#include "base/err.h"

#include <stdbool.h>

/* Leaves nothing behind. path NULL is fine: nothing is to be written. */
bool output_check(const char *path, struct err *err);

/* "a/b.exr" -> "a/b.png"; the caller owns it (mem_free). */
char *output_with_ending(const char *path, const char *ending);

#endif
