#include "lab/csv.h"

#include "base/mem.h"
#include "lab/scalar.h"

#include <math.h>
#include <string.h>

void csv_append(struct text *line, const char *value)
{
    /* An empty first cell is quoted, so that a line of one empty cell is not an empty
     * line. */
    bool quoted = strpbrk(value, ",\"\r\n") != NULL ||
                  (value[0] == '\0' && line->length == 0);
    text_append(line, "%s%s", line->length ? "," : "", quoted ? "\"" : "");
    for (const char *c = value; *c; c++)
        text_append(line, *c == '"' ? "\"\"" : "%c", *c);
    text_append(line, "%s", quoted ? "\"" : "");
}

void csv_append_number(struct text *line, double value)
{
    struct text digits = {0};
    scalar_append_number(&digits, value);
    csv_append(line, digits.data);
    mem_free(digits.data);
}

struct reader {
    struct csv *csv;
    const char *at;
    int line;
};

/* Reads one cell up to its separator; false at the end of the text. */
static bool read_cell(struct reader *r, struct text *cell)
{
    bool quoted = false;
    cell->length = 0;
    text_append(cell, "%s", "");
    for (; *r->at; r->at++) {
        if (quoted && r->at[0] == '"' && r->at[1] == '"') {
            text_append(cell, "\"");
            r->at++;
        } else if (*r->at == '"') {
            quoted = !quoted;
        } else if (!quoted && (*r->at == ',' || *r->at == '\n')) {
            return true;
        } else if (quoted || *r->at != '\r') {
            text_append(cell, "%c", *r->at);
        }
        r->line += *r->at == '\n';
    }
    return false;
}

static void add_cell(struct csv *csv, const char *value)
{
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    csv->cells = mem_grow(csv->cells, &csv->cell_capacity, csv->cell_count + 1,
                          sizeof *csv->cells);
    csv->cells[csv->cell_count++] = text_copy(value);
}

static void drop_cells(struct csv *csv, size_t count)
{
    while (csv->cell_count > count)
        mem_free(csv->cells[--csv->cell_count]);
}

static bool end_row(struct reader *r, size_t first, struct err *err)
{
    struct csv *csv = r->csv;
    struct place at = {csv->path, r->line, 0};
    size_t columns = csv->cell_count - first;
    if (csv->rows++ == 0)
        csv->columns = columns;
    if (columns == csv->columns)
        return true;
    return err_set(err, ERR_SYNTAX, &at, "%zu cells, but the header has %zu", columns,
                   csv->columns);
}

/* A writer that died leaves an incomplete last line, which is dropped. If more than one
 * line would be dropped, a quote was never closed: that is an error. */
static bool check_rest(const struct reader *r, const char *text, struct err *err)
{
    const char *rest = text + r->csv->whole;
    struct place at = {r->csv->path, 1, 0};
    if (strchr(rest, '\n') == NULL)
        return true;
    for (const char *c = text; c < rest; c++)
        at.line += *c == '\n';
    return err_set(err, ERR_SYNTAX, &at,
                   "a quotation mark that begins in this row is not closed");
}

/* Two columns of one name are an error: the second would never be read. */
static bool check_names(const struct csv *csv, struct err *err)
{
    for (size_t i = 0; csv->rows > 0 && i < csv->columns; i++)
        if (csv_column(csv, csv->cells[i]) != (int)i)
            return err_set(err, ERR_VALUE, &(struct place){csv->path, 1, 0},
                           "the column '%s' is here twice", csv->cells[i]);
    return true;
}

static bool read_rows(struct reader *r, const char *text, struct err *err)
{
    struct csv *csv = r->csv;
    struct text cell = {0};
    size_t first = 0;
    bool ok = true;
    while (ok && read_cell(r, &cell)) {
        add_cell(csv, cell.data);
        if (*r->at++ == ',')
            continue;
        ok = end_row(r, first, err);
        first = csv->cell_count;
        csv->whole = (size_t)(r->at - text);
        r->line++;
    }
    drop_cells(csv, csv->rows * csv->columns);
    mem_free(cell.data);
    return ok && check_rest(r, text, err) && check_names(csv, err);
}

/* A zero byte is an error: it would end the text. */
static bool check_zeros(const char *path, const char *text, size_t size, struct err *err)
{
    struct place at = {path, 1, 0};
    if (strlen(text) == size)
        return true;
    for (const char *c = text; *c; c++)
        at.line += *c == '\n';
    return err_set(err, ERR_SYNTAX, &at, "a zero byte: the file is damaged, or no table");
}

struct csv *csv_read(const char *path, struct err *err)
{
    size_t size;
    char *text = text_read_file(path, &size, NULL, err);
    if (text == NULL)
        return NULL;
    struct csv *csv = mem_alloc(1, sizeof *csv);
    struct reader reader = {.csv = csv, .at = text_skip_mark(text), .line = 1};
    csv->path = text_copy(path);
    bool ok = check_zeros(path, text, size, err) && read_rows(&reader, text, err);
    mem_free(text);
    if (ok)
        return csv;
    csv_destroy(csv);
    return NULL;
}

void csv_destroy(struct csv *csv)
{
    if (csv == NULL)
        return;
    drop_cells(csv, 0);
    mem_free(csv->cells);
    mem_free(csv->path);
    mem_free(csv);
}

int csv_column(const struct csv *csv, const char *name)
{
    for (size_t i = 0; csv->rows > 0 && i < csv->columns; i++)
        if (text_equal(csv->cells[i], name))
            return (int)i;
    return -1;
}

const char *csv_cell(const struct csv *csv, size_t row, int column)
{
    return column < 0 ? "" : csv->cells[row * csv->columns + (size_t)column];
}

double csv_number(const struct csv *csv, size_t row, int column)
{
    double value;
    return text_to_double(csv_cell(csv, row, column), &value) ? value : (double)NAN;
}

/* The next name of a header and what follows it; NULL at the end. */
static char *next_name(const char **header)
{
    size_t length = strcspn(*header, ",\n");
    if (length == 0)
        return NULL;
    char *name = text_copy_n(*header, length);
    *header += length + ((*header)[length] == ',');
    return name;
}

bool csv_fits(const struct csv *csv, const char *header)
{
    size_t found = 0;
    for (char *name; (name = next_name(&header)); mem_free(name))
        found += csv_column(csv, name) >= 0;
    return csv_column(csv, "job") >= 0 && found == csv->columns;
}

void csv_append_row(struct text *text, const struct csv *csv, size_t row,
                    const char *header)
{
    struct text line = {0};
    for (char *name; (name = next_name(&header)); mem_free(name)) {
        int column = csv_column(csv, name);
        csv_append(&line, column >= 0 ? csv_cell(csv, row, column) : ".nan");
    }
    text_append(text, "%s\n", line.data);
    mem_free(line.data);
}
