#include "analysis/analysis_panel.h"

#include "base/mem.h"
#include "analysis/analysis_curve.h"

#include <math.h>
#include <string.h>

struct search {
    enum results_axis axis;
    enum results_error error;
    long *seeds; /* [panel->seed_count] */
};

/* Number of runs of the cell with a curve. */
static size_t usable_runs(const struct results_cell *cell, enum results_axis axis)
{
    double first, last;
    size_t count = 0;
    for (size_t i = 0; i < cell->run_count; i++)
        count += analysis_range(&cell->runs[i], axis, &first, &last);
    return count;
}

static bool has_curve(const struct results_cell *cell, long seed, enum results_axis axis)
{
    double first, last;
    const struct results_run *run = results_find_seed(cell, seed);
    return run && analysis_range(run, axis, &first, &last);
}

static void gather(const struct family *family, const struct search *search,
                   struct analysis_panel *panel)
{
    size_t most = 0;
    panel->cells = mem_alloc(family->manual_count + 1,
                             sizeof(const struct results_cell *));
    if (family->automatic && usable_runs(family->automatic, search->axis) > 0) {
        panel->cells[panel->cell_count++] = family->automatic;
        panel->has_auto = true;
        most = usable_runs(family->automatic, search->axis);
    }
    for (size_t i = 0; i < family->manual_count; i++) {
        size_t runs = usable_runs(family->manual[i], search->axis);
        most = runs > most ? runs : most;
    }
    for (size_t i = 0; i < family->manual_count; i++) {
        size_t runs = usable_runs(family->manual[i], search->axis);
        if (runs > 0 && 2 * runs >= most)
            panel->cells[panel->cell_count++] = family->manual[i];
        else
            panel->left_out++;
    }
}

static void find_seeds(struct search *search, struct analysis_panel *panel)
{
    const struct results_cell *first = panel->cells[0];
    panel->seed_count = 0;
    for (size_t i = 0; i < first->run_count; i++) {
        long seed = first->runs[i].seed;
        bool everywhere = true;
        for (size_t c = 0; c < panel->cell_count; c++)
            everywhere = everywhere && has_curve(panel->cells[c], seed, search->axis);
        if (everywhere)
            search->seeds[panel->seed_count++] = seed;
    }
}

static double earliest_end(const struct search *search,
                           const struct analysis_panel *panel)
{
    double first, last, end = (double)INFINITY;
    for (size_t c = 0; c < panel->cell_count; c++)
        for (size_t s = 0; s < panel->seed_count; s++)
            if (analysis_range(results_find_seed(panel->cells[c], search->seeds[s]),
                               search->axis, &first, &last))
                end = fmin(end, last);
    return end;
}

static bool fill_row(const struct search *search, const struct analysis_panel *panel,
                     const struct results_cell *cell, double *row)
{
    bool ok = true;
    for (size_t s = 0; s < panel->seed_count; s++) {
        const struct results_run *run = results_find_seed(cell, search->seeds[s]);
        row[s] = analysis_error_at(run, search->axis, search->error, panel->x);
        ok = ok && row[s] > 0.0;
    }
    return ok;
}

/* Leaves out the cells whose curves do not reach x. */
static void fill(const struct search *search, struct analysis_panel *panel)
{
    size_t kept = 0;
    panel->errors = mem_alloc(panel->cell_count * panel->seed_count,
                              sizeof *panel->errors);
    for (size_t c = 0; c < panel->cell_count; c++) {
        const struct results_cell *cell = panel->cells[c];
        bool ok = fill_row(search, panel, cell, panel->errors + kept * panel->seed_count);
        if (ok)
            panel->cells[kept++] = cell;
        else if (c == 0 && panel->has_auto)
            panel->has_auto = false;
        else
            panel->left_out++;
    }
    panel->cell_count = kept;
}

static const char *lacking(const struct family *family,
                           const struct analysis_panel *panel, bool need_auto)
{
    size_t manual = panel->cell_count - (panel->has_auto ? 1 : 0);
    if (need_auto && family->automatic == NULL)
        return "there is no automatic p_l beside the manual ones";
    if (family->manual_count == 0)
        return "there are no manual p_l to compare with";
    if (need_auto && !panel->has_auto)
        return "the automatic p_l has no error at the common time";
    if (manual == 0)
        return "no manual p_l has an error at the common time";
    return "";
}

void analysis_panel_make(const struct family *family, enum results_axis axis,
                         enum results_error error, bool need_auto,
                         struct analysis_panel *panel)
{
    struct search search = {.axis = axis, .error = error};
    *panel = (struct analysis_panel){.x = (double)NAN, .why = ""};
    gather(family, &search, panel);
    panel->why = lacking(family, panel, need_auto);
    if (panel->why[0])
        return;
    panel->noise = panel->cells[0]->noise[error];
    search.seeds = mem_alloc(panel->cells[0]->run_count, sizeof *search.seeds);
    find_seeds(&search, panel);
    if (panel->seed_count == 0) {
        panel->why = "the p_l have no seed in common";
    } else {
        panel->x = earliest_end(&search, panel);
        fill(&search, panel);
        panel->why = lacking(family, panel, need_auto);
    }
    mem_free(search.seeds);
}

void analysis_panel_deinit(struct analysis_panel *panel)
{
    mem_free(panel->cells);
    mem_free(panel->errors);
    *panel = (struct analysis_panel){0};
}
