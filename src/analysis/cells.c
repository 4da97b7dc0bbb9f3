#include "analysis/cells.h"

#include "analysis/grouping.h"
#include "base/mem.h"
#include "math/accum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- which columns --------------------------------------------------------------- */

struct source {
    const char *name;   /* of the statistic */
    const char *column; /* NULL: the same */
    const char *within; /* column of the standard error that each run states, or NULL */
    enum cell_scale scale;
    bool by_length; /* the columns are lists */
};

/* The statistics. Those that depend on the clock or on the machine are left out. */
static const struct source sources[] = {
    {"integrator", NULL, NULL, CELL_SETTING, false},
    {"mode", NULL, NULL, CELL_SETTING, false},
    {"kernel", NULL, NULL, CELL_SETTING, false},
    {"sigma", NULL, NULL, CELL_SETTING, false},
    {"s1", NULL, NULL, CELL_SETTING, false},
    {"s2", NULL, NULL, CELL_SETTING, false},
    {"estimator", NULL, NULL, CELL_SETTING, false},
    {"builder", NULL, NULL, CELL_SETTING, false},
    {"rule", NULL, NULL, CELL_SETTING, false},
    {"per", NULL, NULL, CELL_SETTING, false},
    {"direct", NULL, NULL, CELL_SETTING, false},
    {"allocation", NULL, NULL, CELL_SETTING, false},
    {"start", NULL, NULL, CELL_SETTING, false},
    {"start_cap", NULL, NULL, CELL_SETTING, false},
    {"p_l_source", NULL, NULL, CELL_SETTING, false},
    {"biased", NULL, NULL, CELL_SETTING, false},
    {"max_depth", NULL, NULL, CELL_SETTING, false},
    {"width", NULL, NULL, CELL_SETTING, false},
    {"height", NULL, NULL, CELL_SETTING, false},
    {"keep_all", NULL, NULL, CELL_SETTING, false},
    {"emission_scale", NULL, NULL, CELL_SETTING, false},
    {"relmse_trim", NULL, NULL, CELL_SETTING, false},
    {"chains", NULL, NULL, CELL_LINEAR, false},
    {"bootstrap_paths", NULL, NULL, CELL_LINEAR, false},
    {"b", NULL, "b_se", CELL_LINEAR, false},
    {"eta_s", NULL, "eta_s_se", CELL_LINEAR, false},
    {"eta_l", NULL, "eta_l_se", CELL_LINEAR, false},
    {"eta_0", NULL, "eta_0_se", CELL_LINEAR, false},
    {"p_l", NULL, "p_l_se", CELL_LINEAR, false},
    {"acceptance", NULL, "acceptance_se", CELL_LINEAR, false},
    {"failure_rate", NULL, "failure_rate_se", CELL_LINEAR, false},
    {"second_stage_acceptance", NULL, NULL, CELL_LINEAR, false},
    {"eta_s_run", NULL, "eta_s_run_se", CELL_LINEAR, false},
    {"eta_l_run", NULL, "eta_l_run_se", CELL_LINEAR, false},
    {"eta_0_run", NULL, "eta_0_run_se", CELL_LINEAR, false},
    {"plain_b", NULL, "plain_b_se", CELL_LINEAR, false},
    {"n_nonfinite", NULL, NULL, CELL_LINEAR, false},
    {"n_saturated", NULL, NULL, CELL_LINEAR, false},
    {"relmse", NULL, NULL, CELL_LOG, false},
    {"relmse_trimmed", NULL, NULL, CELL_LOG, false},
    {"mean_ratio", NULL, NULL, CELL_LINEAR, false},
    {"b", "b_by_length", "b_se_by_length", CELL_LINEAR, true},
    {"eta_s_run", "eta_s_run_by_length", NULL, CELL_LINEAR, true},
    {"eta_l_run", "eta_l_run_by_length", NULL, CELL_LINEAR, true},
    {"eta_0_run", "eta_0_run_by_length", NULL, CELL_LINEAR, true},
    {"failure_rate_run", "failure_rate_run_by_length", NULL, CELL_LINEAR, true},
};

#define SOURCE_COUNT (sizeof sources / sizeof sources[0])

enum cell_scale cell_scale(const char *name)
{
    size_t length = strcspn(name, "[");
    for (size_t i = 0; i < SOURCE_COUNT; i++)
        if (strlen(sources[i].name) == length &&
            strncmp(sources[i].name, name, length) == 0)
            return sources[i].scale;
    return CELL_LINEAR;
}

/* --- cells ----------------------------------------------------------------------- */

static void cell_deinit(struct cell *cell)
{
    for (size_t i = 0; i < cell->count; i++) {
        mem_free(cell->statistics[i].name);
        mem_free(cell->statistics[i].text);
    }
    mem_free(cell->statistics);
    mem_free(cell->scene);
    mem_free(cell->label);
    mem_free(cell->budget);
    mem_free(cell->id);
    mem_free(cell->experiment);
    mem_free(cell->commit);
}

void cells_deinit(struct cells *cells)
{
    for (size_t i = 0; i < cells->count; i++)
        cell_deinit(&cells->items[i]);
    mem_free(cells->items);
    *cells = (struct cells){0};
}

struct cell *cells_add(struct cells *cells, const char *scene, const char *label,
                       const char *budget, const char *id)
{
    cells->items = mem_grow(cells->items, &cells->capacity, cells->count + 1,
                            sizeof *cells->items);
    struct cell *cell = &cells->items[cells->count++];
    *cell = (struct cell){.scene = text_copy(scene),
                          .label = text_copy(label),
                          .budget = text_copy(budget),
                          .id = text_copy(id)};
    return cell;
}

struct cell_statistic *cell_add(struct cell *cell, const char *name)
{
    const double nan = (double)NAN;
    cell->statistics = mem_grow(cell->statistics, &cell->capacity, cell->count + 1,
                                sizeof *cell->statistics);
    struct cell_statistic *statistic = &cell->statistics[cell->count++];
    *statistic = (struct cell_statistic){
        .name = text_copy(name), .mean = nan, .se = nan, .se_within = nan};
    return statistic;
}

const struct cell *cells_find(const struct cells *cells, const struct cell *like)
{
    for (size_t i = 0; i < cells->count; i++) {
        const struct cell *cell = &cells->items[i];
        if (text_equal(cell->scene, like->scene) &&
            text_equal(cell->label, like->label) &&
            text_equal(cell->budget, like->budget))
            return cell;
    }
    return NULL;
}

bool cell_has(const struct cell_statistic *s)
{
    if (s->text)
        return s->text[0] != '\0' && !text_equal(s->text, ".nan");
    return s->count > 0;
}

const struct cell_statistic *cell_find(const struct cell *cell, const char *name)
{
    for (size_t i = 0; i < cell->count; i++)
        if (text_equal(cell->statistics[i].name, name))
            return &cell->statistics[i];
    return NULL;
}

/* --- from runs ------------------------------------------------------------------- */

struct gather {
    const struct csv *runs;
    const struct grouping_cell *group; /* whose rows they are */
    struct cell *cell;
};

static const char *text_at(const struct csv *runs, size_t row, const char *name)
{
    return csv_cell(runs, row, csv_column(runs, name));
}

static double number_at(const struct csv *runs, size_t row, const char *name)
{
    return name ? csv_number(runs, row, csv_column(runs, name)) : (double)NAN;
}

static char *budget_of(const struct grouping_cell *group)
{
    return text_format(group->budget_is_time ? "%gs" : "mpp=%g", group->budget);
}

/* The number of `list` (numbers apart by blanks) at `index`; NAN if there is none. */
static double item(const char *list, int index)
{
    for (; *list && index > 0; index--) {
        list += strcspn(list, " ");
        list += strspn(list, " ");
    }
    char *end;
    double value = strtod(list, &end);
    return end == list ? (double)NAN : value;
}

static void add_setting(const struct gather *g, const struct source *source)
{
    const char *first = text_at(g->runs, g->group->runs[0].row, source->name);
    struct cell_statistic *statistic = cell_add(g->cell, source->name);
    bool same = true;
    for (size_t i = 1; same && i < g->group->run_count; i++)
        same = text_equal(text_at(g->runs, g->group->runs[i].row, source->name), first);
    statistic->text = text_copy(same ? first : "(varies)");
    statistic->count = (long)g->group->run_count;
}

/* Value and standard error of one run; index: in lists, else below 0. */
static double value_at(const struct gather *g, size_t row, const char *column, int index)
{
    if (column == NULL || index < 0)
        return number_at(g->runs, row, column);
    return item(text_at(g->runs, row, column), index);
}

/* Where `length` stands in the run's own list of lengths, or -1. */
static int place_of(const struct gather *g, size_t row, int length)
{
    const char *lengths = text_at(g->runs, row, "by_length");
    double at;
    for (int i = 0; !isnan(at = item(lengths, i)); i++)
        if ((int)at == length)
            return i;
    return -1;
}

/* length: 0 if it is no list. */
static void add_number(const struct gather *g, const struct source *source, int length)
{
    const char *column = source->column ? source->column : source->name;
    struct welford sum = {0};
    double within = (double)NAN;
    for (size_t i = 0; i < g->group->run_count; i++) {
        size_t row = g->group->runs[i].row;
        int index = length ? place_of(g, row, length) : -1;
        bool listed = length == 0 || index >= 0;
        double value = listed ? value_at(g, row, column, index) : (double)NAN;
        value = source->scale == CELL_LOG ? log(value) : value;
        if (!isfinite(value))
            continue;
        welford_add(&sum, value);
        within = value_at(g, row, source->within, index);
    }
    char *name = length ? text_format("%s[%d]", source->name, length)
                        : text_copy(source->name);
    struct cell_statistic *statistic = cell_add(g->cell, name);
    mem_free(name);
    statistic->count = (long)sum.count;
    statistic->missing = (long)g->group->run_count - statistic->count;
    if (statistic->count > 0)
        statistic->mean = sum.mean;
    if (statistic->count > 1)
        statistic->se = welford_se(&sum);
    if (statistic->count == 1 && isfinite(within))
        statistic->se_within = within;
}

/* Adds a statistic for every length that any of the runs has. */
static void add_lengths(const struct gather *g, const struct source *source)
{
    int longest = 0;
    for (size_t i = 0; i < g->group->run_count; i++) {
        const char *lengths = text_at(g->runs, g->group->runs[i].row, "by_length");
        double at;
        for (int k = 0; !isnan(at = item(lengths, k)); k++)
            longest = at > longest ? (int)at : longest;
    }
    for (int length = 1; length <= longest; length++) {
        bool found = false;
        for (size_t i = 0; !found && i < g->group->run_count; i++)
            found = place_of(g, g->group->runs[i].row, length) >= 0;
        if (found)
            add_number(g, source, length);
    }
}

static char *same_text(const struct gather *g, const char *column)
{
    const char *first = text_at(g->runs, g->group->runs[0].row, column);
    for (size_t i = 1; i < g->group->run_count; i++)
        if (!text_equal(text_at(g->runs, g->group->runs[i].row, column), first))
            return text_copy("(several)");
    return text_copy(first);
}

static void fill(const struct gather *g, struct log *log)
{
    struct cell *cell = g->cell;
    cell->experiment = same_text(g, "experiment");
    cell->commit = same_text(g, "commit");
    if (text_equal(cell->commit, "(several)"))
        log_note(log, &(struct place){g->runs->path, 0, 0},
                 "the runs of a cell come from several commits");
    for (size_t i = 0; i < g->group->run_count; i++)
        if (g->group->id[0] &&
            !text_equal(text_at(g->runs, g->group->runs[i].row, "cell"), g->group->id))
            log_note(log,
                     &(struct place){g->runs->path, (int)g->group->runs[i].row + 1, 0},
                     "its contents are not stated: assumed to be those of the newer runs "
                     "of the same name");
    cell->runs = (long)g->group->run_count;
    cell->seed_first = g->group->runs[0].seed;
    cell->seed_last = g->group->runs[g->group->run_count - 1].seed;
    for (size_t i = 0; i < SOURCE_COUNT; i++) {
        const struct source *source = &sources[i];
        const char *column = source->column ? source->column : source->name;
        if (csv_column(g->runs, column) < 0)
            continue;
        if (source->scale == CELL_SETTING)
            add_setting(g, source);
        else if (source->by_length)
            add_lengths(g, source);
        else
            add_number(g, source, 0);
    }
}

static void note_left_out(const struct csv *runs, const struct grouping *grouping,
                          struct log *log)
{
    static const char *const why[] = {
        [GROUPING_OTHER_CONTENTS] = "a newer run of this scene, label and budget has "
                                    "other contents, settings or another reference",
        [GROUPING_SAME_SEED] = "a newer run of this scene, label and budget has the same "
                               "seed",
        [GROUPING_UNREADABLE] = "it has no seed, or no job",
    };
    for (size_t i = 0; i < grouping->left_out_count; i++)
        log_note(log, &(struct place){runs->path, (int)grouping->left_out[i].row + 1, 0},
                 "left out: %s", why[grouping->left_out[i].reason]);
}

static void note_columns(const struct csv *runs, struct log *log)
{
    struct place at = {runs->path, 1, 0};
    if (csv_column(runs, "cell") < 0)
        log_note(
            log, &at,
            "no column 'cell': scenes, settings and references can be compared by name "
            "only");
    for (size_t i = 0; i < SOURCE_COUNT; i++) {
        const char *column = sources[i].column ? sources[i].column : sources[i].name;
        if (csv_column(runs, column) < 0)
            log_note(log, &at, "no column '%s'", column);
    }
}

bool cells_from_runs(const struct csv *runs, struct cells *cells, struct log *log,
                     struct err *err)
{
    struct grouping grouping;
    *cells = (struct cells){0};
    if (!grouping_make(runs, &grouping, err))
        return false;
    note_columns(runs, log);
    note_left_out(runs, &grouping, log);
    for (size_t i = 0; i < grouping.cell_count; i++) {
        const struct grouping_cell *group = &grouping.cells[i];
        char *budget = budget_of(group);
        struct cell *cell = cells_add(cells, group->scene, group->label, budget,
                                      group->id);
        mem_free(budget);
        fill(&(struct gather){runs, group, cell}, log);
    }
    grouping_deinit(&grouping);
    return true;
}
