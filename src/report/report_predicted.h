#ifndef ETALON_REPORT_REPORT_PREDICTED_H
#define ETALON_REPORT_REPORT_PREDICTED_H

/* The curve of predicted errors (rule tours) in a plot of error against p_l. */

#include "report/report_panel.h"

/* Draws the mean over seeds of the curves that a cell's runs predicted from their starts,
 * at the work of the chosen p_l; nothing if a run has none. */
void report_draw_predicted(const struct results *results, const struct results_cell *cell,
                           struct report_panel *panel);

#endif
