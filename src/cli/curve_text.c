/* The table has a row for each point of the curve and two more, at the p_l that was
 * chosen and at the published one. The plot shows the same errors at equal work over a
 * linear axis of p_l. */

#include "cli/curve_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS 61 /* of the plot, for p_l from 0 to 1 */
#define ROWS    9  /* of the plot */
#define TICS    5
#define MOST    4.0 /* times the error at the chosen p_l; what is above is left out */

/* --- table ------------------------------------------------------------------------- */

struct row {
    double p;
    const char *mark;
};

static int compare_rows(const void *a, const void *b)
{
    const struct row *x = a, *y = b;
    return (x->p > y->p) - (x->p < y->p);
}

static void print_row(const struct run_statistics *s, const struct row *row, FILE *out)
{
    const struct tours_curve *curve = &s->tours.curve;
    double work = tours_curve_cost(curve, row->p), chosen = s->plarge.p_l;
    double relmse = exp(tours_curve_height_at(curve, row->p)) / work;
    fprintf(out, "# %6.3f %10.3g %8.2f %7.2f%s%s\n", row->p, relmse, work,
            tours_regret(curve, row->p, chosen), *row->mark ? "  <- " : "", row->mark);
}

static void print_table(const struct run_statistics *s, FILE *out)
{
    struct row rows[TOURS_POINTS + 2];
    bool published = s->plarge.p_l == s->p_l_zsolnai2013;
    int count = TOURS_POINTS;
    for (int i = 0; i < TOURS_POINTS; i++)
        rows[i] = (struct row){tours_p[i], ""};
    rows[count++] = (struct row){s->plarge.p_l,
                                 published ? "chosen: zsolnai2013" : "chosen"};
    if (!published)
        rows[count++] = (struct row){s->p_l_zsolnai2013, "zsolnai2013"};
    qsort(rows, (size_t)count, sizeof *rows, compare_rows);
    fprintf(out,
            "# predicted relMSE at the end of the run by p_l; work: of a "
            "mutation;\n# times: relMSE at equal work over that of the chosen p_l\n");
    fprintf(out, "# %6s %10s %8s %7s\n", "p_l", "relMSE", "work", "times");
    for (int i = 0; i < count; i++)
        print_row(s, &rows[i], out);
}

/* --- plot -------------------------------------------------------------------------- */

static int column_of(double p)
{
    return (int)lrint(fmin(fmax(p, 0.0), 1.0) * (COLUMNS - 1));
}

struct plot {
    double low, high; /* of ln times */
    char cells[ROWS][COLUMNS];
};

/* Without the blanks at its end. */
static void print_line(const char *line, int length, FILE *out)
{
    while (length > 0 && line[length - 1] == ' ')
        length--;
    fprintf(out, "%.*s\n", length, line);
}

/* ln of times in a column; the first one shows the least p_l of the curve. */
static double height_of(const struct run_statistics *s, int column)
{
    double p = fmax((double)column / (COLUMNS - 1), tours_p[0]);
    return log(tours_regret(&s->tours.curve, p, s->plarge.p_l));
}

static double row_height(const struct plot *plot, int row)
{
    return plot->high - (plot->high - plot->low) * row / (ROWS - 1);
}

static void put(struct plot *plot, double p, double height, char mark)
{
    double row = (plot->high - height) / (plot->high - plot->low) * (ROWS - 1);
    if (row > -0.5)
        plot->cells[(int)lrint(fmax(row, 0.0))][column_of(p)] = mark;
}

static void draw(const struct run_statistics *s, struct plot *plot)
{
    double chosen = s->plarge.p_l, published = s->p_l_zsolnai2013;
    plot->low = 0.0;
    plot->high = log(1.2);
    for (int i = 0; i < COLUMNS; i++) {
        plot->low = fmin(plot->low, height_of(s, i));
        plot->high = fmax(plot->high, height_of(s, i));
    }
    plot->high = fmin(plot->high, fmax(log(MOST), plot->low + log(MOST)));
    for (int r = 0; r < ROWS; r++)
        memset(plot->cells[r], ' ', COLUMNS);
    for (int i = 0; i < COLUMNS; i++)
        put(plot, (double)i / (COLUMNS - 1), height_of(s, i), '.');
    put(plot, published, log(tours_regret(&s->tours.curve, published, chosen)), 'Z');
    put(plot, chosen, 0.0, 'C');
}

static void print_axis(FILE *out)
{
    int gap = (COLUMNS - 1) / TICS;
    fprintf(out, "#       +");
    for (int i = 0; i < COLUMNS; i++)
        fputc(i % gap ? '-' : '+', out);
    fprintf(out, "\n#        0");
    for (int i = 1; i <= TICS; i++)
        fprintf(out, "%*.1f", i > 1 ? gap : gap + 1, (double)i / TICS);
    fprintf(out, "\n");
}

/* The 99 % interval below the axis, as long as it is. */
static void print_interval(const struct plarge *plarge, FILE *out)
{
    char line[COLUMNS];
    int from = column_of(plarge->p_l_lo), to = column_of(plarge->p_l_hi);
    memset(line, ' ', sizeof line);
    memset(line + from, '-', (size_t)to - (size_t)from + 1);
    line[from] = '[';
    line[to] = ']';
    line[column_of(plarge->p_l)] = 'C';
    fprintf(out, "#        %.*s  C: chosen, 99 %% interval\n", to + 1, line);
}

static void print_plot(const struct run_statistics *s, FILE *out)
{
    struct plot plot;
    draw(s, &plot);
    fprintf(out, "#\n# times against p_l; C: chosen, Z: zsolnai2013\n");
    for (int r = 0; r < ROWS; r++) {
        fprintf(out, "# %5.2f |", exp(row_height(&plot, r)));
        print_line(plot.cells[r], COLUMNS, out);
    }
    print_axis(out);
    print_interval(&s->plarge, out);
}

void curve_print(const struct run_statistics *s, FILE *out)
{
    if (!isfinite(s->p_l_zsolnai2013))
        return;
    if (s->tours.found) {
        print_table(s, out);
        print_plot(s, out);
    }
    fprintf(out, "# p_l = %.3f; zsolnai2013: %.3f\n# %s\n", s->plarge.p_l,
            s->p_l_zsolnai2013, s->plarge.reason);
}
