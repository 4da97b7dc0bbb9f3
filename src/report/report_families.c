#include "base/mem.h"
#include "analysis/analysis_optimum.h"
#include "analysis/analysis_regret.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>

static const struct results_cell *member_of(const struct family *family)
{
    return family->automatic ? family->automatic : family->manual[0];
}

static void family_cells(struct report *report, const struct family *family)
{
    struct text *html = &report->html;
    const struct results_cell *member = member_of(family);
    text_append(html, "<tr><td>");
    html_text(html, member->scene);
    text_append(html, "</td><td class=\"method\">");
    html_text(html, family->name);
    text_append(html, "%s</td>",
                member->is_biased ? " <span class=\"biased\">biased</span>" : "");
    if (!report_has_budgets(report->results, NULL))
        return;
    char *budget = results_budget(member);
    html_cell_text(html, budget);
    mem_free(budget);
}

/* The best values: {0.05, 0.1}. */
static void append_set(struct text *html, const struct analysis_optimum *optimum)
{
    int count = 0;
    text_append(html, "<td class=\"wrap\">");
    for (size_t i = 0; i < optimum->count; i++)
        if (optimum->values[i].in_set)
            text_append(html, "%s%g", count++ ? ", " : "", optimum->values[i].p_l);
    text_append(html, "%s</td>", count ? "" : "\u2013");
}

static const char *inside(const struct analysis_optimum *optimum)
{
    if (!(optimum->lo <= optimum->hi) || isnan(optimum->p_l_auto))
        return "";
    return optimum->auto_inside              ? "inside"
           : optimum->p_l_auto < optimum->lo ? "below"
                                             : "above";
}

static void family_row(struct report *report, const struct family *family)
{
    struct text *html = &report->html;
    enum results_axis axis = report->options->axis;
    enum results_error error = report->options->error;
    struct analysis_regret regret = {.regret = interval_nothing(), .why = ""};
    struct analysis_optimum optimum;
    if (family->automatic)
        regret = analysis_regret(family, axis, error);
    analysis_optimum_make(family, axis, error, &optimum);
    family_cells(report, family);
    html_cell_count(html, optimum.seeds);
    html_cell(html, optimum.x, HTML_SIGNIFICANT);
    html_cell_interval(html, &regret.regret, 2);
    html_cell(html, family->automatic ? regret.naive : (double)NAN, 2);
    html_cell(html, optimum.p_l_auto, 3);
    append_set(html, &optimum);
    html_cell_text(html, inside(&optimum));
    html_cell_sentence(html, optimum.why[0] ? optimum.why : regret.why);
    text_append(html, "</tr>\n");
    analysis_optimum_deinit(&optimum);
}

static void family_heads(struct report *report)
{
    struct text *html = &report->html;
    int at = html_head(html, "scene", "label in the experiment", 0, 1, false);
    at = html_head(html, "method", "the label without p_l", at, 1, false);
    if (report_has_budgets(report->results, NULL))
        at = html_head(html, "budget", "of each run", at, 1, false);
    at = html_head(html, "seeds", "in common to all that are compared", at, 1, true);
    at = html_head(html, "at", "time or work at which they are compared", at, 1, true);
    at = html_head(html, "regret",
                   "error of the automatic over that of the best manual p_l", at, 2,
                   true);
    at = html_head(html, "naive", "chosen and judged on the same seeds: too high", at, 1,
                   true);
    at = html_head(html, "automatic p<sub>l</sub>", "mean over seeds", at, 1, true);
    at = html_head(html, "best p<sub>l</sub>", "manual values that no test shuts out", at,
                   1, false);
    at = html_head(html, "automatic is", "against the range of best values", at, 1,
                   false);
    html_head(html, "remark", "what is missing", at, 1, false);
}

static bool is_comparison(const struct family *family)
{
    return family->manual_count + (family->automatic != NULL) > 1;
}

void report_append_families(struct report *report)
{
    struct text *html = &report->html;
    size_t rows = 0;
    for (size_t i = 0; i < report->families.count; i++)
        rows += is_comparison(&report->families.items[i]);
    if (rows == 0)
        return;
    text_append(
        html,
        "<section id=\"p_l\"><h2>Automatic against manual p<sub>l</sub></h2>\n"
        "<div class=\"table\" tabindex=\"0\"><table id=\"families\">\n<caption>"
        "<b>What the automatic p<sub>l</sub> costs, at equal %s.</b> Regret: "
        "expected %s of the automatic run over that of the best manual value, "
        "which is chosen on one half of the seeds and judged on the other (so it "
        "errs low, if at all, where the naive figure errs high), less the noise "
        "of the reference where that is known; 95 %% bootstrap interval over "
        "seeds; 1 is as good as the best. Best p<sub>l</sub>: manual values whose "
        "error is not significantly above the lowest (one-sided paired t-tests, "
        "&Scaron;id&aacute;k, 5 %% together).</caption>\n<thead><tr>",
        report_axis_words(report), report_error_name(report));
    family_heads(report);
    text_append(html, "</tr></thead>\n<tbody>\n");
    for (size_t i = 0; i < report->families.count; i++)
        if (is_comparison(&report->families.items[i]))
            family_row(report, &report->families.items[i]);
    text_append(html, "</tbody></table></div></section>\n");
}
