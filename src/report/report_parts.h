#ifndef ETALON_REPORT_REPORT_PARTS_H
#define ETALON_REPORT_REPORT_PARTS_H

/* The report while it is being made, and its parts, each of which appends to the page. */

#include "analysis/families.h"
#include "report/report.h"
#include "report/report_panel.h"
#include "report/report_pictures.h"

struct report {
    const struct report_options *options;
    struct results *results;
    struct families families;
    struct report_pictures pictures;
    struct report_panels panels;
    struct log *log;
    struct text html;
};

/* Of any page: what comes before its body's parts; kind: what it is, a line of HTML above
 * its name. */
void report_append_head(struct text *html, const char *name, const char *kind);
/* What comes after them: who made the page (HTML), its pictures, its scripts; more: a
 * further script, or NULL. */
void report_append_end(struct text *html, const char *maker,
                       const struct report_pictures *pictures, const char *const *more);
/* An asset (report_assets.h). */
void report_append_lines(struct text *html, const char *const *lines);

/* Who is best, in words, and the regret over all cells. */
void report_append_outcome(struct report *report);
/* What was run, on which machine, with the results in numbers. */
void report_append_run(struct report *report);
/* The regret of the automatic p_l, and the ranges of best p_l, over all scenes. */
void report_append_families(struct report *report);
/* The cells of a scene: their errors; statistics of start and run; bias and variance. */
void report_append_cells(struct report *report, const char *scene);
/* Speed, error of a path and brightness of methods beside each other, if the scene has
 * several integrators. */
void report_append_why(struct report *report, const char *scene, int number);
void report_append_drifts(struct report *report, const char *scene, int number);
void report_append_splits(struct report *report, const char *scene, int number);
/* Queues the plots of all scenes; those of one, after they are drawn. */
void report_queue_plots(struct report *report);
void report_append_plots(struct report *report, const char *scene);
/* The comparers of a scene, one for each size of its pictures. */
void report_append_comparers(struct report *report, const char *scene);

/* The layers of the pictures of a scene (docs/layers.md), with legends. */
void report_append_layers(struct report *report, const char *scene);

/* Whether cell i is the first of its scene; of its scene and budget. */
bool report_begins_scene(const struct results *results, size_t i);
bool report_begins_group(const struct results *results, size_t i);
/* "relMSE", "trimmed relMSE", "MSE"; that of the error that is reported. */
const char *report_error_title(enum results_error error);
const char *report_error_name(const struct report *report);
/* "CPU time": the axis, in a sentence. */
const char *report_axis_words(const struct report *report);
/* Whether the cells of the scene, or with NULL all, have several budgets. */
bool report_has_budgets(const struct results *results, const char *scene);

/* The method's name, with a mark if it is biased. */
void report_append_method(struct text *html, const struct results_cell *cell);

/* A table that can be sorted and, with many rows, filtered: it is opened, heads follow,
 * their end, rows, its end. The caption is HTML. */
void report_open_table(struct text *html, const char *id, const char *caption,
                       size_t rows);
void report_end_heads(struct text *html);
void report_close_table(struct text *html);
/* The columns that name a cell of the scene, and a row's beginning with them. Returns how
 * many there are. */
int report_cell_heads(struct report *report, const char *scene);
void report_begin_row(struct report *report, const struct results_cell *cell);

#endif
