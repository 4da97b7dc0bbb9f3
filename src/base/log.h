#ifndef ETALON_BASE_LOG_H
#define ETALON_BASE_LOG_H

/* Counted notes: nothing is dropped silently. A note is keyed by its text; a repetition
 * raises its count and keeps the first place. Not thread-safe: one log per loading
 * thread, joined with log_merge. */

#include "base/err.h"

#include <stdio.h>

struct log_note {
    char *text;
    char *file; /* first place; NULL if unknown */
    int line, col;
    long count;
    bool remark; /* about nothing that the scene lacks */
};

struct log {
    struct log_note *notes;
    size_t count, capacity;
};

void log_init(struct log *log);
void log_deinit(struct log *log);
void log_note(struct log *log, const struct place *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The same for what takes nothing from the scene. */
void log_remark(struct log *log, const struct place *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Of the first `count` notes, those that are no remarks. */
size_t log_losses(const struct log *log, size_t count);
/* Prints these, as log_print does. */
void log_print_losses(const struct log *log, size_t count, FILE *out);
void log_merge(struct log *into, const struct log *from);
/* One line a note: "warning: file:line:col: text (N times)". */
void log_print(const struct log *log, FILE *out);

#endif
