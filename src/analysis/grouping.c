#include "analysis/grouping.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

struct maker {
    const struct csv *runs;
    struct grouping *out;
    int scene, label, id, job, seed, seconds, mutations; /* columns */
};

static bool find_columns(struct maker *m, struct err *err)
{
    static const char *const needed[] = {"label", "scene_label", "seed", NULL};
    for (int i = 0; needed[i]; i++)
        if (csv_column(m->runs, needed[i]) < 0)
            return err_set(err, ERR_VALUE, &(struct place){m->runs->path, 1, 0},
                           "no column '%s': this is no table of runs", needed[i]);
    m->scene = csv_column(m->runs, "scene_label");
    m->label = csv_column(m->runs, "label");
    m->id = csv_column(m->runs, "cell");
    m->job = csv_column(m->runs, "job");
    m->seed = csv_column(m->runs, "seed");
    m->seconds = csv_column(m->runs, "budget_seconds");
    m->mutations = csv_column(m->runs, "budget_mutations_per_pixel");
    return true;
}

/* Rows of an older program have no id: empty, or .nan in an upgraded table. */
static const char *id_at(const struct maker *m, size_t row)
{
    const char *id = csv_cell(m->runs, row, m->id);
    return text_equal(id, ".nan") ? "" : id;
}

/* A cell that has no runs yet. */
static struct grouping_cell cell_at(const struct maker *m, size_t row)
{
    double seconds = csv_number(m->runs, row, m->seconds);
    bool is_time = seconds > 0.0;
    return (struct grouping_cell){
        .scene = csv_cell(m->runs, row, m->scene),
        .label = csv_cell(m->runs, row, m->label),
        .budget_is_time = is_time,
        .budget = is_time ? seconds : csv_number(m->runs, row, m->mutations),
        .id = "",
    };
}

static bool same_cell(const struct grouping_cell *a, const struct grouping_cell *b)
{
    return text_equal(a->scene, b->scene) && text_equal(a->label, b->label) &&
           a->budget_is_time == b->budget_is_time &&
           (a->budget == b->budget || (isnan(a->budget) && isnan(b->budget)));
}

/* Adds the cell if there is none yet. */
static struct grouping_cell *cell_of(const struct maker *m, size_t row)
{
    struct grouping *out = m->out;
    struct grouping_cell made = cell_at(m, row);
    for (size_t i = 0; i < out->cell_count; i++)
        if (same_cell(&out->cells[i], &made))
            return &out->cells[i];
    out->cells = mem_grow(out->cells, &out->cell_capacity, out->cell_count + 1,
                          sizeof *out->cells);
    out->cells[out->cell_count] = made;
    return &out->cells[out->cell_count++];
}

static void leave_out(const struct maker *m, size_t row, enum grouping_reason reason)
{
    struct grouping *out = m->out;
    out->left_out = mem_grow(out->left_out, &out->left_out_capacity,
                             out->left_out_count + 1, sizeof *out->left_out);
    out->left_out[out->left_out_count++] = (struct grouping_left_out){row, reason};
}

static bool read_seed(const struct maker *m, size_t row, long *seed)
{
    bool has_job = m->job < 0 || csv_cell(m->runs, row, m->job)[0] != '\0';
    return has_job && text_to_long(csv_cell(m->runs, row, m->seed), seed);
}

static void add_run(const struct maker *m, struct grouping_cell *cell, size_t row,
                    long seed)
{
    size_t at = cell->run_count;
    while (at > 0 && cell->runs[at - 1].seed > seed)
        at--;
    if (at > 0 && cell->runs[at - 1].seed == seed) {
        leave_out(m, cell->runs[at - 1].row, GROUPING_SAME_SEED);
        cell->runs[at - 1].row = row;
        return;
    }
    cell->runs = mem_resize(cell->runs, cell->run_count + 1, sizeof *cell->runs);
    memmove(&cell->runs[at + 1], &cell->runs[at],
            (cell->run_count - at) * sizeof *cell->runs);
    cell->runs[at] = (struct grouping_run){row, seed};
    cell->run_count++;
}

bool grouping_make(const struct csv *runs, struct grouping *grouping, struct err *err)
{
    struct maker m = {.runs = runs, .out = grouping};
    long seed;
    *grouping = (struct grouping){0};
    if (!find_columns(&m, err))
        return false;
    for (size_t row = 1; row < runs->rows; row++)
        if (read_seed(&m, row, &seed)) {
            struct grouping_cell *cell = cell_of(&m, row);
            cell->id = id_at(&m, row)[0] ? id_at(&m, row) : cell->id;
        }
    for (size_t row = 1; row < runs->rows; row++) {
        if (!read_seed(&m, row, &seed)) {
            leave_out(&m, row, GROUPING_UNREADABLE);
            continue;
        }
        struct grouping_cell *cell = cell_of(&m, row);
        if (id_at(&m, row)[0] && !text_equal(id_at(&m, row), cell->id))
            leave_out(&m, row, GROUPING_OTHER_CONTENTS);
        else
            add_run(&m, cell, row, seed);
    }
    return true;
}

void grouping_deinit(struct grouping *grouping)
{
    for (size_t i = 0; i < grouping->cell_count; i++)
        mem_free(grouping->cells[i].runs);
    mem_free(grouping->cells);
    mem_free(grouping->left_out);
    *grouping = (struct grouping){0};
}
