/* Common wording for cells, errors and axes. */
#include "report/report_html.h"
#include "report/report_parts.h"

bool report_begins_scene(const struct results *results, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (text_equal(results->cells[k].scene, results->cells[i].scene))
            return false;
    return true;
}

bool report_begins_group(const struct results *results, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (panel_same_group(&results->cells[k], &results->cells[i]))
            return false;
    return true;
}

const char *report_error_title(enum results_error error)
{
    static const char *const names[RESULTS_ERRORS] = {
        [RESULTS_RELMSE] = "relMSE",
        [RESULTS_RELMSE_TRIMMED] = "trimmed relMSE",
        [RESULTS_MSE] = "MSE",
        [RESULTS_ESTIMATED] = "estimated relMSE",
    };
    return names[error];
}

const char *report_error_name(const struct report *report)
{
    return report_error_title(report->options->error);
}

const char *report_axis_words(const struct report *report)
{
    static const char *const words[RESULTS_AXES] = {
        [RESULTS_WALL] = "wall time",
        [RESULTS_CPU] = "CPU time",
        [RESULTS_MUTATIONS] = "mutations per pixel",
    };
    return words[report->options->axis];
}

bool report_has_budgets(const struct results *results, const char *scene)
{
    const struct results_cell *first = NULL;
    for (size_t i = 0; i < results->cell_count; i++) {
        const struct results_cell *cell = &results->cells[i];
        if (scene && !text_equal(cell->scene, scene))
            continue;
        first = first ? first : cell;
        if (cell->budget != first->budget ||
            cell->budget_is_time != first->budget_is_time)
            return true;
    }
    return false;
}

void report_append_method(struct text *html, const struct results_cell *cell)
{
    html_text(html, cell->label);
    if (cell->is_biased)
        text_append(html, " <span class=\"biased\">biased</span>");
}
