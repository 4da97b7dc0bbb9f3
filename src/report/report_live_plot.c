/* Error against time of a run that is going on. */
#include "report/report_live.h"

#include "report/report_plots.h"

#include <math.h>

struct curve {
    const char *name;
    int colour, mark;
    bool measured; /* against the reference, else by the run's own error bars */
};

static const struct curve curves[] = {
    {"by the run\u2019s own error bars", COLOUR_AUTO, 0, false},
    {"against the reference", COLOUR_METHOD, 1, true},
};
#define CURVES (sizeof curves / sizeof curves[0])

static double value_of(const struct report_live_point *point, const struct curve *curve)
{
    return curve->measured ? point->measured : point->bars;
}

static bool is_drawn(double value)
{
    return value > 0.0 && !isinf(value);
}

static void draw_curve(struct report_panel *panel, const struct curve *curve,
                       const struct report_live_point *points, size_t count)
{
    size_t drawn = 0;
    for (size_t i = 0; i < count; i++)
        drawn += is_drawn(value_of(&points[i], curve));
    if (drawn == 0)
        return;
    int table = panel_table(panel), c = curve->colour;
    for (size_t i = 0; i < count; i++)
        if (is_drawn(value_of(&points[i], curve)))
            panel_row(panel, (double[]){points[i].wall, value_of(&points[i], curve)}, 2);
    panel_table_end(panel);
    panel_entry(panel, curve->name, c, curve->mark);
    panel_draw(panel,
               "$d%d using 1:2 with linespoints lw 2 pt %d ps 0.5 lc rgb "
               "'#%02x%02x%02x'",
               table, panel_mark(curve->mark), c, c, c);
}

static void draw(struct report_panel *panel, const struct report_live_point *points,
                 size_t count, struct report_range y)
{
    struct report_range x = {points[0].wall, points[count - 1].wall};
    panel_set_logarithmic(panel, 'x', x.lo / 1.05, x.hi * 1.05);
    panel_set_logarithmic(panel, 'y', y.lo / 1.3, y.hi * 1.3);
    panel_set(panel, "set xlabel 'wall time of rendering [s]'\nset ylabel 'relMSE'");
    panel_title(panel, "Error against time", false);
    for (size_t i = 0; i < CURVES; i++)
        draw_curve(panel, &curves[i], points, count);
    report_draw_slope(panel, x.lo * y.hi);
}

void report_live_plot(const struct report_live_point *points, size_t count,
                      struct text *html)
{
    static const struct results_cell none = {.scene = ""};
    struct report_panels panels = {0};
    struct report_range y = {HUGE_VAL, 0.0};
    struct err err = {0};
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < CURVES; c++)
            report_widen(&y, value_of(&points[i], &curves[c]));
    if (!(y.hi > 0.0) || !(points[0].wall > 0.0))
        return;
    draw(panels_add(&panels, FIGURE_TIME, &none), points, count, y);
    if (panels_draw(&panels, &err))
        report_append_panel(html, &panels.items[0], 0);
    else
        text_append(html, "<p>%s: there is no plot</p>", err.message);
    panels_deinit(&panels);
}
