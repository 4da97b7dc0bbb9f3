#ifndef ETALON_REPORT_REPORT_PREDICTED_H
#define ETALON_REPORT_REPORT_PREDICTED_H

/* The curve of predicted errors (rule tours) in a plot of error against p_l. */

#include "report/report_panel.h"

#define REPORT_PREDICTED_POINTS 64

/* Means over the runs of a cell that predicted a curve: geometric ones of relMSE at the
 * work of the chosen p_l, and of the published rule's p_l. */
struct report_predicted {
    double p[REPORT_PREDICTED_POINTS], error[REPORT_PREDICTED_POINTS];
    int count;
    double published; /* p_l by zsolnai2013; NaN without a run */
    size_t runs;      /* of them; 0: no curve */
};

void report_predicted_read(const struct results *results, const struct results_cell *cell,
                           struct report_predicted *out);
/* The predicted error at p, linear in logarithms between the points. */
double report_predicted_at(const struct report_predicted *predicted, double p);
/* Draws the curve and the published p_l on it; all: runs of the cell. Nothing without a
 * curve. */
void report_predicted_draw(const struct report_predicted *predicted, size_t all,
                           struct report_panel *panel);

#endif
