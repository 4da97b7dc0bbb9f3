#include "report/report_html.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define NOT_KNOWN "\u2013"

void html_text(struct text *html, const char *text)
{
    static const char special[] = "&<>\"'";
    static const char *const references[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
    while (*text) {
        size_t plain = strcspn(text, special);
        text_append(html, "%.*s", (int)plain, text);
        text += plain;
        if (*text)
            text_append(html, "%s", references[strchr(special, *text++) - special]);
    }
}

/* 1.2e-05 as 1.2e-5. */
static void append_scientific(struct text *html, double value)
{
    char digits[40];
    snprintf(digits, sizeof digits, "%.2e", value);
    char *e = strchr(digits, 'e');
    text_append(html, "%.*se%s%s", (int)(e - digits), digits, e[1] == '-' ? "-" : "",
                e[2] == '0' ? e + 3 : e + 2);
}

void html_figure(struct text *html, double value, int decimals)
{
    double size = fabs(value);
    if (isnan(value))
        text_append(html, NOT_KNOWN);
    else if (isinf(value))
        text_append(html, value > 0.0 ? "\u221e" : "-\u221e");
    else if (decimals >= 0)
        text_append(html, "%.*f", decimals, value);
    else if (size != 0.0 && (size < 1e-3 || size >= 99999.5))
        append_scientific(html, value);
    else {
        int digits = size > 0.0 ? 2 - (int)floor(log10(size)) : 2;
        text_append(html, "%.*f", digits > 0 ? digits : 0, value);
    }
}

void html_cell_text(struct text *html, const char *value)
{
    text_append(html, "<td>");
    html_text(html, value);
    text_append(html, "</td>");
}

void html_cell_sentence(struct text *html, const char *value)
{
    text_append(html, "<td class=\"wrap\">");
    html_text(html, value);
    text_append(html, "</td>");
}

static void open_number(struct text *html, double value, const char *class)
{
    text_append(html, "<td class=\"number%s\"", class);
    if (isfinite(value))
        text_append(html, " data-value=\"%.17g\"", value);
    text_append(html, ">");
}

void html_cell(struct text *html, double value, int decimals)
{
    open_number(html, value, "");
    html_figure(html, value, decimals);
    text_append(html, "</td>");
}

void html_cell_count(struct text *html, size_t value)
{
    text_append(html, "<td class=\"number\" data-value=\"%zu\">%zu</td>", value, value);
}

void html_cell_interval(struct text *html, const struct interval *interval, int decimals)
{
    html_cell(html, interval->value, decimals);
    text_append(html, "<td class=\"range\">");
    if (interval_is_known(interval)) {
        html_figure(html, interval->lo, decimals);
        text_append(html, "\u2009\u2026\u2009");
        html_figure(html, interval->hi, decimals);
    }
    text_append(html, "</td>");
}

void html_cell_error(struct text *html, double value, double error, int decimals)
{
    html_cell(html, value, decimals);
    text_append(html, "<td class=\"range\">");
    if (isfinite(error)) {
        text_append(html, "\u00b1\u2009");
        html_figure(html, error, decimals);
    }
    text_append(html, "</td>");
}

int html_head(struct text *html, const char *title, const char *help, int column,
              int cells, bool numeric)
{
    text_append(html, "<th scope=\"col\" aria-sort=\"none\"%s",
                numeric ? " class=\"number\"" : "");
    if (cells > 1)
        text_append(html, " colspan=\"%d\"", cells);
    text_append(html, "><button type=\"button\" data-column=\"%d\" title=\"", column);
    html_text(html, help);
    text_append(html, "\">%s</button></th>", title);
    return column + cells;
}
