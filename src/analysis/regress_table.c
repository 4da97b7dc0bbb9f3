#include "analysis/regress.h"

#include "base/mem.h"

#include <math.h>

const char *regress_test_name(enum regress_test test)
{
    static const char *const names[] = {"none",   "student", "welch",
                                        "within", "equal",   "missing"};
    return names[test];
}

const char *regress_verdict_name(enum regress_verdict verdict)
{
    static const char *const names[] = {"same", "moved", "differs", "gone"};
    return names[verdict];
}

/* n, mean, standard error; of settings, the text. */
static void append_side(struct text *line, const struct cell_statistic *s,
                        const char *text)
{
    const double nan = (double)NAN;
    text_append(line, ",%ld", s ? s->count : 0);
    if (text)
        csv_append(line, text);
    else
        csv_append_number(line, s ? s->mean : nan);
    csv_append_number(line, s ? s->se : nan);
}

static void append_row(struct text *table, const struct regress_row *row)
{
    struct text line = {0};
    csv_append(&line, row->cell->scene);
    csv_append(&line, row->cell->label);
    csv_append(&line, row->cell->budget);
    csv_append(&line, row->statistic);
    csv_append(&line, regress_verdict_name(row->verdict));
    csv_append(&line, regress_test_name(row->test));
    append_side(&line, row->base, row->base_text);
    append_side(&line, row->now, row->now_text);
    csv_append_number(&line, row->change);
    csv_append_number(&line, row->se);
    csv_append_number(&line, row->freedom);
    csv_append_number(&line, row->p);
    csv_append_number(&line, row->detectable);
    text_append(table, "%s\n", line.data);
    mem_free(line.data);
}

bool regress_write(const char *path, const struct regress *regress, struct err *err)
{
    struct text table = {0};
    text_append(&table, "scene_label,label,budget,statistic,verdict,test,base_n,base,"
                        "base_se,n,value,se,change,change_se,freedom,p,detectable\n");
    for (size_t i = 0; i < regress->count; i++)
        append_row(&table, &regress->rows[i]);
    bool ok = text_write_file(path, table.data, table.length, err);
    mem_free(table.data);
    return ok;
}
