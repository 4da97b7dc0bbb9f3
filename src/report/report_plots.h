#ifndef ETALON_REPORT_REPORT_PLOTS_H
#define ETALON_REPORT_REPORT_PLOTS_H

/* Functions that the plots of the report share. */

#include "report/report_parts.h"

/* Error against p_l, a plot a family; statistics of the start against the whole run. */
void report_queue_plarge(struct report *report);
void report_queue_drift(struct report *report);
void report_queue_spectra(struct report *report);

/* What values span, of a logarithmic axis; {HUGE_VAL, 0}: nothing yet. */
struct report_range {
    double lo, hi;
};
void report_widen(struct report_range *range, double value);
/* The slope of independent samples: error times time is `product`, as in the upper left
 * corner of what a plot spans. */
void report_draw_slope(struct report_panel *panel, double product);

/* Cells that show a method as it comes: automatic, or without chains. */
bool report_is_method(const struct results_cell *cell);
/* The colour of the ramp, from 0 on, of one of `count` values in their order. */
int report_ramp(size_t index, size_t count);

#endif
