#include "base/mem.h"
#include "image/metric.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>
#include <string.h>

/* Values of a column that are listed; of more, their number. */
#define MOST_VALUES 8

struct fact {
    const char *title, *column;
};

static const struct fact settings[] = {
    {"scene files", "scene"},
    {"integrators", "integrator"},
    {"mode of pfmlt, rjmlt", "mode"},
    {"kernel", "kernel"},
    {"estimator", "estimator"},
    {"path builder", "builder"},
    {"direct light", "direct"},
    {"allocation", "allocation"},
    {"rule", "rule"},
    {"one p_l for", "per"},
    {"p_l set", "p_l_source"},
    {"longest path, edges", "max_depth"},
    {"width", "width"},
    {"height", "height"},
    {"budget, s", "budget_seconds"},
    {"budget, per pixel", "budget_mutations_per_pixel"},
    {"chains", "chains"},
    {"bootstrap paths", "bootstrap_paths"},
    {"start, share of budget", "start"},
    {"seeds", "seed"},
    {NULL, NULL},
};

static const struct fact environment[] = {
    {"commit", "commit"}, {"compiler", "compiler"}, {"flags", "flags"},
    {"CPU", "cpu_model"}, {"threads", "threads"},   {"rays (Embree)", "rays"},
    {NULL, NULL},
};

/* --- distinct values -------------------------------------------------------------- */

struct values {
    const char *items[MOST_VALUES];
    size_t count; /* all, also those that are not kept */
};

/* Whether the column has a value; of the two budgets one is 0. */
static bool is_known(const char *column, const char *value)
{
    bool none = strncmp(column, "budget_", strlen("budget_")) == 0 &&
                text_equal(value, "0");
    return value[0] != '\0' && !text_equal(value, ".nan") && !none;
}

static bool holds(const struct values *values, const char *value)
{
    for (size_t i = 0; i < values->count && i < MOST_VALUES; i++)
        if (text_equal(values->items[i], value))
            return true;
    return false;
}

static struct values distinct(const struct report *report, const char *column)
{
    struct values values = {0};
    const struct results *results = report->results;
    for (size_t c = 0; c < results->cell_count; c++)
        for (size_t i = 0; i < results->cells[c].run_count; i++) {
            const char *value = results_text(results, &results->cells[c].runs[i], column);
            if (!is_known(column, value) || holds(&values, value))
                continue;
            if (values.count < MOST_VALUES)
                values.items[values.count] = value;
            values.count++;
        }
    return values;
}

static void append_fact(struct report *report, const struct fact *fact)
{
    struct text *html = &report->html;
    struct values values = distinct(report, fact->column);
    if (values.count == 0)
        return;
    text_append(html, "<div%s><dt>%s</dt><dd>",
                values.count > 1 && strlen(values.items[0]) > 24 ? " class=\"wide\"" : "",
                fact->title);
    for (size_t i = 0; i < values.count && i < MOST_VALUES; i++) {
        text_append(html, "%s", i ? ", " : "");
        html_text(html, values.items[i]);
    }
    text_append(html, "%s</dd></div>\n", values.count > MOST_VALUES ? ", \u2026" : "");
}

static void append_facts(struct report *report, const struct fact *facts)
{
    text_append(&report->html, "<dl>\n");
    for (; facts->title; facts++)
        append_fact(report, facts);
    text_append(&report->html, "</dl>\n");
}

/* --- how much --------------------------------------------------------------------- */

/* Seeds that occur anywhere: a full matrix has each of them in every cell. */
static size_t count_seeds(const struct results *results)
{
    size_t count = 0;
    for (size_t c = 0; c < results->cell_count; c++)
        for (size_t i = 0; i < results->cells[c].run_count; i++) {
            bool is_new = true;
            for (size_t k = 0; k < c && is_new; k++)
                is_new = !results_find_seed(&results->cells[k],
                                            results->cells[c].runs[i].seed);
            count += is_new;
        }
    return count;
}

static void append_sums(struct report *report)
{
    const struct results *results = report->results;
    size_t runs = 0, full = results->cell_count * count_seeds(results);
    double seconds = 0.0;
    for (size_t c = 0; c < results->cell_count; c++)
        for (size_t i = 0; i < results->cells[c].run_count; i++, runs++) {
            double s = results_number(results, &results->cells[c].runs[i], "seconds_cpu");
            seconds += isfinite(s) ? s : 0.0;
        }
    text_append(&report->html,
                "<p class=\"lead\">%zu finished runs: %zu cells, %zu seeds", runs,
                results->cell_count, count_seeds(results));
    if (runs < full)
        text_append(&report->html,
                    "; %zu of the %zu that every seed in every cell "
                    "would make are missing",
                    full - runs, full);
    text_append(&report->html, ". %.3g CPU hours of rendering.</p>\n", seconds / 3600.0);
}

/* --- references ------------------------------------------------------------------- */

/* The path, from the folder if it begins with that. */
static const char *below(const char *folder, const char *path)
{
    size_t length = strlen(folder);
    while (length > 0 && folder[length - 1] == '/')
        length--;
    return strncmp(path, folder, length) == 0 && path[length] == '/' ? path + length + 1
                                                                     : path;
}

static void append_reference(struct report *report, const struct report_picture *picture)
{
    struct text *html = &report->html;
    const struct results_cell *user = NULL;
    for (size_t i = 0; i < report->pictures.count && !user; i++)
        if (report->pictures.items[i].reference ==
            (int)(picture - report->pictures.items))
            user = report->pictures.items[i].cell;
    text_append(html, "<tr><td>");
    html_text(html, picture->scene);
    text_append(html, "</td><td class=\"file\">");
    html_text(html, below(report->results->folder, picture->path));
    text_append(html, "</td><td class=\"number\">%d\u00d7%d</td>", picture->width,
                picture->height);
    html_cell(html,
              user && user->noise_is_known[RESULTS_RELMSE] ? user->noise[RESULTS_RELMSE]
                                                           : (double)NAN,
              HTML_SIGNIFICANT);
    html_cell(html,
              user && user->noise_is_known[RESULTS_RELMSE_TRIMMED]
                  ? user->noise[RESULTS_RELMSE_TRIMMED]
                  : (double)NAN,
              HTML_SIGNIFICANT);
    text_append(html, "</tr>\n");
}

static void append_references(struct report *report)
{
    size_t count = 0;
    for (size_t i = 0; i < report->pictures.count; i++)
        count += report->pictures.items[i].cell == NULL;
    if (count == 0)
        return;
    text_append(
        &report->html,
        "<div class=\"table\" tabindex=\"0\"><table><caption><b>References</b> "
        "and the relMSE of each against the truth, from its two halves, of all "
        "pixels and %s.</caption>"
        "<thead><tr><th scope=\"col\">scene</th><th scope=\"col\">file</th>"
        "<th scope=\"col\">size</th><th scope=\"col\" class=\"number\">own relMSE"
        "</th><th scope=\"col\" class=\"number\">trimmed</th></tr></thead><tbody>\n",
        METRIC_TRIM_WORDS);
    for (size_t i = 0; i < report->pictures.count; i++)
        if (report->pictures.items[i].cell == NULL)
            append_reference(report, &report->pictures.items[i]);
    text_append(&report->html, "</tbody></table></div>\n");
}

void report_append_run(struct report *report)
{
    text_append(&report->html, "<section id=\"run\"><h2>What was run</h2>\n");
    append_sums(report);
    append_facts(report, settings);
    append_facts(report, environment);
    append_references(report);
    text_append(&report->html, "</section>\n");
}
