#ifndef ETALON_CLI_OUTPUT_H
#define ETALON_CLI_OUTPUT_H

/* Whether a file can be written at the end, asked before the work begins. */

#include "base/err.h"

#include <stdbool.h>

/* Checks whether the file can be written; creates nothing. path NULL passes. */
bool output_check(const char *path, struct err *err);

/* A file that a command reads or writes, with its name in messages: "--stats", "the
 * scene". */
struct output_file {
    const char *what; /* NULL ends a list */
    const char *path; /* NULL: not given */
};

/* Checks that no two written files are the same, and that none of them is read. */
bool output_apart(const struct output_file *written, const struct output_file *read,
                  struct err *err);

/* "a/b.exr" -> "a/b.png"; the caller owns it (mem_free). */
char *output_with_ending(const char *path, const char *ending);

#endif
