#include "analysis/analysis_regret.h"

#include "base/mem.h"
#include "analysis/analysis_panel.h"
#include "analysis/resample.h"

#include <math.h>

enum { WAYS = 16 }; /* number of ways to halve the seeds */

/* Errors, or their logarithms, of the automatic cell and of the manual ones. */
struct table {
    const double *automatic; /* [seeds] */
    const double *manual;    /* [values][seeds] */
    size_t values, seeds;
    const int *sides; /* [WAYS][seeds] */
};

/* The table with the seed weights of one bootstrap replicate. */
struct weighed {
    const struct table *table;
    double *weights; /* [seeds] */
    double *sums;    /* [values], over all seeds */
    double *ones;    /* [values], over the seeds on side 1 of the current halving */
    double weight, weight_ones;
};

struct outcome {
    double automatic, best; /* means */
};

static double weighted_sum(const double *row, const double *weights, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += weights[i] * row[i];
    return sum;
}

static void weighed_init(struct weighed *w, const struct table *table)
{
    *w = (struct weighed){
        .table = table,
        .weights = mem_alloc(table->seeds, sizeof(double)),
        .sums = mem_alloc(table->values, sizeof(double)),
        .ones = mem_alloc(table->values, sizeof(double)),
    };
    for (size_t i = 0; i < table->seeds; i++)
        w->weights[i] = 1.0;
}

static void weighed_deinit(struct weighed *w)
{
    mem_free(w->weights);
    mem_free(w->sums);
    mem_free(w->ones);
}

static void sum_all(struct weighed *w)
{
    const struct table *t = w->table;
    w->weight = 0.0;
    for (size_t i = 0; i < t->seeds; i++)
        w->weight += w->weights[i];
    for (size_t v = 0; v < t->values; v++)
        w->sums[v] = weighted_sum(t->manual + v * t->seeds, w->weights, t->seeds);
}

static void sum_ones(struct weighed *w, const int *sides)
{
    const struct table *t = w->table;
    w->weight_ones = 0.0;
    for (size_t v = 0; v < t->values; v++)
        w->ones[v] = 0.0;
    for (size_t i = 0; i < t->seeds; i++) {
        if (!sides[i] || w->weights[i] == 0.0)
            continue;
        w->weight_ones += w->weights[i];
        for (size_t v = 0; v < t->values; v++)
            w->ones[v] += w->weights[i] * t->manual[v * t->seeds + i];
    }
}

/* Mean of a value over one side of the current halving. */
static double side_mean(const struct weighed *w, size_t v, int side)
{
    return side ? w->ones[v] / w->weight_ones
                : (w->sums[v] - w->ones[v]) / (w->weight - w->weight_ones);
}

static double judge(const struct weighed *w, int chosen_on)
{
    size_t best = 0;
    for (size_t v = 1; v < w->table->values; v++)
        if (side_mean(w, v, chosen_on) < side_mean(w, best, chosen_on))
            best = v;
    return side_mean(w, best, 1 - chosen_on);
}

/* Chooses the best value on one side and evaluates it on the other, averaged over all
 * halvings and both sides. A halving with a side without seeds (in a replicate) is
 * skipped. */
static struct outcome weigh(struct weighed *w)
{
    const struct table *t = w->table;
    double sum = 0.0, count = 0.0;
    sum_all(w);
    for (size_t way = 0; way < WAYS; way++) {
        sum_ones(w, t->sides + way * t->seeds);
        if (w->weight_ones == 0.0 || w->weight_ones == w->weight)
            continue;
        sum += judge(w, 0) + judge(w, 1);
        count += 2.0;
    }
    double automatic = weighted_sum(t->automatic, w->weights, t->seeds) / w->weight;
    return (struct outcome){automatic, count > 0.0 ? sum / count : (double)NAN};
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

/* A replicate of one repeated seed cannot be halved: the next one is drawn instead. */
static struct interval bootstrap(const struct table *t, bool logs, double noise)
{
    struct weighed w;
    double *replicates = mem_alloc(RESAMPLE_REPLICATES, sizeof *replicates);
    size_t done = 0;
    weighed_init(&w, t);
    struct outcome o = weigh(&w);
    double value = logs ? of_logs(o) : of_means(o, noise);
    for (size_t number = 0; done < RESAMPLE_REPLICATES; number++) {
        resample_counts(number, 0, t->seeds, w.weights);
        o = weigh(&w);
        if (isfinite(o.best))
            replicates[done++] = logs ? of_logs(o) : of_means(o, noise);
    }
    struct interval interval = interval_percentile(value, replicates, done, t->seeds);
    weighed_deinit(&w);
    mem_free(replicates);
    return interval;
}

/* --- few seeds --------------------------------------------------------------------- */

/* Number of the value with the lowest mean over all seeds but one. */
static size_t best_without(const struct table *t, size_t seed)
{
    size_t best = 0;
    double lowest = (double)INFINITY;
    for (size_t v = 0; v < t->values; v++) {
        double sum = 0.0;
        for (size_t i = 0; i < t->seeds; i++)
            sum += i == seed ? 0.0 : t->manual[v * t->seeds + i];
        if (sum < lowest) {
            lowest = sum;
            best = v;
        }
    }
    return best;
}

/* The best value is chosen without one seed and evaluated on it, for each seed. */
static struct interval leave_one_out(const struct table *t, double noise)
{
    double *ratios = mem_alloc(t->seeds, sizeof *ratios);
    for (size_t i = 0; i < t->seeds; i++) {
        double best = t->manual[best_without(t, i) * t->seeds + i];
        struct outcome o = {t->automatic[i], best};
        ratios[i] = of_means(o, noise);
    }
    struct interval interval = interval_log_mean(ratios, t->seeds);
    mem_free(ratios);
    return interval;
}

/* --- all --------------------------------------------------------------------------- */

static void take_naive(const struct table *t, const struct analysis_panel *panel,
                       struct analysis_regret *regret)
{
    struct weighed w;
    size_t best = 0;
    weighed_init(&w, t);
    sum_all(&w);
    for (size_t v = 1; v < t->values; v++)
        best = w.sums[v] < w.sums[best] ? v : best;
    double n = (double)t->seeds;
    struct outcome o = {weighted_sum(t->automatic, w.weights, t->seeds) / n,
                        w.sums[best] / n};
    regret->naive = of_means(o, panel->noise);
    regret->best = panel->cells[1 + best];
    regret->best_p_l = regret->best->p_l;
    struct interval a = interval_log_mean(t->automatic, t->seeds);
    struct interval b = interval_log_mean(t->manual + best * t->seeds, t->seeds);
    regret->resolved = panel->noise == 0.0 ||
                       (a.lo > panel->noise && b.lo > panel->noise);
    weighed_deinit(&w);
}

static int *make_sides(size_t seeds)
{
    int *sides = mem_alloc(WAYS * seeds, sizeof *sides);
    for (size_t way = 0; way < WAYS; way++)
        resample_halves(way, seeds, sides + way * seeds);
    return sides;
}

static void take_intervals(struct table *t, const struct analysis_panel *panel,
                           struct analysis_regret *regret)
{
    size_t count = panel->cell_count * t->seeds;
    int *sides = make_sides(t->seeds);
    double *logs = mem_alloc(count, sizeof *logs);
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

static void take_few(const struct table *t, const struct analysis_panel *panel,
                     struct analysis_regret *regret)
{
    if (regret->resolved)
        regret->regret = leave_one_out(t, panel->noise);
    regret->log_mean = leave_one_out(t, 0.0);
}

static struct table table_of(const struct analysis_panel *panel)
{
    return (struct table){.automatic = panel->errors,
                          .manual = panel->errors + panel->seed_count,
                          .values = panel->cell_count - 1,
                          .seeds = panel->seed_count};
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
        struct table t = table_of(&panel);
        regret.compared = t.values;
        take_naive(&t, &panel, &regret);
        if (t.seeds >= ANALYSIS_REGRET_SEEDS)
            take_intervals(&t, &panel, &regret);
        else if (t.seeds >= 2)
            take_few(&t, &panel, &regret);
        else
            regret.why = "one seed in common: two are needed";
        if (!regret.resolved)
            regret.why = "the errors do not stand above the reference's noise";
    }
    analysis_panel_deinit(&panel);
    return regret;
}

static double value_of(struct table *t, const struct analysis_panel *panel)
{
    if (t->seeds < 2) {
        double best = (double)INFINITY;
        for (size_t v = 0; v < t->values; v++)
            best = fmin(best, t->manual[v]);
        return of_means((struct outcome){t->automatic[0], best}, panel->noise);
    }
    if (t->seeds < ANALYSIS_REGRET_SEEDS)
        return leave_one_out(t, panel->noise).value;
    struct weighed w;
    int *sides = make_sides(t->seeds);
    t->sides = sides;
    weighed_init(&w, t);
    double value = of_means(weigh(&w), panel->noise);
    weighed_deinit(&w);
    mem_free(sides);
    return value;
}

double analysis_regret_value(const struct family *family, enum results_axis axis,
                             enum results_error error)
{
    struct analysis_panel panel;
    double value = (double)NAN;
    analysis_panel_make(family, axis, error, true, &panel);
    if (panel.why[0] == '\0') {
        struct table t = table_of(&panel);
        value = value_of(&t, &panel);
    }
    analysis_panel_deinit(&panel);
    return value;
}
