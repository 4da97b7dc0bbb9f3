/* What the error of a method consists of: the speed of its paths and what one is worth.
 */
#include "base/mem.h"
#include "analysis/analysis_why.h"
#include "report/report_html.h"
#include "report/report_parts.h"

/* Cells of the scene; 0 if all are by the same integrator. */
static size_t count_rows(const struct results *results, const char *scene)
{
    const struct results_cell *first = NULL;
    size_t count = 0;
    bool several = false;
    for (size_t i = 0; i < results->cell_count; i++) {
        const struct results_cell *cell = &results->cells[i];
        if (!text_equal(cell->scene, scene))
            continue;
        first = first ? first : cell;
        several = several || !text_equal(cell->integrator, first->integrator);
        count++;
    }
    return several ? count : 0;
}

static void append_heads(struct report *report, const char *scene)
{
    struct text *html = &report->html;
    int at = report_cell_heads(report, scene);
    at = html_head(html, "estimated relMSE", "by the run's own error bars", at, 2, true);
    at = html_head(html, "million paths per CPU s", "mutations or samples", at, 1, true);
    at = html_head(html, "error of a path", "error times paths per pixel", at, 1, true);
    at = html_head(html, "error \u00d7 CPU s", "error at equal CPU time, relative", at, 1,
                   true);
    at = html_head(html, "acceptance", "mean acceptance probability of all mutations", at,
                   1, true);
    at = html_head(html, "failures", "share of proposals that carry no light", at, 1,
                   true);
    at = html_head(html, "brightness", "b over its median of all methods", at, 2, true);
    at = html_head(html, "verdict", "of the first run", at, 1, false);
    html_head(html, "blind to", "light that the method cannot sample", at, 1, false);
}

static void append_row(struct report *report, const struct results_cell *cell)
{
    struct text *html = &report->html;
    struct analysis_why why;
    analysis_why_make(report->results, cell, report->options->error, &why);
    report_begin_row(report, cell);
    html_cell_error(html, why.estimated, why.estimated_se, HTML_SIGNIFICANT);
    html_cell(html, why.speed * 1e-6, 3);
    html_cell(html, why.error_a_path, HTML_SIGNIFICANT);
    html_cell(html, why.error_a_path / why.speed * why.pixels, HTML_SIGNIFICANT);
    html_cell(html, why.acceptance, 3);
    html_cell(html, why.failure_rate, 3);
    html_cell_error(html, why.brightness, why.brightness * why.b_se / why.b, 4);
    html_cell_text(html, why.verdict);
    html_cell_sentence(html, why.blind_to);
    text_append(html, "</tr>\n");
}

void report_append_why(struct report *report, const char *scene, int number)
{
    size_t rows = count_rows(report->results, scene);
    if (rows == 0)
        return;
    struct text caption = {0};
    char *id = text_format("why-%d", number);
    text_append(
        &caption,
        "<b>What the errors consist of.</b> Error of a path: %s times paths per "
        "pixel, as if the error fell as 1/n; over the speed it is the error at "
        "equal CPU time. Estimated relMSE: by the spread of each run&rsquo;s parts, "
        "&plusmn; its standard error; it does not see light that the run never "
        "found. Brightness: far from 1, beyond its standard error, means that "
        "light is missing or that few paths carry much of it.",
        report_error_name(report));
    report_open_table(&report->html, id, caption.data, rows);
    append_heads(report, scene);
    report_end_heads(&report->html);
    for (size_t i = 0; i < report->results->cell_count; i++)
        if (text_equal(report->results->cells[i].scene, scene))
            append_row(report, &report->results->cells[i]);
    report_close_table(&report->html);
    mem_free(caption.data);
    mem_free(id);
}
