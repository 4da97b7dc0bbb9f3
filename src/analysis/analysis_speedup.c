#include "analysis/analysis_speedup.h"

#include "base/mem.h"
#include "analysis/analysis_curve.h"
#include "analysis/resample.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>

enum { GRID = 64 };

/* Curves of the seeds of a cell at common abscissae. */
struct sheet {
    double x[GRID]; /* log */
    double *logs;   /* [seeds][points], log error */
    size_t points, seeds;
};

static bool sheet_init(struct sheet *sheet, const struct results_cell *cell,
                       enum results_axis axis, enum results_error error)
{
    struct analysis_curve curve;
    double first, last;
    *sheet = (struct sheet){0};
    analysis_curve_make(cell, axis, error, GRID, &curve);
    sheet->points = curve.count;
    for (size_t i = 0; i < curve.count; i++)
        sheet->x[i] = log(curve.points[i].x);
    sheet->logs = mem_alloc(cell->run_count * sheet->points, sizeof *sheet->logs);
    bool ok = sheet->points > 0;
    for (size_t r = 0; ok && r < cell->run_count; r++) {
        if (!analysis_range(&cell->runs[r], axis, &first, &last))
            continue;
        double *to = sheet->logs + sheet->seeds++ * sheet->points;
        for (size_t i = 0; i < curve.count; i++) {
            double y = analysis_error_at(&cell->runs[r], axis, error, curve.points[i].x);
            to[i] = log(y);
            ok = ok && isfinite(to[i]);
        }
    }
    analysis_curve_deinit(&curve);
    return ok;
}

static void sheet_deinit(struct sheet *sheet)
{
    mem_free(sheet->logs);
}

/* Mean of the logs over the seeds, each as often as its count says. */
static void mean_curve(const struct sheet *sheet, const double *counts, double y[GRID])
{
    for (size_t i = 0; i < sheet->points; i++) {
        double sum = 0.0, count = 0.0;
        for (size_t s = 0; s < sheet->seeds; s++) {
            sum += counts[s] * sheet->logs[s * sheet->points + i];
            count += counts[s];
        }
        y[i] = sum / count;
    }
}

/* The first x at which the curve falls to the level; the first x of all if it begins
 * below. */
static double crossing(const struct sheet *sheet, const double y[GRID], double level)
{
    const double *x = sheet->x;
    for (size_t i = 0; i < sheet->points; i++)
        if (y[i] <= level)
            return i == 0 ? x[0]
                          : x[i] - (x[i] - x[i - 1]) * (level - y[i]) / (y[i - 1] - y[i]);
    return (double)NAN;
}

struct pair {
    struct sheet a, b;
    bool paired;
};

struct common_error {
    double error, x_a, x_b; /* logs */
    bool bound;
};

static struct common_error common_error(const struct pair *pair, const double *counts_a,
                                        const double *counts_b)
{
    const struct sheet *a = &pair->a, *b = &pair->b;
    double ya[GRID] = {0.0}, yb[GRID] = {0.0};
    mean_curve(a, counts_a, ya);
    mean_curve(b, counts_b, yb);
    double error = fmax(ya[a->points - 1], yb[b->points - 1]);
    return (struct common_error){
        .error = error,
        .x_a = crossing(a, ya, error),
        .x_b = crossing(b, yb, error),
        .bound = ya[0] < error || yb[0] < error,
    };
}

static double replicate(const struct pair *pair, size_t number, double *counts_a,
                        double *counts_b, bool *bound)
{
    resample_counts(number, 0, pair->a.seeds, counts_a);
    resample_counts(number, pair->paired ? 0 : 1, pair->b.seeds, counts_b);
    struct common_error m = common_error(pair, counts_a, counts_b);
    *bound = m.bound;
    return exp(m.x_b - m.x_a);
}

static void count_all_once(const struct pair *pair, double *counts_a, double *counts_b)
{
    for (size_t i = 0; i < pair->a.seeds; i++)
        counts_a[i] = 1.0;
    for (size_t i = 0; i < pair->b.seeds; i++)
        counts_b[i] = 1.0;
}

static double log_ratio(const struct pair *pair, const double *counts_a,
                        const double *counts_b)
{
    struct common_error m = common_error(pair, counts_a, counts_b);
    return m.x_b - m.x_a;
}

/* Variance of the log ratio by leaving out each seed of a sheet in turn; of both if they
 * are paired. The counts are all 1 before and after. */
static double jackknife(const struct pair *pair, double *counts, double *also,
                        size_t seeds, const double *counts_a, const double *counts_b)
{
    struct welford w = {0};
    for (size_t i = 0; i < seeds; i++) {
        counts[i] = 0.0;
        if (also)
            also[i] = 0.0;
        welford_add(&w, log_ratio(pair, counts_a, counts_b));
        counts[i] = 1.0;
        if (also)
            also[i] = 1.0;
    }
    return w.m2 * ((double)seeds - 1.0) / (double)seeds;
}

/* Few seeds: percentiles of a bootstrap lie between the seeds' own ratios. */
static struct interval few_seeds(const struct pair *pair, double *counts_a,
                                 double *counts_b, size_t seeds)
{
    struct interval interval = interval_nothing();
    double ratio = log_ratio(pair, counts_a, counts_b);
    interval.value = exp(ratio);
    if (seeds < 2)
        return interval;
    double variance =
        pair->paired
            ? jackknife(pair, counts_a, counts_b, seeds, counts_a, counts_b)
            : jackknife(pair, counts_a, NULL, pair->a.seeds, counts_a, counts_b) +
                  jackknife(pair, counts_b, NULL, pair->b.seeds, counts_a, counts_b);
    double half = student_quantile(0.5 + 0.5 * INTERVAL_LEVEL, (double)seeds - 1.0) *
                  sqrt(variance);
    interval.lo = exp(ratio - half);
    interval.hi = exp(ratio + half);
    return interval;
}

static void estimate(const struct pair *pair, struct analysis_speedup *speedup)
{
    double *counts_a = mem_alloc(pair->a.seeds, sizeof *counts_a);
    double *counts_b = mem_alloc(pair->b.seeds, sizeof *counts_b);
    double *ratios = mem_alloc(RESAMPLE_REPLICATES, sizeof *ratios);
    count_all_once(pair, counts_a, counts_b);
    struct common_error m = common_error(pair, counts_a, counts_b);
    speedup->error = exp(m.error);
    speedup->x_a = exp(m.x_a);
    speedup->x_b = exp(m.x_b);
    speedup->at_least = m.bound;
    speedup->replicates = RESAMPLE_REPLICATES;
    for (size_t i = 0; i < RESAMPLE_REPLICATES; i++) {
        bool bound;
        ratios[i] = replicate(pair, i, counts_a, counts_b, &bound);
        speedup->clipped += bound;
    }
    count_all_once(pair, counts_a, counts_b);
    speedup->ratio = speedup->seeds < ANALYSIS_SPEEDUP_SEEDS
                         ? few_seeds(pair, counts_a, counts_b, speedup->seeds)
                         : interval_percentile(exp(m.x_b - m.x_a), ratios,
                                               RESAMPLE_REPLICATES, speedup->seeds);
    mem_free(counts_a);
    mem_free(counts_b);
    mem_free(ratios);
}

/* Seeds without a curve would misalign the two lists. */
static bool same_seeds(const struct results_cell *a, const struct results_cell *b,
                       const struct pair *pair)
{
    bool same = a->run_count == b->run_count && pair->a.seeds == a->run_count &&
                pair->b.seeds == b->run_count;
    for (size_t i = 0; same && i < a->run_count; i++)
        same = a->runs[i].seed == b->runs[i].seed;
    return same;
}

struct analysis_speedup analysis_speedup(const struct results_cell *a,
                                         const struct results_cell *b,
                                         enum results_axis axis, enum results_error error)
{
    const double nan = (double)NAN;
    struct analysis_speedup speedup = {
        .ratio = interval_nothing(), .error = nan, .x_a = nan, .x_b = nan};
    struct pair pair;
    bool ok_a = sheet_init(&pair.a, a, axis, error);
    bool ok_b = sheet_init(&pair.b, b, axis, error);
    pair.paired = speedup.paired = same_seeds(a, b, &pair);
    speedup.seeds = pair.a.seeds < pair.b.seeds ? pair.a.seeds : pair.b.seeds;
    if (ok_a && ok_b)
        estimate(&pair, &speedup);
    speedup.resolved = speedup.error > fmax(a->noise[error], b->noise[error]) &&
                       analysis_final(a, error).resolved &&
                       analysis_final(b, error).resolved;
    sheet_deinit(&pair.a);
    sheet_deinit(&pair.b);
    return speedup;
}
