#include "base/mem.h"
#include "analysis/analysis_slope.h"
#include "analysis/analysis_speedup.h"
#include "analysis/analysis_curve.h"
#include "image/metric.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>

/* --- errors ------------------------------------------------------------------------ */

static double mean_of(const struct report *report, const struct results_cell *cell,
                      const char *column)
{
    double sum = 0.0;
    for (size_t i = 0; i < cell->run_count; i++)
        sum += results_number(report->results, &cell->runs[i], column);
    return sum / (double)cell->run_count;
}

static struct interval interval_of(const struct report *report,
                                   const struct results_cell *cell, const char *column)
{
    double *values = mem_alloc(cell->run_count, sizeof *values);
    for (size_t i = 0; i < cell->run_count; i++)
        values[i] = results_number(report->results, &cell->runs[i], column);
    struct interval interval = interval_mean(values, cell->run_count);
    mem_free(values);
    return interval;
}

static bool is_baseline(const struct report *report, const struct results_cell *cell)
{
    const char *wanted = report->options->baseline;
    return wanted ? text_equal(cell->label, wanted) : cell->is_auto;
}

/* The baseline of this cell's speed-ups, of the same scene and budget. */
static const struct results_cell *baseline_of(const struct report *report,
                                              const struct results_cell *cell)
{
    const struct results *results = report->results;
    const struct results_cell *first = NULL;
    for (size_t i = 0; i < results->cell_count; i++) {
        const struct results_cell *other = &results->cells[i];
        if (!panel_same_group(cell, other))
            continue;
        if (is_baseline(report, other))
            return other;
        first = first ? first : other;
    }
    return report->options->baseline ? NULL : first;
}

/* The error that was asked for, then trimmed and full relMSE if they are others. */
static int errors_shown(const struct report *report, enum results_error shown[3])
{
    static const enum results_error always[] = {RESULTS_RELMSE_TRIMMED, RESULTS_RELMSE};
    int count = 0;
    shown[count++] = report->options->error;
    for (int i = 0; i < 2; i++)
        if (always[i] != shown[0])
            shown[count++] = always[i];
    return count;
}

static void error_heads(struct report *report, const char *scene)
{
    struct text *html = &report->html;
    enum results_error shown[3];
    int at = report_cell_heads(report, scene), count = errors_shown(report, shown);
    at = html_head(html, "seeds", "finished runs", at, 1, true);
    for (int e = 0; e < count; e++) {
        at = html_head(html, report_error_title(shown[e]),
                       "at the end of the runs: geometric mean over seeds", at, 2, true);
        at = html_head(html, "less noise", "the reference's noise subtracted", at, 1,
                       true);
    }
    at = html_head(html, "slope", "of log error against log time, later half", at, 2,
                   true);
    at = html_head(html, "speed-up",
                   "time of the baseline to the same error, over its own", at, 2, true);
    at = html_head(html, "mean ratio", "luminance of picture over reference", at, 2,
                   true);
    at = html_head(html, "b", "brightness: mean luminance of the picture", at, 2, true);
    at = html_head(html, "acceptance", "mean acceptance probability of all mutations", at,
                   1, true);
    html_head(html, "p<sub>l</sub>", "large-step probability, mean over seeds", at, 2,
              true);
}

static void speedup_cells(struct report *report, const struct results_cell *cell)
{
    const struct results_cell *baseline = baseline_of(report, cell);
    if (baseline == cell) {
        text_append(&report->html, "<td class=\"number\" data-value=\"1\">1.00</td>"
                                   "<td class=\"range\">baseline</td>");
        return;
    }
    struct analysis_speedup speedup = {.ratio = interval_nothing()};
    if (baseline)
        speedup = analysis_speedup(cell, baseline, report->options->axis,
                                   report->options->error);
    html_cell_interval(&report->html, &speedup.ratio, 2);
}

static void error_row(struct report *report, const struct results_cell *cell)
{
    struct text *html = &report->html;
    enum results_error shown[3];
    int count = errors_shown(report, shown);
    struct analysis_slope slope = analysis_slope(cell, report->options->axis,
                                                 report->options->error);
    struct interval ratio = interval_of(report, cell, "mean_ratio");
    struct interval p_l = {cell->p_l_mean, mean_of(report, cell, "p_l_lo"),
                           mean_of(report, cell, "p_l_hi")};
    if (!cell->is_auto)
        p_l = (struct interval){p_l.value, (double)NAN, (double)NAN};
    report_begin_row(report, cell);
    html_cell_count(html, cell->run_count);
    for (int e = 0; e < count; e++) {
        struct analysis_point end = analysis_final(cell, shown[e]);
        html_cell_interval(html, &end.raw, HTML_SIGNIFICANT);
        html_cell(html,
                  cell->noise_is_known[shown[e]] ? end.raw.value - cell->noise[shown[e]]
                                                 : (double)NAN,
                  HTML_SIGNIFICANT);
    }
    html_cell_interval(html, &slope.raw, 2);
    speedup_cells(report, cell);
    html_cell_interval(html, &ratio, 4);
    html_cell_error(html, mean_of(report, cell, "b"), mean_of(report, cell, "b_se"),
                    HTML_SIGNIFICANT);
    html_cell(html, mean_of(report, cell, "acceptance"), 3);
    html_cell_interval(html, &p_l, 3);
    text_append(html, "</tr>\n");
}

static size_t count_of(const struct report *report, const char *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < report->results->cell_count; i++)
        count += text_equal(report->results->cells[i].scene, scene);
    return count;
}

static void error_caption(const struct report *report, struct text *caption)
{
    const char *error = report_error_name(report);
    text_append(
        caption,
        "<b>Errors at the end of the runs.</b> Trimmed relMSE is "
        "relMSE %s. Geometric means over the seeds with the 95 %% t "
        "interval of the mean of logarithms; the reference&rsquo;s own noise is still in "
        "it, and subtracted in the column beside it. Slope: least squares of log %s "
        "against log %s "
        "over the later half of the curve, &minus;1 for independent samples. "
        "Speed-up: how much faster than the baseline it reaches the final error "
        "of the worse of the two, with a 95 %% bootstrap interval over "
        "seeds. Mean ratio: 95 %% t interval. b: mean of the runs&rsquo; estimates "
        "&plusmn; mean of their standard errors. p<sub>l</sub>: for automatic "
        "cells with the mean ends of the 95 %% interval that the measured start "
        "gives.",
        METRIC_TRIM_WORDS, error, report_axis_words(report));
}

static void append_errors(struct report *report, const char *scene, int number)
{
    struct text caption = {0};
    char *id = text_format("errors-%d", number);
    error_caption(report, &caption);
    report_open_table(&report->html, id, caption.data, count_of(report, scene));
    error_heads(report, scene);
    report_end_heads(&report->html);
    for (size_t i = 0; i < report->results->cell_count; i++)
        if (text_equal(report->results->cells[i].scene, scene))
            error_row(report, &report->results->cells[i]);
    report_close_table(&report->html);
    mem_free(id);
    mem_free(caption.data);
}

void report_append_cells(struct report *report, const char *scene)
{
    int number = 0;
    for (size_t i = 0; !text_equal(report->results->cells[i].scene, scene); i++)
        number += report_begins_scene(report->results, i);
    append_errors(report, scene, number);
    report_append_why(report, scene, number);
    report_append_drifts(report, scene, number);
    report_append_splits(report, scene, number);
}
