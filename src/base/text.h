#ifndef ETALON_BASE_TEXT_H
#define ETALON_BASE_TEXT_H

/* Small string helpers. What returns char * is owned by the caller (mem_free). */

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>

char *text_copy(const char *s);
char *text_copy_n(const char *s, size_t n);
char *text_format(const char *format, ...) __attribute__((format(printf, 1, 2)));
bool text_equal(const char *a, const char *b);
bool text_ends_with(const char *s, const char *ending); /* ASCII case ignored */

/* The whole of s as a finite number ("1e-3"); no trailing characters, no nan, no inf. */
bool text_to_double(const char *s, double *value);
bool text_to_long(const char *s, long *value);

char *text_directory(const char *path); /* "a/b.c" -> "a", "b.c" -> "." */
char *text_join(const char *directory, const char *path); /* absolute path stays */

/* The candidate (NULL-terminated list) nearest to s by edit distance, NULL if none is
 * near enough to be a likely misspelling: for "did you mean". */
const char *text_nearest(const char *s, const char *const *candidates);

/* A regular file to read: its descriptor and size; -1 after an error. A directory, a FIFO
 * or a missing file is an error that names `at` (who asked for it; may be NULL). */
int text_open_file(const char *path, size_t *size, const struct place *at,
                   struct err *err);
/* Whole file into memory, zero-terminated; *size without the zero. Fails as
 * text_open_file.
 */
char *text_read_file(const char *path, size_t *size, const struct place *at,
                     struct err *err);

/* Skips the byte order mark that some editors put before UTF-8. */
const char *text_skip_mark(const char *text);

/* Whether two paths are the same file, existing or not; links are followed. Never true
 * for devices and pipes, which can have two writers. */
bool text_same_file(const char *a, const char *b);

/* Completes a temporary file and renames it: syncs the data to the disk before it
 * replaces an older file, and then the folder's entry. Closes fd. False, and errno, on
 * failure; the temporary file may remain. */
bool text_commit_file(int fd, const char *temporary, const char *path);
/* Writes to a temporary file and commits it: a partial file is never left, even after a
 * power failure. */
bool text_write_file(const char *path, const char *data, size_t size, struct err *err);

/* A growing string. Zero-initialise; release data with mem_free. */
struct text {
    char *data;
    size_t length, capacity;
};
void text_append(struct text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
