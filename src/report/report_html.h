#ifndef ETALON_REPORT_REPORT_HTML_H
#define ETALON_REPORT_REPORT_HTML_H

/* Pieces of HTML. What comes from files goes through html_text. */

#include "base/text.h"
#include "analysis/interval.h"

/* The text with & < > " ' as references: right between tags and in quoted attributes. */
void html_text(struct text *html, const char *text);

/* With that many decimals, or as HTML_SIGNIFICANT with three significant digits, without
 * padding: "0.0123", "1.23e-5"; a dash for NaN. */
#define HTML_SIGNIFICANT (-1)
void html_figure(struct text *html, double value, int decimals);

/* A table's cells: the value in full is what they are sorted by. */
void html_cell_text(struct text *html, const char *value);
void html_cell_sentence(struct text *html, const char *value); /* may be broken */
void html_cell(struct text *html, double value, int decimals);
void html_cell_count(struct text *html, size_t value);
/* Two: the value, and its interval. */
void html_cell_interval(struct text *html, const struct interval *interval, int decimals);
/* Two: the value, and plus or minus its standard error. */
void html_cell_error(struct text *html, double value, double error, int decimals);

/* A column's head with the button that sorts by it; `cells`: how many it stands over. It
 * starts at the table's cell number `column`. Returns the number after it. */
int html_head(struct text *html, const char *title, const char *help, int column,
              int cells, bool numeric);

#endif
