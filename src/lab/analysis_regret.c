#include "lab/analysis_regret.h"

#include "base/mem.h"
#include "lab/analysis_panel.h"
#include "lab/resample.h"

#include <math.h>

enum { WAYS = 32 }; /* to halve the seeds */

/* Figures of the automatic cell and of manual ones, errors or their logs. */
struct table {
    const double *automatic; /* [seeds] */
    const double *manual;    /* [values][seeds] */
    size_t values, seeds;
    const int *sides; /* [WAYS][seeds] */
};

struct outcome {
    double automatic, best; /* means */
};

/* Mean of the row over one side, or over all if side < 0; NaN if that has no weight. */
static double side_mean(const double *row, const double *weights, const int *sides,
                        size_t n, int side)
{
    double sum = 0.0, weight = 0.0;
    for (size_t i = 0; i < n; i++)
        if (side < 0 || sides[i] == side) {
            sum += weights[i] * row[i];
            weight += weights[i];
        }
    return weight > 0.0 ? sum / weight : (double)NAN;
}

static size_t choose(const struct table *t, const double *weights, const int *sides,
                     int side)
{
    size_t best = 0;
    double least = (double)INFINITY;
    for (size_t v = 0; v < t->values; v++) {
        double mean = side_mean(t->manual + v * t->seeds, weights, sides, t->seeds, side);
        if (mean < least) {
            least = mean;
            best = v;
        }
    }
    return best;
}

/* Chosen on one side and judged on the other, over all ways and both sides. A way that
 * leaves a side without a seed (in a replicate) says nothing. */
static struct outcome weigh(const struct table *t, const double *weights)
{
    double sum = 0.0, count = 0.0;
    for (size_t way = 0; way < WAYS; way++)
        for (int side = 0; side < 2; side++) {
            const int *sides = t->sides + way * t->seeds;
            size_t v = choose(t, weights, sides, side);
            double judged = side_mean(t->manual + v * t->seeds, weights, sides, t->seeds,
                                      1 - side);
            bool both = isfinite(judged) &&
                        isfinite(side_mean(t->manual, weights, sides, t->seeds, side));
            sum += both ? judged : 0.0;
            count += both;
        }
    return (struct outcome){side_mean(t->automatic, weights, NULL, t->seeds, -1),
                            count > 0.0 ? sum / count : (double)NAN};
}

static double of_means(struct outcome o, double noise)
{
    double above = o.automatic - noise, below = o.best - noise;
    return above > 0.0 && below > 0.0 ? above / below : (double)NAN;
}

static double of_logs(struct outcome o)
{
    return exp(o.automatic - o.best);
}

/* A replicate of a single seed over and over has no two halves: the next one is drawn. */
static struct interval bootstrap(const struct table *t, bool logs, double noise)
{
    double *weights = mem_alloc(t->seeds, sizeof *weights);
    double *replicates = mem_alloc(RESAMPLE_REPLICATES, sizeof *replicates);
    size_t done = 0;
    for (size_t i = 0; i < t->seeds; i++)
        weights[i] = 1.0;
    struct outcome o = weigh(t, weights);
    double value = logs ? of_logs(o) : of_means(o, noise);
    for (size_t number = 0; done < RESAMPLE_REPLICATES; number++) {
        resample_counts(number, 0, t->seeds, weights);
        o = weigh(t, weights);
        if (isfinite(o.best))
            replicates[done++] = logs ? of_logs(o) : of_means(o, noise);
    }
    struct interval interval = interval_percentile(value, replicates, done, t->seeds);
    mem_free(weights);
    mem_free(replicates);
    return interval;
}

static void take_naive(const struct table *t, const struct analysis_panel *panel,
                       struct analysis_regret *regret)
{
    double *ones = mem_alloc(t->seeds, sizeof *ones);
    for (size_t i = 0; i < t->seeds; i++)
        ones[i] = 1.0;
    size_t best = choose(t, ones, NULL, -1);
    struct outcome o = {side_mean(t->automatic, ones, NULL, t->seeds, -1),
                        side_mean(t->manual + best * t->seeds, ones, NULL, t->seeds, -1)};
    regret->naive = of_means(o, panel->noise);
    regret->best = panel->cells[1 + best];
    regret->best_p_l = regret->best->p_l;
    struct interval a = interval_log_mean(t->automatic, t->seeds);
    struct interval b = interval_log_mean(t->manual + best * t->seeds, t->seeds);
    regret->resolved = panel->noise == 0.0 ||
                       (a.lo > panel->noise && b.lo > panel->noise);
    mem_free(ones);
}

static void take_intervals(struct table *t, const struct analysis_panel *panel,
                           struct analysis_regret *regret)
{
    size_t count = panel->cell_count * t->seeds;
    int *sides = mem_alloc(WAYS * t->seeds, sizeof *sides);
    double *logs = mem_alloc(count, sizeof *logs);
    for (size_t way = 0; way < WAYS; way++)
        resample_halves(way, t->seeds, sides + way * t->seeds);
    for (size_t i = 0; i < count; i++)
        logs[i] = log(panel->errors[i]);
    t->sides = sides;
    regret->replicates = RESAMPLE_REPLICATES;
    if (regret->resolved)
        regret->regret = bootstrap(t, false, panel->noise);
    struct table of_logs_table = *t;
    of_logs_table.automatic = logs;
    of_logs_table.manual = logs + t->seeds;
    regret->log_mean = bootstrap(&of_logs_table, true, 0.0);
    mem_free(sides);
    mem_free(logs);
}

struct analysis_regret analysis_regret(const struct family *family,
                                       enum results_axis axis, enum results_error error)
{
    const double nan = (double)NAN;
    struct analysis_panel panel;
    struct analysis_regret regret = {.x = nan,
                                     .regret = interval_nothing(),
                                     .log_mean = interval_nothing(),
                                     .naive = nan,
                                     .best_p_l = nan};
    analysis_panel_make(family, axis, error, true, &panel);
    regret.x = panel.x;
    regret.left_out = panel.left_out;
    regret.seeds = panel.seed_count;
    regret.why = panel.why;
    if (panel.why[0] == '\0') {
        struct table t = {.automatic = panel.errors,
                          .manual = panel.errors + panel.seed_count,
                          .values = panel.cell_count - 1,
                          .seeds = panel.seed_count};
        regret.compared = t.values;
        take_naive(&t, &panel, &regret);
        if (t.seeds >= ANALYSIS_REGRET_SEEDS)
            take_intervals(&t, &panel, &regret);
        else
            regret.why = "not enough seeds in common: four are needed";
        if (!regret.resolved)
            regret.why = "the errors do not stand above the reference's noise";
    }
    analysis_panel_deinit(&panel);
    return regret;
}
