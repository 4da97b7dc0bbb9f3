#include "report/report_predicted.h"

#include <math.h>
#include <stdlib.h>

#define POINTS_MOST 64

/* Reads numbers that are separated by blanks; returns how many. */
static int read_list(const char *text, double values[POINTS_MOST])
{
    int count = 0;
    char *end;
    while (text && count < POINTS_MOST) {
        double value = strtod(text, &end);
        if (end == text)
            break;
        values[count++] = value;
        text = end;
    }
    return count;
}

struct curve {
    double p[POINTS_MOST], relmse[POINTS_MOST], cost[POINTS_MOST];
    int count;
};

static bool read_curve(const struct results *results, const struct results_run *run,
                       struct curve *c)
{
    c->count = read_list(results_text(results, run, "predicted_p"), c->p);
    return c->count > 1 &&
           read_list(results_text(results, run, "predicted_relmse"), c->relmse) ==
               c->count &&
           read_list(results_text(results, run, "predicted_cost"), c->cost) == c->count;
}

/* Work is linear in p. */
static double cost_at(const struct curve *c, double p)
{
    int last = c->count - 1;
    double slope = (c->cost[last] - c->cost[0]) / (c->p[last] - c->p[0]);
    return c->cost[0] + slope * (p - c->p[0]);
}

void report_draw_predicted(const struct results *results, const struct results_cell *cell,
                           struct report_panel *panel)
{
    struct curve sum = {.count = 0};
    for (size_t i = 0; i < cell->run_count; i++) {
        struct curve c;
        if (!read_curve(results, &cell->runs[i], &c) || (i > 0 && c.count != sum.count))
            return;
        double work = cost_at(&c, results_number(results, &cell->runs[i], "p_l"));
        sum.count = c.count;
        for (int k = 0; k < c.count; k++) {
            sum.p[k] = c.p[k];
            sum.relmse[k] += log(c.relmse[k] * c.cost[k] / work) /
                             (double)cell->run_count;
        }
    }
    if (sum.count == 0)
        return;
    int table = panel_table(panel);
    for (int k = 0; k < sum.count; k++)
        panel_row(panel, (double[]){sum.p[k], exp(sum.relmse[k])}, 2);
    panel_table_end(panel);
    panel_entry(panel, "predicted by the start", COLOUR_INK, -1);
    panel_draw(panel, "$d%d using 1:2 with lines lw 1.4 dt 2 lc rgb '#010101'", table);
}
