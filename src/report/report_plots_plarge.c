#include "base/mem.h"
#include "analysis/analysis_drift.h"
#include "analysis/analysis_optimum.h"
#include "analysis/analysis_panel.h"
#include "report/report_html.h"
#include "report/report_plots.h"
#include "report/report_predicted.h"

#include <math.h>

/* Half of the width, as a factor, at which a range of one value is shaded. */
#define SINGLE_VALUE 1.06
/* An interval widens the range of the plot by at most this factor either way. */
#define MOST_SHOWN 3.0

/* --- error against p_l ------------------------------------------------------------ */

static void shade_optimum(struct report_panel *panel,
                          const struct analysis_optimum *optimum)
{
    bool single = optimum->lo == optimum->hi;
    if (!(optimum->lo <= optimum->hi))
        return;
    panel_set(panel,
              "set object 1 rectangle from %.9g, graph 0 to %.9g, graph 1 behind "
              "fc rgb '#050505' fs transparent solid 0.28 noborder",
              optimum->lo / (single ? SINGLE_VALUE : 1.0),
              optimum->hi * (single ? SINGLE_VALUE : 1.0));
}

static void draw_automatic(const struct report *report, struct report_panel *panel,
                           const struct results_cell *cell, struct interval error)
{
    double lo = results_mean(report->results, cell, "p_l_lo");
    double hi = results_mean(report->results, cell, "p_l_hi");
    double p_l = cell->p_l_mean;
    bool known = isfinite(lo) && isfinite(hi) && lo > 0.0;
    int table = panel_table(panel);
    panel_row(panel,
              (double[]){p_l, error.value, known ? lo : p_l, known ? hi : p_l, error.lo,
                         error.hi},
              6);
    panel_table_end(panel);
    panel_entry(panel, "automatic, with the interval that the start gives it",
                COLOUR_AUTO, 3);
    panel_draw(panel,
               "$d%d using 1:2:3:4 with xerrorbars lw 2.2 pt 13 ps 1 lc rgb "
               "'#040404'",
               table);
    if (interval_is_known(&error))
        panel_draw(panel,
                   "$d%d using 1:2:5:6 with yerrorbars lw 2.2 pt 13 ps 1 lc rgb "
                   "'#040404'",
                   table);
}

static void draw_manual(struct report_panel *panel, const struct analysis_panel *errors)
{
    int table = panel_table(panel);
    bool known = false;
    for (size_t i = errors->has_auto; i < errors->cell_count; i++) {
        struct interval e = interval_log_mean(analysis_panel_row(errors, i),
                                              errors->seed_count);
        known = known || interval_is_known(&e);
        panel_row(panel, (double[]){errors->cells[i]->p_l, e.value, e.lo, e.hi}, 4);
    }
    panel_table_end(panel);
    panel_entry(panel, "manual values", COLOUR_METHOD, 0);
    if (known)
        panel_draw(panel,
                   "$d%d using 1:2:3:4 with yerrorbars lw 1.6 pt 7 ps 0.5 lc rgb "
                   "'#0a0a0a'",
                   table);
    panel_draw(panel,
               "$d%d using 1:2 with linespoints lw 1.2 pt 7 ps 0.7 lc rgb "
               "'#0a0a0a'",
               table);
}

/* Sets the ranges from the values drawn, so that wide intervals of few seeds do not
 * compress the plot. Predicted errors widen it no further than intervals. */
static void set_ranges(struct report_panel *panel, const struct analysis_panel *errors,
                       const struct report_predicted *predicted)
{
    double x_lo = HUGE_VAL, x_hi = 0.0, y_lo = HUGE_VAL, y_hi = 0.0;
    for (size_t i = 0; i < errors->cell_count; i++) {
        struct interval e = interval_log_mean(analysis_panel_row(errors, i),
                                              errors->seed_count);
        double p_l = errors->cells[i]->p_l_mean;
        bool known = interval_is_known(&e);
        x_lo = fmin(x_lo, p_l);
        x_hi = fmax(x_hi, p_l);
        y_lo = fmin(y_lo, known ? fmax(e.lo, e.value / MOST_SHOWN) : e.value);
        y_hi = fmax(y_hi, known ? fmin(e.hi, e.value * MOST_SHOWN) : e.value);
    }
    double least = y_lo / MOST_SHOWN, most = y_hi * MOST_SHOWN;
    for (int k = 0; k < predicted->count; k++)
        if (predicted->p[k] >= x_lo && predicted->p[k] <= x_hi) {
            y_lo = fmin(y_lo, fmax(predicted->error[k], least));
            y_hi = fmax(y_hi, fmin(predicted->error[k], most));
        }
    panel_set_logarithmic(panel, 'x', x_lo / 1.25, x_hi * 1.25);
    panel_set_logarithmic(panel, 'y', y_lo / 1.15, y_hi * 1.15);
}

static void draw_family(struct report *report, const struct family *family,
                        const struct analysis_panel *errors,
                        const struct analysis_optimum *optimum)
{
    struct report_panel *panel = panels_add(&report->panels, FIGURE_PLARGE,
                                            errors->cells[0]);
    struct report_predicted predicted = {.runs = 0};
    if (errors->has_auto)
        report_predicted_read(report->results, errors->cells[0], &predicted);
    panel_title(panel, family->name, errors->cells[0]->is_biased);
    panel_set(panel, "set xlabel 'large-step probability'");
    panel_set(panel, "set ylabel '%s at %.3g %s'", report_error_name(report), errors->x,
              report->options->axis == RESULTS_MUTATIONS ? "per pixel" : "s");
    set_ranges(panel, errors, &predicted);
    shade_optimum(panel, optimum);
    if (optimum->lo <= optimum->hi)
        panel_entry(panel, "range of best manual values", COLOUR_SHADE, 1);
    draw_manual(panel, errors);
    report_predicted_draw(&predicted, errors->cells[0]->run_count, panel);
    if (errors->has_auto)
        draw_automatic(
            report, panel, errors->cells[0],
            interval_log_mean(analysis_panel_row(errors, 0), errors->seed_count));
}

static void queue_family(struct report *report, const struct family *family)
{
    struct analysis_panel errors;
    struct analysis_optimum optimum;
    analysis_panel_make(family, report->options->axis, report->options->error, false,
                        &errors);
    analysis_optimum_make(family, report->options->axis, report->options->error,
                          &optimum);
    size_t manual = errors.cell_count - errors.has_auto;
    if (manual >= 2 && errors.seed_count > 0)
        draw_family(report, family, &errors, &optimum);
    analysis_optimum_deinit(&optimum);
    analysis_panel_deinit(&errors);
}

void report_queue_plarge(struct report *report)
{
    for (size_t i = 0; i < report->families.count; i++)
        queue_family(report, &report->families.items[i]);
}

/* --- statistics of start and run -------------------------------------------------- */

struct spread {
    double lo, hi;
};

static void widen(struct spread *spread, const double *row)
{
    for (int i = 2; i < 6; i++) {
        spread->lo = fmin(spread->lo, row[i]);
        spread->hi = fmax(spread->hi, row[i]);
    }
}

/* start, whole, the ends of both intervals; false if the cell does not know them. */
static bool statistic_row(const struct report *report, const struct results_cell *cell,
                          int which, double row[6])
{
    struct analysis_drift drifts[ANALYSIS_DRIFTS];
    if (!analysis_drift(report->results, cell, drifts))
        return false;
    const struct interval *s = &drifts[which].start, *w = &drifts[which].whole;
    bool known = interval_is_known(s) && interval_is_known(w);
    row[0] = s->value;
    row[1] = w->value;
    row[2] = known ? s->lo : s->value;
    row[3] = known ? s->hi : s->value;
    row[4] = known ? w->lo : w->value;
    row[5] = known ? w->hi : w->value;
    return isfinite(s->value) && isfinite(w->value);
}

/* The statistic `which` of a family's cells. */
static void draw_statistic(const struct report *report, struct report_panel *panel,
                           size_t number, int which, struct spread *spread)
{
    const struct family *family = &report->families.items[number];
    int table = -1, colour = COLOUR_METHOD + (int)number % COLOUR_METHODS;
    bool biased = false;
    for (size_t c = 0; c <= family->manual_count; c++) {
        const struct results_cell *cell = c ? family->manual[c - 1] : family->automatic;
        double row[6];
        if (cell == NULL || !panel_same_group(cell, panel->group) ||
            !statistic_row(report, cell, which, row))
            continue;
        table = table < 0 ? panel_table(panel) : table;
        biased = cell->is_biased;
        panel_row(panel, row, 6);
        widen(spread, row);
    }
    if (table < 0)
        return;
    panel_table_end(panel);
    char *name = text_format("%s%s", family->name, biased ? ", biased" : "");
    panel_entry(panel, name, colour, (int)number);
    mem_free(name);
    panel_draw(panel,
               "$d%d using 1:2:3:4:5:6 with xyerrorbars lw 1.3 pt %d ps 0.6 "
               "lc rgb '#%02x%02x%02x'",
               table, panel_mark((int)number), colour, colour, colour);
}

static void queue_statistic(struct report *report, const struct results_cell *group,
                            const struct analysis_drift *drift, int which)
{
    struct report_panel *panel = panels_add(&report->panels, FIGURE_DRIFT, group);
    struct spread spread = {HUGE_VAL, -HUGE_VAL};
    html_text(&panel->title, drift->name);
    panel->plot.width = 400;
    panel->plot.height = 320;
    panel_set(panel, "set xlabel 'measured start'\nset ylabel 'whole run'");
    for (size_t f = 0; f < report->families.count; f++)
        draw_statistic(report, panel, f, which, &spread);
    panel_set_linear(panel, 'x', spread.lo, spread.hi);
    panel_set_linear(panel, 'y', spread.lo, spread.hi);
    panel_entry(panel, "equal", COLOUR_FAINT, -1);
    panel_draw(panel, "x with lines lw 1.2 dt (6,4) lc rgb '#030303'");
}

void report_queue_drift(struct report *report)
{
    const struct results *results = report->results;
    for (size_t c = 0; c < results->cell_count; c++) {
        struct analysis_drift drifts[ANALYSIS_DRIFTS];
        if (!report_begins_group(results, c))
            continue;
        size_t with = c;
        while (with < results->cell_count &&
               (!panel_same_group(&results->cells[with], &results->cells[c]) ||
                !analysis_drift(results, &results->cells[with], drifts)))
            with++;
        for (int which = 0; with < results->cell_count && which < 3; which++)
            if (isfinite(drifts[which].start.value) &&
                isfinite(drifts[which].whole.value))
                queue_statistic(report, &results->cells[c], &drifts[which], which);
    }
}
