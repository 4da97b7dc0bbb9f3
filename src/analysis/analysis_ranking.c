#include "analysis/analysis_ranking.h"

#include "base/mem.h"
#include "math/law.h"

#include <math.h>
#include <stdlib.h>

/* Errors that are not above the noise of the reference by this factor are left as they
 * are: of a small difference little is known. */
#define CLEAR_OF_NOISE 2.0

/* --- which cells ----------------------------------------------------------------- */

static bool has_automatic_beside(const struct families *families,
                                 const struct results_cell *cell)
{
    for (size_t i = 0; i < families->count; i++)
        for (size_t k = 0; k < families->items[i].manual_count; k++)
            if (families->items[i].automatic && families->items[i].manual[k] == cell)
                return true;
    return false;
}

static bool is_measured(const struct results_cell *cell, enum results_error error)
{
    for (size_t i = 0; i < cell->run_count; i++)
        if (!(cell->runs[i].error[error] > 0.0))
            return false;
    return cell->run_count > 0;
}

static void take_cells(const struct results *results, const struct families *families,
                       const struct results_cell *group, enum results_error error,
                       bool all, struct analysis_ranking *ranking)
{
    ranking->count = 0;
    for (size_t i = 0; i < results->cell_count; i++) {
        const struct results_cell *cell = &results->cells[i];
        if (results_same_budget(cell, group) && is_measured(cell, error) &&
            (all || !has_automatic_beside(families, cell)))
            ranking->items[ranking->count++] = (struct analysis_rank){.cell = cell};
    }
}

/* --- their order ----------------------------------------------------------------- */

static bool is_clear_of(const struct analysis_ranking *ranking, enum results_error error,
                        double noise)
{
    for (size_t c = 0; c < ranking->count; c++)
        for (size_t i = 0; i < ranking->items[c].cell->run_count; i++)
            if (ranking->items[c].cell->runs[i].error[error] <= CLEAR_OF_NOISE * noise)
                return false;
    return true;
}

/* The errors of a cell's runs; to be freed. */
static double *errors_of(const struct results_cell *cell, enum results_error error,
                         double noise)
{
    double *errors = mem_alloc(cell->run_count, sizeof *errors);
    for (size_t i = 0; i < cell->run_count; i++)
        errors[i] = cell->runs[i].error[error] - noise;
    return errors;
}

static int compare_ranks(const void *a, const void *b)
{
    const struct analysis_rank *x = a, *y = b;
    return x->error != y->error ? (x->error > y->error) - (x->error < y->error)
                                : (x->cell > y->cell) - (x->cell < y->cell);
}

/* The ratio of the estimated errors of two single runs, log-normal by their standard
 * errors. */
static struct interval ratio_by_bars(const struct results_run *a,
                                     const struct results_run *b)
{
    double x = a->error[RESULTS_ESTIMATED], y = b->error[RESULTS_ESTIMATED];
    double se = hypot(a->estimated_se / x, b->estimated_se / y);
    double width = exp(law_normal_quantile(0.5 + 0.5 * INTERVAL_LEVEL) * se);
    return (struct interval){x / y, x / y / width, x / y * width};
}

static void compare_with_best(struct analysis_ranking *ranking, enum results_error error)
{
    const struct results_cell *best = ranking->items[0].cell;
    double *of_best = errors_of(best, error, ranking->noise);
    ranking->items[0].ratio = (struct interval){1.0, 1.0, 1.0};
    for (size_t i = 1; i < ranking->count; i++) {
        struct analysis_rank *rank = &ranking->items[i];
        double *errors = errors_of(rank->cell, error, ranking->noise);
        rank->ratio = interval_log_ratio(errors, rank->cell->run_count, of_best,
                                         best->run_count);
        if (ranking->by_bars)
            rank->ratio = ratio_by_bars(rank->cell->runs, best->runs);
        rank->is_apart = rank->ratio.lo > 1.0;
        mem_free(errors);
    }
    mem_free(of_best);
}

void analysis_ranking_make(const struct results *results, const struct families *families,
                           const struct results_cell *group, enum results_error error,
                           struct analysis_ranking *ranking)
{
    *ranking = (struct analysis_ranking){
        .items = mem_alloc(results->cell_count, sizeof *ranking->items)};
    take_cells(results, families, group, error, false, ranking);
    if (ranking->count < 2)
        take_cells(results, families, group, error, true, ranking);
    if (ranking->count == 0)
        return;
    double noise = ranking->items[0].cell->noise[error];
    ranking->noise = is_clear_of(ranking, error, noise) ? noise : 0.0;
    ranking->seeds = ranking->items[0].cell->run_count;
    for (size_t i = 0; i < ranking->count; i++) {
        struct analysis_rank *rank = &ranking->items[i];
        double *errors = errors_of(rank->cell, error, ranking->noise);
        rank->error = interval_log_mean(errors, rank->cell->run_count).value;
        mem_free(errors);
        if (rank->cell->run_count < ranking->seeds)
            ranking->seeds = rank->cell->run_count;
    }
    ranking->by_bars = error == RESULTS_ESTIMATED && ranking->seeds == 1;
    qsort(ranking->items, ranking->count, sizeof *ranking->items, compare_ranks);
    compare_with_best(ranking, error);
}

void analysis_ranking_deinit(struct analysis_ranking *ranking)
{
    mem_free(ranking->items);
    *ranking = (struct analysis_ranking){0};
}
