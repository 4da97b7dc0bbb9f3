/* The outcome in words, and regret over all cells: what the page begins with. */
#include "base/mem.h"
#include "analysis/analysis_why.h"
#include "analysis/analysis_words.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>

/* The errors that the outcome is told by, the one of plots and tables first. */
static const enum results_error *errors_told(const struct report *report)
{
    static const enum results_error orders[RESULTS_ERRORS][2] = {
        [RESULTS_RELMSE] = {RESULTS_RELMSE, RESULTS_RELMSE_TRIMMED},
        [RESULTS_RELMSE_TRIMMED] = {RESULTS_RELMSE_TRIMMED, RESULTS_RELMSE},
        [RESULTS_MSE] = {RESULTS_MSE, RESULTS_RELMSE_TRIMMED},
        [RESULTS_ESTIMATED] = {RESULTS_ESTIMATED, RESULTS_RELMSE_TRIMMED},
    };
    return orders[report->options->error];
}

/* --- who is best ------------------------------------------------------------------ */

static void append_sentence(struct report *report, const char *before,
                            const struct text *words)
{
    text_append(&report->html, "<p>%s", before);
    html_text(&report->html, words->data);
    text_append(&report->html, ".</p>");
}

/* Of the errors the first is told even if no run has it. */
static void append_best(struct report *report, const struct results_cell *group,
                        enum results_error error, bool is_first)
{
    struct text words = {0}, why = {0};
    struct analysis_ranking ranking;
    analysis_ranking_make(report->results, &report->families, group, error, &ranking);
    analysis_append_best(&words, &ranking);
    char *by = text_format("By %s: ", analysis_error_words(error));
    if (is_first || ranking.count > 0)
        append_sentence(report, by, &words);
    if (is_first)
        analysis_append_why(&why, report->results, &ranking, error);
    if (why.length > 0)
        append_sentence(report, "Why: ", &why);
    analysis_ranking_deinit(&ranking);
    mem_free(words.data);
    mem_free(why.data);
    mem_free(by);
}

static void append_group(struct report *report, const struct results_cell *group)
{
    const enum results_error *errors = errors_told(report);
    struct text name = {0};
    analysis_append_group(&name, group);
    text_append(&report->html, "<dt>");
    html_text(&report->html, name.data);
    text_append(&report->html, "</dt><dd>");
    for (int e = 0; e < 2; e++)
        append_best(report, group, errors[e], e == 0);
    text_append(&report->html, "</dd>\n");
    mem_free(name.data);
}

/* --- regret ----------------------------------------------------------------------- */

static void append_regret_words(struct report *report,
                                const struct analysis_summary *summary,
                                enum results_error error)
{
    struct text words = {0};
    analysis_append_regret(&words, summary);
    if (words.length > 0) {
        text_append(&report->html, "<p>By %s: ", analysis_error_words(error));
        html_text(&report->html, words.data);
        text_append(&report->html, ".</p>");
    }
    mem_free(words.data);
}

static const struct analysis_policy *find(const struct analysis_summary *summary,
                                          const char *name)
{
    for (size_t i = 0; i < summary->count; i++)
        if (text_equal(summary->items[i].name, name))
            return &summary->items[i];
    return NULL;
}

static void policy_cells(struct text *html, const struct analysis_policy *policy)
{
    html_cell_count(html, policy ? policy->cells : 0);
    html_cell(html, policy ? policy->mean : (double)NAN, 3);
    html_cell(html, policy ? policy->worst : (double)NAN, 3);
    html_cell_sentence(html, policy ? policy->worst_name : "");
}

static void append_regret_table(struct report *report,
                                const struct analysis_summary summaries[2])
{
    struct text *html = &report->html;
    const enum results_error *errors = errors_told(report);
    struct text caption = {0};
    text_append(&caption,
                "<b>Regret over all cells</b>, of each way to choose p<sub>l</sub>: the "
                "error over that of the best manual value of the cell (scene, budget and "
                "method), which is chosen by other seeds than it is judged by, at equal "
                "%s, less the reference&rsquo;s noise. Geometric mean and highest; first "
                "by %s, then by %s. Cells: those whose errors are above the "
                "reference&rsquo;s noise, of %zu.",
                report_axis_words(report), analysis_error_words(errors[0]),
                analysis_error_words(errors[1]), summaries[0].cells);
    report_open_table(html, "regrets", caption.data, summaries[0].count);
    int at = html_head(html, "p<sub>l</sub>", "a rule, or the same value everywhere", 0,
                       1, false);
    for (int e = 0; e < 2; e++) {
        at = html_head(html, "cells", "whose regret is known", at, 1, true);
        at = html_head(html, "mean", "geometric", at, 1, true);
        at = html_head(html, "worst", "highest regret", at, 1, true);
        at = html_head(html, "in", "the cell with the highest regret", at, 1, false);
    }
    report_end_heads(html);
    for (size_t i = 0; i < summaries[0].count; i++) {
        text_append(html, "<tr><td class=\"method\">");
        html_text(html, summaries[0].items[i].name);
        text_append(html, "</td>");
        policy_cells(html, &summaries[0].items[i]);
        policy_cells(html, find(&summaries[1], summaries[0].items[i].name));
        text_append(html, "</tr>\n");
    }
    report_close_table(html);
    mem_free(caption.data);
}

static void append_regrets(struct report *report)
{
    struct text *html = &report->html;
    const enum results_error *errors = errors_told(report);
    struct analysis_summary summaries[2];
    for (int e = 0; e < 2; e++)
        analysis_summary_make(report->results, &report->families, report->options->axis,
                              errors[e], &summaries[e]);
    if (summaries[0].count > 0) {
        text_append(html, "<dl class=\"words\"><dt>Regret of p<sub>l</sub></dt><dd>");
        for (int e = 0; e < 2; e++)
            append_regret_words(report, &summaries[e], errors[e]);
        text_append(html, "</dd></dl>\n");
        append_regret_table(report, summaries);
    }
    for (int e = 0; e < 2; e++)
        analysis_summary_deinit(&summaries[e]);
}

void report_append_outcome(struct report *report)
{
    struct text *html = &report->html;
    const struct results *results = report->results;
    text_append(html,
                "<section id=\"outcome\"><h2>Outcome</h2>\n"
                "<p class=\"lead\">Errors at the end of the runs. In brackets: 95 %% "
                "intervals over seeds.</p>\n<dl class=\"words\">\n");
    for (size_t i = 0; i < results->cell_count; i++)
        if (report_begins_group(results, i))
            append_group(report, &results->cells[i]);
    text_append(html, "</dl>\n");
    append_regrets(report);
    text_append(html, "</section>\n");
}
