#ifndef ETALON_CLI_OUTPUT_H
#define ETALON_CLI_OUTPUT_H

/* Whether a file can be written at the end, asked before the work begins. */

#include "base/err.h"

#include <stdbool.h>

/* Leaves nothing behind. path NULL is fine: nothing is to be written. */
bool output_check(const char *path, struct err *err);

/* A file that a command reads or writes, and what it is to the user: "--stats", "the
 * scene". */
struct output_file {
    const char *what; /* NULL ends a list */
    const char *path; /* NULL: not given */
};

/* Every file that is written is another one, and none that is read. */
bool output_apart(const struct output_file *written, const struct output_file *read,
                  struct err *err);

/* "a/b.exr" -> "a/b.png"; the caller owns it (mem_free). */
char *output_with_ending(const char *path, const char *ending);

#endif
