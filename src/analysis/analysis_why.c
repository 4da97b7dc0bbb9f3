#include "analysis/analysis_why.h"

#include "base/mem.h"
#include "math/order.h"

#include <math.h>

/* A brightness is off if it differs from the median by so many standard errors and by
 * more than this share: biases of estimated standard errors are below it. */
#define OFF_ERRORS 4.0
#define OFF_SHARE  0.01

/* Median of b over the methods of the cell's scene and budget. */
static double median_brightness(const struct results *results,
                                const struct results_cell *cell)
{
    double *b = mem_alloc(results->cell_count, sizeof *b);
    size_t count = 0;
    for (size_t i = 0; i < results->cell_count; i++)
        if (results_same_budget(&results->cells[i], cell)) {
            b[count] = results_mean(results, &results->cells[i], "b");
            count += isfinite(b[count]) ? 1 : 0;
        }
    sort_ascending(b, count);
    double median = count == 0 ? (double)NAN : median_of_sorted(b, count);
    mem_free(b);
    return median;
}

static double speed_of(const struct results *results, const struct results_cell *cell)
{
    double sum = 0.0;
    for (size_t i = 0; i < cell->run_count; i++)
        sum += results_number(results, &cell->runs[i], "paths") /
               results_number(results, &cell->runs[i], "seconds_cpu");
    return sum / (double)cell->run_count;
}

static double error_a_path(const struct results *results, const struct results_cell *cell,
                           enum results_error error)
{
    double sum = 0.0;
    for (size_t i = 0; i < cell->run_count; i++)
        sum += log(cell->runs[i].error[error] *
                   results_number(results, &cell->runs[i], "mutations_per_pixel"));
    return exp(sum / (double)cell->run_count);
}

void analysis_why_make(const struct results *results, const struct results_cell *cell,
                       enum results_error error, struct analysis_why *why)
{
    double median = median_brightness(results, cell);
    double seeds = sqrt((double)cell->run_count);
    *why = (struct analysis_why){
        .pixels = results_mean(results, cell, "width") *
                  results_mean(results, cell, "height"),
        .speed = speed_of(results, cell),
        .error_a_path = error_a_path(results, cell, error),
        .estimated = results_mean(results, cell, "relmse_estimated"),
        .estimated_se = results_mean(results, cell, "relmse_estimated_se") / seeds,
        .acceptance = results_mean(results, cell, "acceptance"),
        .failure_rate = results_mean(results, cell, "failure_rate"),
        .b = results_mean(results, cell, "b"),
        .b_se = results_mean(results, cell, "b_se") / seeds,
        .verdict = results_text(results, &cell->runs[0], "verdict"),
        .blind_to = results_text(results, &cell->runs[0], "blind_to"),
    };
    why->brightness = why->b / median;
    why->is_off = fabs(why->b - median) > OFF_ERRORS * why->b_se &&
                  fabs(why->brightness - 1.0) > OFF_SHARE;
}

/* --- in words -------------------------------------------------------------------- */

static void append_doubt(struct text *text, const char *label,
                         const struct analysis_why *why)
{
    if (why->verdict[0] && !text_equal(why->verdict, "converged"))
        text_append(text,
                    "; %s: the verdict is \"%s\", so its error bars may be too "
                    "narrow",
                    label, why->verdict);
    if (why->is_off)
        text_append(text,
                    "; %s is %.3g times as bright as the median of all methods, beyond "
                    "its standard error: it may lack light, or have found too much of it",
                    label, why->brightness);
    if (why->blind_to[0])
        text_append(text, "; %s cannot sample %s", label, why->blind_to);
}

/* The next method by another integrator than the best one's. */
static const struct analysis_rank *next_of(const struct analysis_ranking *ranking)
{
    for (size_t i = 1; i < ranking->count; i++)
        if (!text_equal(ranking->items[i].cell->integrator,
                        ranking->items[0].cell->integrator))
            return &ranking->items[i];
    return NULL;
}

void analysis_append_why(struct text *text, const struct results *results,
                         const struct analysis_ranking *ranking, enum results_error error)
{
    const struct analysis_rank *next = next_of(ranking);
    struct analysis_why best, other;
    if (next == NULL)
        return;
    const struct results_cell *first = ranking->items[0].cell;
    analysis_why_make(results, first, error, &best);
    analysis_why_make(results, next->cell, error, &other);
    double speed = best.speed / other.speed;
    double error_a_path = best.error_a_path / other.error_a_path;
    text_append(text,
                "%s makes %.3g times as many paths per CPU second as %s, and has %.3g "
                "times its error per path: %.3g times its error at equal CPU time",
                first->label, speed, next->cell->label, error_a_path,
                error_a_path / speed);
    append_doubt(text, first->label, &best);
    append_doubt(text, next->cell->label, &other);
}
