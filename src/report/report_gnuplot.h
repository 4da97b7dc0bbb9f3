#ifndef ETALON_REPORT_REPORT_GNUPLOT_H
#define ETALON_REPORT_REPORT_GNUPLOT_H

/* Plots by gnuplot, as SVG elements to stand in the page: without a background, colours
 * that the page's style decides, no name that two plots would share. */

#include "base/text.h"

/* Colours in scripts: "#0b0b0b" stands for the variable --plot-11 of the page's style. */

#define REPORT_PLOT_ELEMENTS 96

struct report_plot {
    struct text script;
    int width, height;
    /* Which entry of the legend each element of its `plot` command belongs to. */
    int series[REPORT_PLOT_ELEMENTS], elements;
    char *svg; /* NULL: there is none */
};

/* Runs all scripts in one gnuplot. False if it is not there or fails. */
bool report_gnuplot(struct report_plot *plots, size_t count, struct err *err);

#endif
