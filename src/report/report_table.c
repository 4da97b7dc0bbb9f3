/* How the tables of the report are made. */
#include "base/mem.h"
#include "report/report_html.h"
#include "report/report_parts.h"

/* Tables with more can be filtered. */
#define MANY_ROWS 8

void report_open_table(struct text *html, const char *id, const char *caption,
                       size_t rows)
{
    if (rows > MANY_ROWS)
        text_append(html,
                    "<label class=\"filter\" hidden>Rows with <input type=\"search\" "
                    "class=\"filter\" data-table=\"%s\"></label>\n",
                    id);
    text_append(html,
                "<div class=\"table\" tabindex=\"0\"><table id=\"%s\">\n"
                "<caption>%s</caption>\n<thead><tr>",
                id, caption);
}

void report_end_heads(struct text *html)
{
    text_append(html, "</tr></thead>\n<tbody>\n");
}

void report_close_table(struct text *html)
{
    text_append(html, "</tbody></table></div>\n");
}

int report_cell_heads(struct report *report, const char *scene)
{
    struct text *html = &report->html;
    int at = html_head(html, "method", "integrator and settings that differ", 0, 1,
                       false);
    if (report_has_budgets(report->results, scene))
        at = html_head(html, "budget", "of each run", at, 1, false);
    return at;
}

void report_begin_row(struct report *report, const struct results_cell *cell)
{
    struct text *html = &report->html;
    text_append(html, "<tr><td class=\"method\">");
    report_append_method(html, cell);
    text_append(html, "</td>");
    if (!report_has_budgets(report->results, cell->scene))
        return;
    char *budget = results_budget(cell);
    html_cell_text(html, budget);
    mem_free(budget);
}
