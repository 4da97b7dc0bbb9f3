/* Spectra of the runs' errors, a plot a scene and budget. */
#include "base/mem.h"
#include "analysis/analysis_spectrum.h"
#include "report/report_plots.h"

#include <math.h>

struct spectra {
    struct analysis_spectrum *items; /* by cell; without bins: none */
    struct report_range x, y;
    size_t count; /* of the group */
};

static void span(const struct report *report, struct spectra *spectra,
                 const struct results_cell *group)
{
    const struct results *results = report->results;
    spectra->x = spectra->y = (struct report_range){HUGE_VAL, 0.0};
    spectra->count = 0;
    for (size_t c = 0; c < results->cell_count; c++) {
        const struct analysis_spectrum *s = &spectra->items[c];
        if (!panel_same_group(&results->cells[c], group) || s->mean.count == 0)
            continue;
        spectra->count++;
        for (int b = 0; b < s->mean.count; b++) {
            report_widen(&spectra->x, s->mean.frequency[b]);
            report_widen(&spectra->y, s->mean.power[b] * s->cost);
        }
    }
}

static void draw_spectrum(struct report_panel *panel, const struct results_cell *cell,
                          const struct analysis_spectrum *s, int number)
{
    int table = panel_table(panel), c = COLOUR_METHOD + number % COLOUR_METHODS;
    for (int b = 0; b < s->mean.count; b++)
        panel_row(panel,
                  (double[]){s->mean.frequency[b], s->mean.power[b] * s->cost,
                             s->least[b] * s->cost, s->greatest[b] * s->cost},
                  4);
    panel_table_end(panel);
    char *name = text_format("%s, low/high %.2g", cell->label, s->low_over_high);
    panel_entry(panel, name, c, number);
    mem_free(name);
    if (s->seeds > 2)
        panel_draw_under(panel,
                         "$d%d using 1:3:4 with filledcurves fs transparent solid 0.12 "
                         "noborder lc rgb '#%02x%02x%02x'",
                         table, c, c, c);
    panel_draw(panel,
               "$d%d using 1:2 with linespoints lw 1.8 pt %d ps 0.5 "
               "lc rgb '#%02x%02x%02x'",
               table, panel_mark(number), c, c, c);
}

static void queue_group(struct report *report, struct spectra *spectra,
                        const struct results_cell *group)
{
    const struct results *results = report->results;
    span(report, spectra, group);
    if (spectra->count == 0 || !(spectra->y.hi > 0.0))
        return;
    struct report_panel *panel = panels_add(&report->panels, FIGURE_SPECTRUM, group);
    panel_set_logarithmic(panel, 'x', spectra->x.lo / 1.05, spectra->x.hi * 1.05);
    panel_set_logarithmic(panel, 'y', spectra->y.lo / 1.3, spectra->y.hi * 1.3);
    panel_set(panel, "set xlabel 'frequency [cycles per pixel]'");
    panel_set(panel, "set ylabel 'power of the error times CPU seconds'");
    int number = 0;
    for (size_t c = 0; c < results->cell_count; c++)
        if (panel_same_group(&results->cells[c], group) &&
            spectra->items[c].mean.count > 0)
            draw_spectrum(panel, &results->cells[c], &spectra->items[c], number++);
}

/* Manual values of p_l are left out: they would hide the methods. */
void report_queue_spectra(struct report *report)
{
    const struct results *results = report->results;
    struct spectra spectra = {
        .items = mem_alloc(results->cell_count, sizeof *spectra.items)};
    struct err ignored = {0};
    for (size_t c = 0; c < results->cell_count; c++)
        if (!report_is_method(&results->cells[c]) ||
            !analysis_spectrum_cell(results, &results->cells[c], &spectra.items[c],
                                    &ignored))
            spectra.items[c].mean.count = 0;
    for (size_t c = 0; c < results->cell_count; c++)
        if (report_begins_group(results, c))
            queue_group(report, &spectra, &results->cells[c]);
    mem_free(spectra.items);
}
