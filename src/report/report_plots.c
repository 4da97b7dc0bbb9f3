#include "report/report_plots.h"

#include "base/mem.h"
#include "analysis/analysis_curve.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>

#define CURVE_POINTS 24

/* --- a scene at one budget ------------------------------------------------------- */

/* The curves of all cells, and what those of one scene and budget span together. */
struct curves {
    const struct report *report;
    struct analysis_curve *items; /* by cell */
    struct report_range x, y;
};

void report_widen(struct report_range *range, double value)
{
    if (!(value > 0.0) || isinf(value))
        return;
    range->lo = fmin(range->lo, value);
    range->hi = fmax(range->hi, value);
}

static const struct analysis_curve *curve_of(const struct curves *curves,
                                             const struct results_cell *cell)
{
    return &curves->items[cell - curves->report->results->cells];
}

static void span(struct curves *curves, const struct results_cell *group)
{
    const struct results *results = curves->report->results;
    curves->x = curves->y = (struct report_range){HUGE_VAL, 0.0};
    for (size_t c = 0; c < results->cell_count; c++) {
        const struct analysis_curve *curve = &curves->items[c];
        for (size_t i = 0;
             panel_same_group(&results->cells[c], group) && i < curve->count; i++) {
            report_widen(&curves->x, curve->points[i].x);
            report_widen(&curves->y, curve->points[i].raw.value);
        }
    }
}

static void widen_by_curve(const struct curves *curves, const struct results_cell *cell,
                           struct report_range *x)
{
    const struct analysis_curve *curve = curve_of(curves, cell);
    for (size_t i = 0; i < curve->count; i++)
        report_widen(x, curve->points[i].x);
}

static struct report_range span_of_family(const struct curves *curves,
                                          const struct family *family)
{
    struct report_range x = {HUGE_VAL, 0.0};
    for (size_t i = 0; i < family->manual_count; i++)
        widen_by_curve(curves, family->manual[i], &x);
    if (family->automatic)
        widen_by_curve(curves, family->automatic, &x);
    return x.hi > 0.0 ? x : curves->x;
}

/* --- lines ----------------------------------------------------------------------- */

struct style {
    const char *name;
    int colour, mark;
    double width;
    double opacity; /* of the interval */
};

static int curve_table(struct report_panel *panel, const struct analysis_curve *curve)
{
    int table = panel_table(panel);
    for (size_t i = 0; i < curve->count; i++) {
        const struct analysis_point *p = &curve->points[i];
        panel_row(panel, (double[]){p->x, p->raw.value, p->raw.lo, p->raw.hi}, 4);
    }
    panel_table_end(panel);
    return table;
}

static void draw_curve(struct report_panel *panel, const struct analysis_curve *curve,
                       const struct style *style)
{
    if (curve->count == 0)
        return;
    int table = curve_table(panel, curve), c = style->colour;
    panel_entry(panel, style->name, c, style->mark);
    if (interval_is_known(&curve->points[0].raw))
        panel_draw_under(panel,
                         "$d%d using 1:3:4 with filledcurves fs transparent solid %g "
                         "noborder lc rgb '#%02x%02x%02x'",
                         table, style->opacity, c, c, c);
    panel_draw(panel,
               "$d%d using 1:2 with linespoints lw %g pt %d ps 0.45 pi %d "
               "lc rgb '#%02x%02x%02x'",
               table, style->width, panel_mark(style->mark), CURVE_POINTS / 6, c, c, c);
}

void report_draw_slope(struct report_panel *panel, double product)
{
    panel_entry(panel, "slope \u22121, as of independent samples", COLOUR_FAINT, -1);
    panel_draw(panel, "%.9g / x with lines lw 1.2 dt (6,4) lc rgb '#030303'", product);
}

static void draw_noise(struct report_panel *panel, const struct results_cell *cell,
                       enum results_error error, const struct curves *curves)
{
    if (!cell->noise_is_known[error] || cell->noise[error] < 0.5 * curves->y.lo)
        return;
    panel_entry(panel, "the reference\u2019s own noise", COLOUR_INK, -1);
    panel_draw(panel, "%.9g with lines lw 1.2 dt (2,3) lc rgb '#010101'",
               cell->noise[error]);
}

static const char *axis_label(enum results_axis axis)
{
    return axis == RESULTS_WALL  ? "wall time [s]"
           : axis == RESULTS_CPU ? "CPU time, all threads [s]"
                                 : "mutations (samples) per pixel";
}

static struct report_panel *time_panel(struct report *report, const struct curves *curves,
                                       struct report_range x, enum report_figure figure,
                                       const struct results_cell *group)
{
    struct report_panel *panel = panels_add(&report->panels, figure, group);
    panel_set_logarithmic(panel, 'x', x.lo / 1.05, x.hi * 1.05);
    panel_set_logarithmic(panel, 'y', curves->y.lo / 1.3, curves->y.hi * 1.3);
    panel_set(panel, "set xlabel '%s'", axis_label(report->options->axis));
    panel_set(panel, "set ylabel '%s'", report_error_name(report));
    return panel;
}

/* --- figures --------------------------------------------------------------------- */

static void queue_family(struct report *report, const struct curves *curves,
                         const struct family *family)
{
    const struct results_cell *group = family->automatic ? family->automatic
                                                         : family->manual[0];
    struct report_range x = span_of_family(curves, family);
    struct report_panel *panel = time_panel(report, curves, x, FIGURE_TIME, group);
    panel_title(panel, family->name, group->is_biased);
    for (size_t i = 0; i < family->manual_count; i++) {
        char *name = text_format("p_l = %g", family->manual[i]->p_l);
        int colour = COLOUR_RAMP + report_ramp(i, family->manual_count);
        struct style style = {name, colour, (int)i, 1.3,
                              family->manual_count > 4 ? 0.07 : 0.12};
        draw_curve(panel, curve_of(curves, family->manual[i]), &style);
        mem_free(name);
    }
    if (family->automatic) {
        char *name = text_format("automatic, p_l = %.3g", family->automatic->p_l_mean);
        struct style style = {name, COLOUR_AUTO, 0, 2.6, 0.16};
        draw_curve(panel, curve_of(curves, family->automatic), &style);
        mem_free(name);
    }
    report_draw_slope(panel, x.lo * curves->y.hi);
    draw_noise(panel, group, report->options->error, curves);
}

/* Queues the plot of methods: automatic cells, and cells without chains. */
static void queue_methods(struct report *report, const struct curves *curves,
                          const struct results_cell *group)
{
    const struct results *results = report->results;
    size_t count = 0;
    for (size_t c = 0; c < results->cell_count; c++)
        count += panel_same_group(&results->cells[c], group) &&
                 report_is_method(&results->cells[c]) && curves->items[c].count > 0;
    if (count < 2)
        return;
    struct report_panel *panel = time_panel(report, curves, curves->x, FIGURE_METHODS,
                                            group);
    int number = 0;
    for (size_t c = 0; c < results->cell_count; c++) {
        const struct results_cell *cell = &results->cells[c];
        if (!panel_same_group(cell, group) || !report_is_method(cell))
            continue;
        char *name = text_format("%s%s", cell->label, cell->is_biased ? ", biased" : "");
        int colour = COLOUR_METHOD + number % COLOUR_METHODS;
        struct style style = {name, colour, number, 1.8, 0.12};
        draw_curve(panel, &curves->items[c], &style);
        number++;
        mem_free(name);
    }
    report_draw_slope(panel, curves->x.lo * curves->y.hi);
    draw_noise(panel, group, report->options->error, curves);
}

static void queue_group(struct report *report, struct curves *curves,
                        const struct results_cell *group)
{
    span(curves, group);
    if (!(curves->x.hi > 0.0) || !(curves->y.hi > 0.0))
        return;
    queue_methods(report, curves, group);
    for (size_t i = 0; i < report->families.count; i++) {
        const struct family *family = &report->families.items[i];
        const struct results_cell *member = family->automatic ? family->automatic
                                                              : family->manual[0];
        if (panel_same_group(member, group) && family->manual_count > 0)
            queue_family(report, curves, family);
    }
}

bool report_is_method(const struct results_cell *cell)
{
    return cell->is_auto || !cell->has_chains;
}

int report_ramp(size_t index, size_t count)
{
    return count < 2 ? 0 : (int)(index * (COLOUR_RAMPS - 1) / (count - 1));
}

static void queue_curves(struct report *report)
{
    const struct results *results = report->results;
    struct curves curves = {.report = report};
    curves.items = mem_alloc(results->cell_count, sizeof *curves.items);
    for (size_t c = 0; c < results->cell_count; c++)
        analysis_curve_make(&results->cells[c], report->options->axis,
                            report->options->error, CURVE_POINTS, &curves.items[c]);
    for (size_t c = 0; c < results->cell_count; c++)
        if (report_begins_group(results, c))
            queue_group(report, &curves, &results->cells[c]);
    for (size_t c = 0; c < results->cell_count; c++)
        analysis_curve_deinit(&curves.items[c]);
    mem_free(curves.items);
}

void report_queue_plots(struct report *report)
{
    queue_curves(report);
    report_queue_plarge(report);
    report_queue_spectra(report);
    report_queue_drift(report);
}
