#ifndef ETALON_REPORT_REPORT_H
#define ETALON_REPORT_REPORT_H

/* The results of an experiment as one page that needs nothing beside itself: what was
 * run, tables, plots (if gnuplot is there) and the pictures, to be compared. */

#include "base/log.h"
#include "analysis/results.h"

struct report_options {
    const char *references; /* folder of rendered references, for tables that do not name
                             * theirs; NULL: "references" beside the results */
    const char *baseline;   /* label of the cells that speed-ups are against; NULL: the
                             * scene's first automatic one, else its first */
    enum results_axis axis; /* axis on which cells are compared */
    enum results_error error;
};

/* The page as text, owned by the caller. Fails without finished runs, and if no cell has
 * the label of the baseline. What cannot be shown is noted in *log and in the page. If
 * the tables of an older program lack the noise of references, it is filled in in
 * *results. */
char *report_html(struct results *results, const struct report_options *options,
                  struct log *log, struct err *err);

#endif
