#include "base/mem.h"
#include "analysis/analysis_drift.h"
#include "analysis/analysis_split.h"
#include "lab/reference.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>

/* --- statistics of start and run -------------------------------------------------- */

static void drift_row(struct report *report, const struct results_cell *cell,
                      const struct analysis_drift *drift)
{
    struct text *html = &report->html;
    report_begin_row(report, cell);
    html_cell_text(html, drift->name);
    html_cell_interval(html, &drift->start, 4);
    html_cell_interval(html, &drift->whole, 4);
    html_cell_interval(html, &drift->difference, 4);
    html_cell(html, drift->p, 3);
    text_append(html, "</tr>\n");
}

static size_t append_drift_rows(struct report *report, const char *scene, bool dry)
{
    size_t count = 0;
    for (size_t i = 0; i < report->results->cell_count; i++) {
        const struct results_cell *cell = &report->results->cells[i];
        struct analysis_drift drifts[ANALYSIS_DRIFTS];
        if (!text_equal(cell->scene, scene) ||
            !analysis_drift(report->results, cell, drifts))
            continue;
        for (int k = 0; k < ANALYSIS_DRIFTS; k++) {
            if (drifts[k].seeds == 0)
                continue;
            count++;
            if (!dry)
                drift_row(report, cell, &drifts[k]);
        }
    }
    return count;
}

void report_append_drifts(struct report *report, const char *scene, int number)
{
    size_t rows = append_drift_rows(report, scene, true);
    struct text *html = &report->html;
    if (rows == 0)
        return;
    char *id = text_format("drift-%d", number);
    text_append(html,
                "<details><summary>Statistics of the measured start against those "
                "of the whole run (%zu rows)</summary>\n",
                rows);
    report_open_table(
        html, id,
        "<b>Does the start speak for the run?</b> Means over seeds with 95 % t "
        "intervals; the difference is paired by seed, p is of its two-sided "
        "t-test. The whole run holds the start in it. p_l is what the rule makes "
        "of the other three, whether or not the run went by it.",
        rows);
    int at = report_cell_heads(report, scene);
    at = html_head(html, "statistic", "its name in runs.csv", at, 1, false);
    at = html_head(html, "start", "measured start", at, 2, true);
    at = html_head(html, "whole run", "the start in it", at, 2, true);
    at = html_head(html, "difference", "whole run less start", at, 2, true);
    html_head(html, "p", "of the paired t-test, two-sided", at, 1, true);
    report_end_heads(html);
    append_drift_rows(report, scene, false);
    report_close_table(html);
    text_append(html, "</details>\n");
    mem_free(id);
}

/* --- bias and variance ------------------------------------------------------------ */

static const char *verdict(const struct analysis_split *split)
{
    return split->errors_from_blocks    ? "2 seeds: not tested"
           : split->bias_is_significant ? "significant"
                                        : "";
}

static void split_row(struct report *report, const struct results_cell *cell,
                      const struct analysis_split *split)
{
    struct text *html = &report->html;
    report_begin_row(report, cell);
    html_cell_count(html, split->seeds);
    html_cell_error(html, split->total, split->total_se, HTML_SIGNIFICANT);
    html_cell_error(html, split->variance, split->variance_se, HTML_SIGNIFICANT);
    html_cell_error(html, split->bias2, split->bias2_se, HTML_SIGNIFICANT);
    html_cell(html, split->bias2_hi, HTML_SIGNIFICANT);
    html_cell(html, split->noise_is_known ? split->noise : (double)NAN, HTML_SIGNIFICANT);
    html_cell_text(html, verdict(split));
    text_append(html, "</tr>\n");
}

static void split_heads(struct report *report, const char *scene)
{
    struct text *html = &report->html;
    int at = report_cell_heads(report, scene);
    at = html_head(html, "seeds", "pictures", at, 1, true);
    at = html_head(html, "total", "arithmetic mean over seeds", at, 2, true);
    at = html_head(html, "variance", "of one run", at, 2, true);
    at = html_head(html, "bias&sup2;", "without the reference's noise, if it is known",
                   at, 2, true);
    at = html_head(html, "at most", "upper end of the 95 % interval of bias squared", at,
                   1, true);
    at = html_head(html, "noise", "of the reference", at, 1, true);
    html_head(html, "bias", "one-sided t-test at 5 %", at, 1, false);
}

static const struct report_picture *picture_of(const struct report *report,
                                               const struct results_cell *cell)
{
    for (size_t i = 0; i < report->pictures.count; i++)
        if (report->pictures.items[i].cell == cell)
            return &report->pictures.items[i];
    return NULL;
}

/* The reference of the cell, kept from one cell to the next: most share it. */
struct kept {
    int index;                  /* among the pictures; -1: none */
    struct reference reference; /* all zero: none */
};

/* NULL if there is none. */
static const struct reference *reference_of(const struct report *report,
                                            const struct results_cell *cell,
                                            struct kept *kept)
{
    const struct report_picture *picture = picture_of(report, cell);
    int index = picture ? picture->reference : -1;
    if (index != kept->index) {
        reference_deinit(&kept->reference);
        kept->index = index;
        if (index >= 0)
            (void)reference_read(report->pictures.items[index].path, NULL,
                                 &kept->reference, NULL);
    }
    return kept->reference.picture ? &kept->reference : NULL;
}

static size_t append_split_rows(struct report *report, const char *scene)
{
    struct kept kept = {.index = -1};
    size_t count = 0;
    for (size_t i = 0; i < report->results->cell_count; i++) {
        const struct results_cell *cell = &report->results->cells[i];
        struct analysis_split split;
        if (!text_equal(cell->scene, scene) || cell->run_count < 2)
            continue;
        const struct reference *reference = reference_of(report, cell, &kept);
        if (!reference ||
            !analysis_split_cell(report->results, cell, reference, &split, NULL))
            continue;
        split_row(report, cell, &split);
        count++;
    }
    reference_deinit(&kept.reference);
    return count;
}

/* The rows are made apart, for it takes all the pictures to know how many there are. */
void report_append_splits(struct report *report, const char *scene, int number)
{
    struct text page = report->html;
    report->html = (struct text){0};
    size_t count = append_split_rows(report, scene);
    struct text rows = report->html, *html = &report->html;
    report->html = page;
    if (count > 0) {
        char *id = text_format("split-%d", number);
        text_append(html,
                    "<details><summary>Error as bias and variance (%zu rows)"
                    "</summary>\n",
                    count);
        report_open_table(
            html, id,
            "<b>Bias and variance</b> from the pictures of all seeds. Squared errors are "
            "weighted as in relMSE, but by the brightness of a pixel&rsquo;s neighbours "
            "in "
            "the reference, so that the weight does not depend on the pixel&rsquo;s own "
            "noise: total = bias&sup2; + variance + noise of the reference. All are "
            "unbiased estimates, so bias&sup2; may come out negative; &plusmn; is the "
            "standard error by the jackknife over seeds, with two seeds from blocks of "
            "pixels (which does not see what all pixels of a run share).",
            count);
        split_heads(report, scene);
        report_end_heads(html);
        text_append(html, "%s", rows.data);
        report_close_table(html);
        text_append(html, "</details>\n");
        mem_free(id);
    }
    mem_free(rows.data);
}
