#ifndef ETALON_LAB_CSV_H
#define ETALON_LAB_CSV_H

/* Tables of text with a header line (RFC 4180): a cell with a comma, a quote or a line
 * break in it stands in quotes, and quotes within are doubled. */

#include "base/text.h"

/* Appends to a line: a comma unless it is the line's first cell, and the cell. */
void csv_append(struct text *line, const char *value);
/* ".nan" for NaN; else digits that read back as the same number. */
void csv_append_number(struct text *line, double value);

struct csv {
    char *path;
    char **cells; /* [rows][columns], the header is row 0 */
    size_t cell_count, cell_capacity;
    size_t rows, columns;
    /* Bytes up to the end of the last whole line. What follows was being written when the
     * writer died, and is no row. */
    size_t whole;
};

/* NULL on failure; a row of another length than the header is an error with its line. */
struct csv *csv_read(const char *path, struct err *err);
void csv_destroy(struct csv *csv);

/* The column of that name, or -1. */
int csv_column(const struct csv *csv, const char *name);
/* The cell as text; "" if column is -1. Row 1 is the first below the header. */
const char *csv_cell(const struct csv *csv, size_t row, int column);
/* The cell as a number; NAN if it is none. */
double csv_number(const struct csv *csv, size_t row, int column);

/* Whether all columns of csv are in `header` (comma-separated names, not quoted), each
 * once, "job" among them. */
bool csv_fits(const struct csv *csv, const char *header);
/* Appends the row as a line under that header; .nan for columns that csv does not have.
 */
void csv_append_row(struct text *text, const struct csv *csv, size_t row,
                    const char *header);

#endif
