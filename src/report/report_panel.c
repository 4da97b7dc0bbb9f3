#include "report/report_panel.h"

#include "base/mem.h"
#include "report/report_html.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH  560
#define HEIGHT 380
/* Of a plot that takes a row of its own. */
#define WIDE_WIDTH  1160
#define WIDE_HEIGHT 420

struct mark {
    int gnuplot;
    const char *character;
};

static const struct mark marks[] = {
    {7, "\u25cf"}, {5, "\u25a0"}, {9, "\u25b2"}, {13, "\u25c6"}, {11, "\u25bc"}};

static const struct mark *mark_of(int mark)
{
    return &marks[(size_t)mark % (sizeof marks / sizeof marks[0])];
}

int panel_mark(int mark)
{
    return mark_of(mark)->gnuplot;
}

bool panel_same_group(const struct results_cell *a, const struct results_cell *b)
{
    return text_equal(a->scene, b->scene) && a->budget == b->budget &&
           a->budget_is_time == b->budget_is_time;
}

/* What all plots have in common. */
static void frame(struct report_panel *panel)
{
    panel_set(panel, "unset key\nset border 3 lw 1 lc rgb '#010101'");
    panel_set(panel, "set tics nomirror scale 0.6 textcolor rgb '#010101'");
    panel_set(panel, "set grid xtics ytics lt 1 lw 0.6 lc rgb '#020202'");
    panel_set(panel, "set format x '%%g'\nset format y '%%g'\nset bars 0");
    panel_set(panel, "set lmargin 10\nset rmargin 2\nset tmargin 0.8\nset bmargin 3.4");
    panel_set(panel, "set xlabel offset 0,0.4 textcolor rgb '#010101'");
    panel_set(panel, "set ylabel offset 0.6,0 textcolor rgb '#010101'");
}

struct report_panel *panels_add(struct report_panels *panels, enum report_figure figure,
                                const struct results_cell *group)
{
    panels->items = mem_grow(panels->items, &panels->capacity, panels->count + 1,
                             sizeof *panels->items);
    struct report_panel *panel = &panels->items[panels->count++];
    *panel = (struct report_panel){.figure = figure, .group = group};
    panel->plot.width = WIDTH;
    panel->plot.height = HEIGHT;
    frame(panel);
    return panel;
}

void panels_deinit(struct report_panels *panels)
{
    for (size_t i = 0; i < panels->count; i++) {
        struct report_panel *panel = &panels->items[i];
        mem_free(panel->title.data);
        mem_free(panel->legend.data);
        mem_free(panel->data.data);
        mem_free(panel->under.elements.data);
        mem_free(panel->over.elements.data);
        mem_free(panel->plot.script.data);
        mem_free(panel->plot.svg);
    }
    mem_free(panels->items);
    *panels = (struct report_panels){0};
}

void panel_set(struct report_panel *panel, const char *format, ...)
{
    char line[512];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    text_append(&panel->plot.script, "%s\n", line);
}

/* Steps of a decade that get a number. */
static const char *steps_of(double decades)
{
    return decades < 0.3 ? "1 1.1 1.2 1.3 1.4 1.5 1.6 1.8 2 2.2 2.5 2.8 3.2 3.6 4 4.5 5 "
                           "5.6 6.3 7 8 9"
           : decades < 0.8 ? "1 1.2 1.5 2 2.5 3 4 5 6 8"
           : decades < 1.4 ? "1 1.5 2 3 5 7"
           : decades < 3.0 ? "1 2 5"
                           : "1";
}

void panel_set_logarithmic(struct report_panel *panel, char axis, double lo, double hi)
{
    const char *steps = steps_of(log10(hi / lo));
    struct text tics = {0};
    for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
        for (const char *at = steps; *at;) {
            char *end;
            double tic = strtod(at, &end) * pow(10.0, e);
            at = end;
            if (tic >= lo && tic <= hi)
                text_append(&tics, "%s%.9g", tics.length ? ", " : "", tic);
        }
    panel_set(panel, "set logscale %c\nset %crange [%.9g:%.9g]", axis, axis, lo, hi);
    if (tics.length > 0)
        panel_set(panel, "set %ctics (%s)", axis, tics.data);
    mem_free(tics.data);
}

void panel_set_linear(struct report_panel *panel, char axis, double lo, double hi)
{
    static const double nice[] = {1.0, 2.0, 5.0, 10.0};
    double room = hi > lo ? 0.06 * (hi - lo) : 0.01;
    double wanted = (hi - lo + 2.0 * room) / 4.0;
    double decade = pow(10.0, floor(log10(wanted)));
    int i = 0;
    while (i < 3 && nice[i] * decade < 0.7 * wanted)
        i++;
    panel_set(panel, "set %crange [%.9g:%.9g]\nset %ctics %.9g", axis, lo - room,
              hi + room, axis, nice[i] * decade);
}

void panel_title(struct report_panel *panel, const char *name, bool biased)
{
    html_text(&panel->title, name);
    if (biased)
        text_append(&panel->title, " <span class=\"biased\">biased</span>");
}

void panel_entry(struct report_panel *panel, const char *name, int colour, int mark)
{
    struct text *legend = &panel->legend;
    text_append(legend,
                "<li data-series=\"%d\"><span class=\"mark\" aria-hidden=\"true\" "
                "style=\"color: var(--plot-%d)\">%s</span> ",
                panel->entries++, colour, mark < 0 ? "\u2501" : mark_of(mark)->character);
    html_text(legend, name);
    text_append(legend, "</li>");
}

int panel_table(struct report_panel *panel)
{
    text_append(&panel->data, "$d%d << EOD\n", panel->tables);
    return panel->tables++;
}

void panel_row(struct report_panel *panel, const double *values, int count)
{
    for (int i = 0; i < count; i++)
        text_append(&panel->data, "%s%.9g", i ? " " : "", values[i]);
    text_append(&panel->data, "\n");
}

void panel_table_end(struct report_panel *panel)
{
    text_append(&panel->data, "EOD\n");
}

/* Between the elements of a plot command. */
static const char next[] = ", \\\n    ";

static void draw(struct report_panel *panel, struct report_layer *layer,
                 const char *format, va_list args)
{
    char element[256];
    /* Curves beyond this number could not be distinguished; the tables hold all. */
    if (panel->under.count + panel->over.count == REPORT_PLOT_ELEMENTS)
        return;
    vsnprintf(element, sizeof element, format, args);
    text_append(&layer->elements, "%s%s", layer->count ? next : "", element);
    layer->series[layer->count++] = panel->entries - 1;
}

void panel_draw(struct report_panel *panel, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    draw(panel, &panel->over, format, args);
    va_end(args);
}

void panel_draw_under(struct report_panel *panel, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    draw(panel, &panel->under, format, args);
    va_end(args);
}

static void add_series(struct report_plot *plot, const struct report_layer *layer)
{
    for (int i = 0; i < layer->count; i++)
        plot->series[plot->elements++] = layer->series[i];
}

/* Ends its script, and keeps the plot for gnuplot. */
static struct report_plot sealed(struct report_panel *panel)
{
    struct report_plot plot = panel->plot;
    const struct report_layer *under = &panel->under, *over = &panel->over;
    text_append(&plot.script, "%splot %s%s%s\n", panel->data.data ? panel->data.data : "",
                under->count ? under->elements.data : "", under->count ? next : "",
                over->count ? over->elements.data : "NaN notitle");
    add_series(&plot, under);
    add_series(&plot, over);
    return plot;
}

/* Plots of one kind, scene and budget stand two in a row, as wide as the page; the last
 * of an odd number has a row of its own. Smaller ones, three in a row, are left as they
 * are. */
static void widen_last(struct report_panels *panels, size_t first)
{
    struct report_panel *last = &panels->items[first];
    int count = 0;
    for (size_t i = 0; i < panels->count; i++) {
        struct report_panel *panel = &panels->items[i];
        if (panel->figure != last->figure || !panel_same_group(panel->group, last->group))
            continue;
        if (i < first)
            return;
        last = panel;
        count++;
    }
    if (count % 2 == 0 || last->figure == FIGURE_DRIFT)
        return;
    last->wide = true;
    last->plot.width = WIDE_WIDTH;
    last->plot.height = WIDE_HEIGHT;
}

bool panels_draw(struct report_panels *panels, struct err *err)
{
    for (size_t i = 0; i < panels->count; i++)
        widen_last(panels, i);
    struct report_plot *plots = mem_alloc(panels->count, sizeof *plots);
    for (size_t i = 0; i < panels->count; i++)
        plots[i] = sealed(&panels->items[i]);
    bool ok = report_gnuplot(plots, panels->count, err);
    for (size_t i = 0; i < panels->count; i++)
        panels->items[i].plot = plots[i];
    mem_free(plots);
    return ok;
}
