#ifndef ETALON_BASE_ERR_H
#define ETALON_BASE_ERR_H

/* One failure: what went wrong, where, and what would be right. The caller owns it. */

#include <stdbool.h>

enum err_code {
    ERR_NONE = 0,
    ERR_USAGE,       /* the command line or a setting is wrong: exit status 2 */
    ERR_IO,          /* a file cannot be read or written */
    ERR_SYNTAX,      /* a file does not follow its grammar */
    ERR_VALUE,       /* a value is outside its range, NaN, or missing */
    ERR_UNSUPPORTED, /* valid, but not supported here */
    ERR_MEMORY,      /* out of memory */
};

/* A position in a file; line and col count from 1, 0 = unknown. */
struct place {
    const char *file;
    int line, col;
};

struct err {
    enum err_code code;
    int line, col;
    char file[512];
    char message[1024];
};

/* Fills *err (the first failure is kept; err may be NULL) and returns false, so that a
 * fallible function can end with `return err_set(...)`. `at` may be NULL. Control
 * characters and invalid UTF-8 become '?': a failure is one line. */
bool err_set(struct err *err, enum err_code code, const struct place *at,
             const char *format, ...) __attribute__((format(printf, 4, 5)));

/* "file:line:col: message", parts that are unknown left out; text holds size bytes. */
void err_format(const struct err *err, char *text, int size);

#endif
