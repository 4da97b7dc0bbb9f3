#include "base/mem.h"
#include "image/metric.h"
#include "report/report_html.h"
#include "report/report_parts.h"

/* --- plots ------------------------------------------------------------------------ */

static void caption(const struct report *report, enum report_figure figure,
                    struct text *html)
{
    const char *error = report_error_name(report);
    if (figure == FIGURE_METHODS)
        text_append(
            html,
            "<b>%s against %s, methods as they come</b> (automatic p<sub>l</sub>, "
            "or without chains).",
            error, report_axis_words(report));
    else if (figure == FIGURE_TIME)
        text_append(html, "<b>%s against %s, automatic and manual p<sub>l</sub>.</b>",
                    error, report_axis_words(report));
    else if (figure == FIGURE_PLARGE)
        text_append(html,
                    "<b>%s against p<sub>l</sub> at equal %s.</b> Geometric means over "
                    "seeds with 95 %% t intervals of the mean of logarithms. The "
                    "automatic value with the interval that its measured start gives it "
                    "(mean ends over seeds). Shaded: from the lowest to the highest "
                    "manual value whose error is not significantly above the best. "
                    "Dashed: the relMSE that the starts of automatic runs predict for "
                    "every p<sub>l</sub>, a geometric mean over seeds, at equal work; it "
                    "leaves out what few pixels or chains make.",
                    error, report_axis_words(report));
    else if (figure == FIGURE_SPECTRUM)
        text_append(html,
                    "<b>Error spectra</b>: power of a run&rsquo;s relative error of "
                    "luminance by frequency, times the CPU seconds of a run, so that "
                    "methods compare at equal cost. Independent pixels give a "
                    "horizontal line; errors that neighbours share rise to the left, "
                    "and are blotches, not grain. Low/high: power below 1/16 over that "
                    "above 1/4 cycles per pixel. From the differences between seeds, "
                    "%s; of one seed from that to the reference, of all pixels. Bands: "
                    "least and greatest of three seeds or more.",
                    METRIC_TRIM_WORDS);
    else
        text_append(html,
                    "<b>Statistics of the measured start against those of the whole "
                    "run</b>, a point a cell: means over seeds with 95 %% t "
                    "intervals. On the line the start speaks for the run.");
    if (figure == FIGURE_METHODS || figure == FIGURE_TIME)
        text_append(html, " Geometric means over seeds; bands: 95 %% t intervals of the "
                          "mean of logarithms.");
}

/* A plot that was drawn, with its title and legend; number: of those in the page. */
static void append_panel(struct text *html, const struct report_panel *panel,
                         size_t number)
{
    bool titled = panel->title.length > 0;
    text_append(html, "<div class=\"panel%s\"><h4 id=\"plot%zu-title\"%s>%s</h4>\n%s\n",
                panel->wide ? " wide" : "", number, titled ? "" : " class=\"unseen\"",
                titled ? panel->title.data : "methods", panel->plot.svg);
    text_append(html, "<ul class=\"legend\">%s</ul></div>\n",
                panel->legend.data ? panel->legend.data : "");
}

/* All plots of one kind, of one scene and budget. */
static void append_figure(struct report *report, const struct results_cell *group,
                          enum report_figure figure)
{
    struct text *html = &report->html;
    bool any = false;
    for (size_t i = 0; i < report->panels.count; i++) {
        const struct report_panel *panel = &report->panels.items[i];
        if (panel->figure != figure || panel->plot.svg == NULL ||
            !panel_same_group(panel->group, group))
            continue;
        if (!any)
            text_append(html, "<figure class=\"plots\"><div class=\"panels%s\">\n",
                        figure == FIGURE_DRIFT ? " small" : "");
        any = true;
        append_panel(html, panel, i);
    }
    if (!any)
        return;
    char *budget = results_budget(group);
    text_append(html, "</div><figcaption>");
    caption(report, figure, html);
    text_append(html, " Runs of %s.</figcaption></figure>\n", budget);
    mem_free(budget);
}

void report_append_plots(struct report *report, const char *scene)
{
    const struct results *results = report->results;
    for (size_t i = 0; i < results->cell_count; i++)
        if (text_equal(results->cells[i].scene, scene) && report_begins_group(results, i))
            for (int figure = 0; figure < FIGURES; figure++)
                append_figure(report, &results->cells[i], (enum report_figure)figure);
}

/* --- pictures --------------------------------------------------------------------- */

static bool same_size(const struct report_picture *a, const struct report_picture *b)
{
    return text_equal(a->scene, b->scene) && a->width == b->width &&
           a->height == b->height;
}

static bool begins_size(const struct report_pictures *pictures, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (same_size(&pictures->items[k], &pictures->items[i]))
            return false;
    return true;
}

static void append_comparer(struct report *report, size_t first)
{
    const struct report_pictures *pictures = &report->pictures;
    const struct report_picture *like = &pictures->items[first];
    struct text *html = &report->html;
    text_append(html, "<h3>Pictures, %d\u00d7%d", like->width, like->height);
    if (pictures->factor > 1)
        text_append(html, ", shown as %d\u00d7%d", like->shown_width, like->shown_height);
    text_append(html,
                "</h3>\n<div class=\"comparer\" id=\"comparer-%zu\" data-pictures=\"",
                first);
    for (size_t i = first; i < pictures->count; i++)
        if (same_size(&pictures->items[i], like))
            text_append(html, "%s%zu", i > first ? " " : "", i);
    text_append(html,
                "\"><noscript>Pictures are compared by a script of this page, which "
                "the browser does not run.</noscript></div>\n");
}

void report_append_comparers(struct report *report, const char *scene)
{
    const struct report_pictures *pictures = &report->pictures;
    for (size_t i = 0; i < pictures->count; i++)
        if (text_equal(pictures->items[i].scene, scene) && begins_size(pictures, i))
            append_comparer(report, i);
}
