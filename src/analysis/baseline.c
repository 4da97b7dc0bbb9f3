#include "analysis/baseline.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

enum column {
    SCENE,
    LABEL,
    BUDGET,
    CELL,
    EXPERIMENT,
    COMMIT,
    RUNS,
    SEED_FIRST,
    SEED_LAST,
    STATISTIC,
    COUNT,
    MISSING,
    VALUE,
    SE,
    SE_WITHIN,
    COLUMNS
};

static const char *const names[COLUMNS] = {
    "scene_label", "label",   "budget",     "cell",      "experiment",
    "commit",      "runs",    "seed_first", "seed_last", "statistic",
    "n",           "missing", "value",      "se",        "se_within"};

/* --- reading --------------------------------------------------------------------- */

struct reader {
    const struct csv *csv;
    int at[COLUMNS];
    size_t row;
    struct cells *cells;
    struct err *err;
};

static struct place place_of(const struct reader *r)
{
    return (struct place){r->csv->path, (int)r->row + 1, 0};
}

static const char *text_of(const struct reader *r, enum column column)
{
    return csv_cell(r->csv, r->row, r->at[column]);
}

static bool read_long(const struct reader *r, enum column column, long least, long *value)
{
    struct place at = place_of(r);
    if (text_to_long(text_of(r, column), value) && *value >= least)
        return true;
    return err_set(r->err, ERR_VALUE, &at, "%s: '%s' is no whole number from %ld",
                   names[column], text_of(r, column), least);
}

/* ".nan" where there is none. */
static bool read_number(const struct reader *r, enum column column, double least,
                        bool may_lack, double *value)
{
    const char *text = text_of(r, column);
    struct place at = place_of(r);
    *value = (double)NAN;
    if (may_lack && text_equal(text, ".nan"))
        return true;
    if (text_to_double(text, value) && *value >= least)
        return true;
    return err_set(r->err, ERR_VALUE, &at, "%s: '%s' is no number%s%s", names[column],
                   text, least == 0.0 ? " from 0" : "", may_lack ? ", nor .nan" : "");
}

static struct cell *cell_of(const struct reader *r)
{
    struct cell like = {.scene = (char *)text_of(r, SCENE),
                        .label = (char *)text_of(r, LABEL),
                        .budget = (char *)text_of(r, BUDGET)};
    const struct cell *known = cells_find(r->cells, &like);
    if (known)
        return &r->cells->items[known - r->cells->items];
    struct cell *cell = cells_add(r->cells, like.scene, like.label, like.budget,
                                  text_of(r, CELL));
    cell->experiment = text_copy(text_of(r, EXPERIMENT));
    cell->commit = text_copy(text_of(r, COMMIT));
    return cell;
}

static bool read_values(const struct reader *r, const struct cell *cell,
                        struct cell_statistic *s)
{
    struct place at = place_of(r);
    if (!read_long(r, COUNT, 0, &s->count) || !read_long(r, MISSING, 0, &s->missing))
        return false;
    if (s->count + s->missing != cell->runs)
        return err_set(r->err, ERR_VALUE, &at, "n and missing are not %ld runs together",
                       cell->runs);
    if (cell_scale(s->name) == CELL_SETTING) {
        s->text = text_copy(text_of(r, VALUE));
        return true;
    }
    return read_number(r, VALUE, -(double)INFINITY, s->count == 0, &s->mean) &&
           read_number(r, SE, 0.0, s->count < 2, &s->se) &&
           read_number(r, SE_WITHIN, 0.0, true, &s->se_within);
}

static bool read_row(const struct reader *r)
{
    struct place at = place_of(r);
    struct cell *cell = cell_of(r);
    const char *name = text_of(r, STATISTIC);
    if (!text_equal(cell->id, text_of(r, CELL)))
        return err_set(r->err, ERR_VALUE, &at,
                       "cell: '%s', but '%s' in the rows above of the same scene, label "
                       "and budget",
                       text_of(r, CELL), cell->id);
    if (name[0] == '\0' || cell_find(cell, name))
        return err_set(r->err, ERR_VALUE, &at, "statistic: '%s' %s", name,
                       name[0] ? "is here twice" : "is no name");
    return read_long(r, RUNS, 1, &cell->runs) &&
           read_long(r, SEED_FIRST, 0, &cell->seed_first) &&
           read_long(r, SEED_LAST, cell->seed_first, &cell->seed_last) &&
           read_values(r, cell, cell_add(cell, name));
}

static bool read_rows(struct reader *r)
{
    struct place top = {r->csv->path, 1, 0};
    for (int i = 0; i < COLUMNS; i++) {
        r->at[i] = csv_column(r->csv, names[i]);
        if (r->at[i] < 0)
            return err_set(r->err, ERR_VALUE, &top,
                           "no column '%s': this is no baseline; 'etalon regress RESULTS "
                           "--baseline FILE --update' writes one",
                           names[i]);
    }
    for (r->row = 1; r->row < r->csv->rows; r->row++)
        if (!read_row(r))
            return false;
    return r->csv->rows > 1 || err_set(r->err, ERR_VALUE, &top, "it has no rows");
}

/* A table of runs may end in half a line, but a baseline may not, as it is written at
 * once. */
static bool check_end(const struct csv *csv, struct err *err)
{
    size_t size;
    char *text = text_read_file(csv->path, &size, NULL, err);
    bool whole = text && csv->whole == size;
    mem_free(text);
    return whole ||
           err_set(err, ERR_SYNTAX, &(struct place){csv->path, (int)csv->rows + 1, 0},
                   "the file ends within this line");
}

bool baseline_read(const char *path, struct cells *cells, struct err *err)
{
    *cells = (struct cells){0};
    struct csv *csv = csv_read(path, err);
    if (csv == NULL)
        return false;
    struct reader reader = {.csv = csv, .cells = cells, .err = err};
    bool ok = check_end(csv, err) && read_rows(&reader);
    csv_destroy(csv);
    return ok;
}

/* --- writing --------------------------------------------------------------------- */

static void append_long(struct text *line, long value)
{
    text_append(line, ",%ld", value);
}

static void append_row(struct text *table, const struct cell *cell,
                       const struct cell_statistic *s)
{
    struct text line = {0};
    csv_append(&line, cell->scene);
    csv_append(&line, cell->label);
    csv_append(&line, cell->budget);
    csv_append(&line, cell->id);
    csv_append(&line, cell->experiment);
    csv_append(&line, cell->commit);
    append_long(&line, cell->runs);
    append_long(&line, cell->seed_first);
    append_long(&line, cell->seed_last);
    csv_append(&line, s->name);
    append_long(&line, s->count);
    append_long(&line, s->missing);
    if (s->text)
        csv_append(&line, s->text);
    else
        csv_append_number(&line, s->mean);
    csv_append_number(&line, s->se);
    csv_append_number(&line, s->se_within);
    text_append(table, "%s\n", line.data);
    mem_free(line.data);
}

bool baseline_write(const char *path, const struct cells *cells, struct err *err)
{
    struct text table = {0}, header = {0};
    for (int i = 0; i < COLUMNS; i++)
        csv_append(&header, names[i]);
    text_append(&table, "%s\n", header.data);
    for (size_t i = 0; i < cells->count; i++)
        for (size_t k = 0; k < cells->items[i].count; k++)
            if (cell_has(&cells->items[i].statistics[k]))
                append_row(&table, &cells->items[i], &cells->items[i].statistics[k]);
    bool ok = text_write_file(path, table.data, table.length, err);
    mem_free(header.data);
    mem_free(table.data);
    return ok;
}
