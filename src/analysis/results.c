#include "analysis/results.h"

#include "analysis/grouping.h"
#include "base/mem.h"
#include "image/exr.h"
#include "image/metric.h"
#include "lab/store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const axis_names[RESULTS_AXES] = {"wall_s", "cpu_s",
                                                     "mutations_per_pixel"};
static const char *const error_names[RESULTS_ERRORS] = {"relmse", "relmse_trimmed", "mse",
                                                        "relmse_estimated"};
/* Columns of the errors; that of mse is squared. */
static const char *const error_columns[RESULTS_ERRORS] = {"relmse", "relmse_trimmed",
                                                          "rmse", "relmse_estimated"};

const char *results_axis_name(enum results_axis axis)
{
    return axis_names[axis];
}

const char *results_error_name(enum results_error error)
{
    return error_names[error];
}

static double mean_square(int error, double figure)
{
    return error == RESULTS_MSE ? figure * figure : figure;
}

const char *results_text(const struct results *results, const struct results_run *run,
                         const char *column)
{
    return csv_cell(results->runs, run->row, csv_column(results->runs, column));
}

double results_number(const struct results *results, const struct results_run *run,
                      const char *column)
{
    return csv_number(results->runs, run->row, csv_column(results->runs, column));
}

/* --- cells ----------------------------------------------------------------------- */

bool results_same_budget(const struct results_cell *a, const struct results_cell *b)
{
    return text_equal(a->scene, b->scene) && a->budget_is_time == b->budget_is_time &&
           (a->budget == b->budget || (isnan(a->budget) && isnan(b->budget)));
}

static struct results_run read_run(const struct results *results,
                                   const struct grouping_run *from)
{
    struct results_run run = {.row = from->row, .seed = from->seed};
    run.job = results_text(results, &run, "job");
    run.p_l = results_number(results, &run, "p_l");
    for (int e = 0; e < RESULTS_ERRORS; e++)
        run.error[e] = mean_square(e, results_number(results, &run, error_columns[e]));
    run.estimated_se = results_number(results, &run, "relmse_estimated_se");
    run.mean_ratio = results_number(results, &run, "mean_ratio");
    run.has_trim = results_number(results, &run, "relmse_trim") == 1.0 / METRIC_TRIM;
    return run;
}

static void drop_other_trim(struct results *results, struct results_run *run)
{
    if (run->has_trim)
        return;
    results->other_trim += isfinite(run->error[RESULTS_RELMSE_TRIMMED]) ? 1 : 0;
    run->error[RESULTS_RELMSE_TRIMMED] = (double)NAN;
}

/* Tables older than the column p_l_source are read by their labels. */
static bool is_automatic(const char *source, const char *label)
{
    return text_equal(source, "auto") ||
           (source[0] == '\0' && strstr(label, "p_l=auto") != NULL);
}

/* A cell with the facts from its first run. */
static struct results_cell read_cell(const struct results *results,
                                     const struct grouping_cell *group,
                                     const struct results_run *run)
{
    const char *source = results_text(results, run, "p_l_source");
    struct results_cell cell = {
        .scene = group->scene,
        .label = group->label,
        .integrator = results_text(results, run, "integrator"),
        .budget_is_time = group->budget_is_time,
        .budget = group->budget,
        .has_chains = source[0] != '\0' || isfinite(run->p_l),
        .is_biased = text_equal(results_text(results, run, "biased"), "true"),
        .reference = "",
    };
    cell.is_auto = cell.has_chains && is_automatic(source, cell.label);
    cell.p_l = cell.has_chains && !cell.is_auto ? run->p_l : (double)NAN;
    return cell;
}

/* Rows from before these columns existed have no reference. */
static void learn_reference(const struct results *results, const struct results_run *run,
                            struct results_cell *cell)
{
    if (cell->reference[0] == '\0')
        cell->reference = results_text(results, run, "reference");
    for (int e = 0; e < RESULTS_ERRORS; e++) {
        char *column = text_format("reference_%s", error_columns[e]);
        double noise = mean_square(e, results_number(results, run, column));
        mem_free(column);
        if (cell->noise_is_known[e] || !isfinite(noise))
            continue;
        cell->noise_is_known[e] = true;
        cell->noise[e] = noise;
    }
}

static void average_p_l(struct results_cell *cell)
{
    cell->p_l_mean = 0.0;
    for (size_t i = 0; i < cell->run_count; i++)
        cell->p_l_mean += cell->runs[i].p_l / (double)cell->run_count;
}

static struct results_cell make_cell(struct results *results,
                                     const struct grouping_cell *group)
{
    struct results_run *runs = mem_alloc(group->run_count, sizeof *runs);
    for (size_t i = 0; i < group->run_count; i++) {
        runs[i] = read_run(results, &group->runs[i]);
        drop_other_trim(results, &runs[i]);
    }
    struct results_cell cell = read_cell(results, group, &runs[0]);
    cell.runs = runs;
    cell.run_count = group->run_count;
    for (int older = 0; older < 2; older++)
        for (size_t i = 0; i < cell.run_count; i++)
            if (runs[i].has_trim != (older == 1))
                learn_reference(results, &runs[i], &cell);
    average_p_l(&cell);
    return cell;
}

static bool read_runs(struct results *results, struct err *err)
{
    struct grouping grouping;
    if (!grouping_make(results->runs, &grouping, err))
        return false;
    results->cell_count = grouping.cell_count;
    if (grouping.cell_count > 0)
        results->cells = mem_alloc(grouping.cell_count, sizeof *results->cells);
    for (size_t i = 0; i < grouping.cell_count; i++)
        results->cells[i] = make_cell(results, &grouping.cells[i]);
    for (size_t i = 0; i < grouping.left_out_count; i++)
        if (grouping.left_out[i].reason == GROUPING_UNREADABLE)
            results->unreadable++;
        else
            results->superseded++;
    grouping_deinit(&grouping);
    return true;
}

/* --- curves ---------------------------------------------------------------------- */

struct curve_row {
    const char *job;
    size_t row;
};

static int compare_rows(const void *a, const void *b)
{
    const struct curve_row *x = a, *y = b;
    int order = strcmp(x->job, y->job);
    return order ? order : (x->row > y->row) - (x->row < y->row);
}

static struct results_snapshot read_snapshot(const struct csv *curves, size_t row,
                                             bool has_trim)
{
    struct results_snapshot snapshot;
    for (int a = 0; a < RESULTS_AXES; a++)
        snapshot.at[a] = csv_number(curves, row, csv_column(curves, axis_names[a]));
    for (int e = 0; e < RESULTS_ERRORS; e++)
        snapshot.error[e] = mean_square(
            e, csv_number(curves, row, csv_column(curves, error_columns[e])));
    if (!has_trim)
        snapshot.error[RESULTS_RELMSE_TRIMMED] = (double)NAN;
    snapshot.mean_ratio = csv_number(curves, row, csv_column(curves, "mean_ratio"));
    return snapshot;
}

static void take_snapshots(const struct csv *curves, const struct curve_row *rows,
                           size_t count, struct results_run *run)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (strcmp(rows[middle].job, run->job) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    while (low + run->snapshot_count < count &&
           text_equal(rows[low + run->snapshot_count].job, run->job))
        run->snapshot_count++;
    if (run->snapshot_count > 0)
        run->snapshots = mem_alloc(run->snapshot_count, sizeof *run->snapshots);
    for (size_t i = 0; i < run->snapshot_count; i++)
        run->snapshots[i] = read_snapshot(curves, rows[low + i].row, run->has_trim);
}

static void read_curves(struct results *results)
{
    const struct csv *curves = results->curves;
    int column = csv_column(curves, "job");
    size_t count = curves->rows > 0 ? curves->rows - 1 : 0;
    struct curve_row *rows = mem_alloc(count + 1, sizeof *rows);
    for (size_t i = 0; i < count; i++)
        rows[i] = (struct curve_row){csv_cell(curves, i + 1, column), i + 1};
    qsort(rows, count, sizeof *rows, compare_rows);
    for (size_t c = 0; c < results->cell_count; c++)
        for (size_t i = 0; i < results->cells[c].run_count; i++)
            take_snapshots(curves, rows, count, &results->cells[c].runs[i]);
    mem_free(rows);
}

/* --- the folder ------------------------------------------------------------------ */

static bool open_tables(struct results *results, struct err *err)
{
    struct err inner = {0};
    results->runs = store_read_runs(results->folder, &inner);
    if (results->runs == NULL && inner.code == ERR_NONE)
        return err_set(err, ERR_IO, NULL,
                       "there is no runs.csv in '%s'; give a folder "
                       "that etalon bench has written",
                       results->folder);
    if (results->runs == NULL) {
        if (err)
            *err = inner;
        return false;
    }
    if (csv_column(results->runs, "job") < 0)
        return err_set(err, ERR_VALUE, &(struct place){results->runs->path, 1, 0},
                       "no column 'job': this is no table of runs");
    char *path = text_join(results->folder, "curves.csv");
    bool there = access(path, F_OK) == 0;
    results->curves = there ? csv_read(path, err) : NULL;
    mem_free(path);
    return !there || results->curves;
}

struct results *results_load(const char *folder, struct err *err)
{
    struct results *results = mem_alloc(1, sizeof *results);
    results->folder = text_copy(folder);
    if (!open_tables(results, err) || !read_runs(results, err)) {
        results_destroy(results);
        return NULL;
    }
    if (results->curves)
        read_curves(results);
    return results;
}

void results_destroy(struct results *results)
{
    if (results == NULL)
        return;
    for (size_t c = 0; c < results->cell_count; c++) {
        for (size_t i = 0; i < results->cells[c].run_count; i++)
            mem_free(results->cells[c].runs[i].snapshots);
        mem_free(results->cells[c].runs);
    }
    mem_free(results->cells);
    csv_destroy(results->runs);
    csv_destroy(results->curves);
    mem_free(results->folder);
    mem_free(results);
}

double results_mean(const struct results *results, const struct results_cell *cell,
                    const char *column)
{
    double sum = 0.0;
    for (size_t i = 0; i < cell->run_count; i++)
        sum += results_number(results, &cell->runs[i], column);
    return sum / (double)cell->run_count;
}

char *results_picture(const struct results *results, const struct results_run *run)
{
    return text_format("%s/images/%s.exr", results->folder, run->job);
}

bool results_read_pictures(const struct results *results, const struct results_cell *cell,
                           struct image **pictures, struct err *err)
{
    bool ok = true;
    for (size_t i = 0; i < cell->run_count; i++)
        pictures[i] = NULL;
    for (size_t i = 0; ok && i < cell->run_count; i++) {
        char *path = results_picture(results, &cell->runs[i]);
        pictures[i] = exr_read(path, NULL, err);
        ok = pictures[i] != NULL;
        mem_free(path);
    }
    return ok;
}

char *results_budget(const struct results_cell *cell)
{
    if (isnan(cell->budget))
        return text_copy("an unknown budget");
    return text_format(cell->budget_is_time ? "%g s" : "%g mutations per pixel",
                       cell->budget);
}

const struct results_run *results_find_seed(const struct results_cell *cell, long seed)
{
    for (size_t i = 0; i < cell->run_count; i++)
        if (cell->runs[i].seed == seed)
            return &cell->runs[i];
    return NULL;
}
