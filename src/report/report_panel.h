#ifndef ETALON_REPORT_REPORT_PANEL_H
#define ETALON_REPORT_REPORT_PANEL_H

/* A plot with its title and legend. Names stand in the page's own text, so gnuplot sees
 * numbers alone. Colours are numbers of the style's variables --plot-N. */

#include "analysis/interval.h"
#include "report/report_gnuplot.h"
#include "analysis/results.h"

enum { COLOUR_INK = 1, COLOUR_GRID, COLOUR_FAINT, COLOUR_AUTO, COLOUR_SHADE };
/* Colours of methods, and a ramp for values of p_l from low to high. */
enum { COLOUR_METHOD = 10, COLOUR_METHODS = 8, COLOUR_RAMP = 20, COLOUR_RAMPS = 10 };

enum report_figure {
    FIGURE_METHODS,
    FIGURE_TIME,
    FIGURE_PLARGE,
    FIGURE_SPECTRUM,
    FIGURE_DRIFT,
    FIGURES
};

/* Elements of a plot command, drawn on top of each other. */
struct report_layer {
    struct text elements;
    int series[REPORT_PLOT_ELEMENTS], count; /* series: entries of the legend */
};

struct report_panel {
    enum report_figure figure;
    const struct results_cell *group; /* a cell of its scene and budget */
    struct text title, legend;        /* HTML */
    struct report_plot plot;
    /* Of the script, until it is sealed: */
    struct text data; /* settings and tables */
    struct report_layer under, over;
    int entries; /* of the legend, so far */
    bool wide;   /* takes a row of its own */
    int tables;
};

/* Zero-initialise. */
struct report_panels {
    struct report_panel *items;
    size_t count, capacity;
};

struct report_panel *panels_add(struct report_panels *panels, enum report_figure figure,
                                const struct results_cell *group);
void panels_deinit(struct report_panels *panels);
/* Draws all; false, with no plot, if gnuplot cannot. */
bool panels_draw(struct report_panels *panels, struct err *err);

bool panel_same_group(const struct results_cell *a, const struct results_cell *b);

/* A line of the script before its plot command. */
void panel_set(struct report_panel *panel, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* A logarithmic axis, 'x' or 'y', over [lo, hi], with tics that suit how far that is. */
void panel_set_logarithmic(struct report_panel *panel, char axis, double lo, double hi);
/* A linear one with about four tics, and some room beyond lo and hi. */
void panel_set_linear(struct report_panel *panel, char axis, double lo, double hi);
void panel_title(struct report_panel *panel, const char *name, bool biased);
/* A name of the legend, drawn thus; what is drawn next belongs to it. mark: 0 to 4, or -1
 * for a line alone. */
void panel_entry(struct report_panel *panel, const char *name, int colour, int mark);
/* Starts a table of numbers and returns its number; rows follow, then the end. */
int panel_table(struct report_panel *panel);
void panel_row(struct report_panel *panel, const double *values, int count);
void panel_table_end(struct report_panel *panel);
/* An element of the plot command; under those that panel_draw gives. */
void panel_draw_under(struct report_panel *panel, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void panel_draw(struct report_panel *panel, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* gnuplot's number of a filled mark, 0 to 4, again from 5 on. */
int panel_mark(int mark);

#endif
