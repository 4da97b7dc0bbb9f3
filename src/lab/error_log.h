#ifndef ETALON_LAB_ERROR_LOG_H
#define ETALON_LAB_ERROR_LOG_H

/* Error against time, a CSV file with one row a snapshot. A row is in the file when
 * error_log_append returns, so an interrupted run keeps what it measured. */

#include "base/text.h"
#include "run/run.h"

struct error_log;

/* Replaces an older file and writes the header; NULL on failure. */
struct error_log *error_log_create(const char *path, struct err *err);
bool error_log_append(struct error_log *log, const struct error_row *row,
                      struct err *err);
void error_log_destroy(struct error_log *log);

/* The same lines as text, each with its end. */
void error_log_append_header(struct text *line);
void error_log_append_row(struct text *line, const struct error_row *row);

#endif
