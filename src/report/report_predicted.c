#include "report/report_predicted.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

#define POINTS_MOST    REPORT_PREDICTED_POINTS
#define PUBLISHED_MARK 1 /* a square */

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

void report_predicted_read(const struct results *results, const struct results_cell *cell,
                           struct report_predicted *out)
{
    *out = (struct report_predicted){.runs = 0};
    for (size_t i = 0; i < cell->run_count; i++) {
        struct curve c;
        const struct results_run *run = &cell->runs[i];
        if (!read_curve(results, run, &c) || (out->runs > 0 && c.count != out->count))
            continue;
        double work = cost_at(&c, results_number(results, run, "p_l"));
        out->runs++;
        out->count = c.count;
        out->published += results_number(results, run, "p_l_zsolnai2013");
        for (int k = 0; k < c.count; k++) {
            out->p[k] = c.p[k];
            out->error[k] += log(c.relmse[k] * c.cost[k] / work);
        }
    }
    out->published /= (double)out->runs;
    for (int k = 0; k < out->count; k++)
        out->error[k] = exp(out->error[k] / (double)out->runs);
}

double report_predicted_at(const struct report_predicted *predicted, double p)
{
    int k = 1;
    while (k < predicted->count - 1 && predicted->p[k] < p)
        k++;
    double slope = log(predicted->error[k] / predicted->error[k - 1]) /
                   log(predicted->p[k] / predicted->p[k - 1]);
    return predicted->error[k - 1] * pow(p / predicted->p[k - 1], slope);
}

static void draw_curve(const struct report_predicted *predicted, size_t all,
                       struct report_panel *panel)
{
    int table = panel_table(panel);
    for (int k = 0; k < predicted->count; k++)
        panel_row(panel, (double[]){predicted->p[k], predicted->error[k]}, 2);
    panel_table_end(panel);
    char *few = text_format("predicted by the start (%zu of %zu runs)", predicted->runs,
                            all);
    panel_entry(panel, predicted->runs < all ? few : "predicted by the start", COLOUR_INK,
                -1);
    mem_free(few);
    panel_draw(panel, "$d%d using 1:2 with lines lw 1.4 dt 2 lc rgb '#010101'", table);
}

static void draw_published(const struct report_predicted *predicted,
                           struct report_panel *panel)
{
    double p = predicted->published;
    if (!(p > 0.0))
        return;
    int table = panel_table(panel);
    panel_row(panel, (double[]){p, report_predicted_at(predicted, p)}, 2);
    panel_table_end(panel);
    panel_entry(panel, "published value (zsolnai2013), as predicted", COLOUR_INK,
                PUBLISHED_MARK);
    panel_draw(panel, "$d%d using 1:2 with points pt %d ps 1.1 lc rgb '#010101'", table,
               panel_mark(PUBLISHED_MARK));
}

void report_predicted_draw(const struct report_predicted *predicted, size_t all,
                           struct report_panel *panel)
{
    if (predicted->runs == 0)
        return;
    draw_curve(predicted, all, panel);
    draw_published(predicted, panel);
}
