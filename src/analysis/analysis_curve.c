#include "analysis/analysis_curve.h"

#include "base/mem.h"

#include <math.h>

/* The value at x of the line through (x0,y0) and (x1,y1) in log-log. */
static double line_at(double x, double x0, double y0, double x1, double y1)
{
    if (!(x0 > 0.0 && y0 > 0.0 && x1 >= x0 && y1 > 0.0))
        return (double)NAN;
    if (x1 == x0)
        return y1;
    return exp(log(y0) + log(x / x0) / log(x1 / x0) * log(y1 / y0));
}

double analysis_error_at(const struct results_run *run, enum results_axis axis,
                         enum results_error error, double x)
{
    const struct results_snapshot *s = run->snapshots;
    for (size_t i = 0; i < run->snapshot_count; i++) {
        if (s[i].at[axis] == x)
            return s[i].error[error] > 0.0 ? s[i].error[error] : (double)NAN;
        if (i > 0 && s[i - 1].at[axis] < x && x < s[i].at[axis])
            return line_at(x, s[i - 1].at[axis], s[i - 1].error[error], s[i].at[axis],
                           s[i].error[error]);
    }
    return (double)NAN;
}

bool analysis_range(const struct results_run *run, enum results_axis axis, double *first,
                    double *last)
{
    if (run->snapshot_count == 0)
        return false;
    *first = run->snapshots[0].at[axis];
    *last = run->snapshots[run->snapshot_count - 1].at[axis];
    return *first > 0.0 && *last >= *first;
}

/* --- mean over seeds ------------------------------------------------------------- */

static struct analysis_point mean_point(double x, const double *raw, size_t n,
                                        double noise)
{
    struct analysis_point point = {.x = x, .raw = interval_log_mean(raw, n)};
    double *corrected = mem_alloc(n, sizeof *corrected);
    bool positive = n > 0;
    for (size_t i = 0; i < n; i++) {
        corrected[i] = raw[i] - noise;
        positive = positive && corrected[i] > 0.0;
    }
    /* A single seed has no interval, so nothing shows that its error is above the noise.
     */
    point.resolved = positive && (noise == 0.0 || point.raw.lo > noise);
    point.corrected = point.resolved ? interval_log_mean(corrected, n)
                                     : interval_nothing();
    mem_free(corrected);
    return point;
}

/* The range that the curves of all seeds cover; counts the seeds without a curve. */
static bool common_range(const struct results_cell *cell, enum results_axis axis,
                         struct analysis_curve *curve, double *first, double *last)
{
    *first = 0.0;
    *last = (double)INFINITY;
    for (size_t i = 0; i < cell->run_count; i++) {
        double a, b;
        if (!analysis_range(&cell->runs[i], axis, &a, &b)) {
            curve->left_out++;
            continue;
        }
        curve->seeds++;
        *first = fmax(*first, a);
        *last = fmin(*last, b);
    }
    return curve->seeds > 0 && *first <= *last;
}

static struct analysis_point point_at(const struct results_cell *cell,
                                      enum results_axis axis, enum results_error error,
                                      double x)
{
    double *raw = mem_alloc(cell->run_count, sizeof *raw), a, b;
    size_t n = 0;
    for (size_t i = 0; i < cell->run_count; i++)
        if (analysis_range(&cell->runs[i], axis, &a, &b))
            raw[n++] = analysis_error_at(&cell->runs[i], axis, error, x);
    struct analysis_point point = mean_point(x, raw, n, cell->noise[error]);
    mem_free(raw);
    return point;
}

void analysis_curve_make(const struct results_cell *cell, enum results_axis axis,
                         enum results_error error, size_t points,
                         struct analysis_curve *curve)
{
    double first, last;
    *curve = (struct analysis_curve){.noise = cell->noise[error]};
    if (!common_range(cell, axis, curve, &first, &last))
        return;
    curve->count = first < last ? points : 1;
    curve->points = mem_alloc(curve->count, sizeof *curve->points);
    for (size_t i = 0; i < curve->count; i++) {
        double share = (double)i / (double)(points - 1);
        double x = first * pow(last / first, share);
        /* Exactly at the ends, as there are no values beyond them. */
        x = i == 0 ? first : i + 1 == points ? last : x;
        curve->points[i] = point_at(cell, axis, error, x);
    }
}

void analysis_curve_deinit(struct analysis_curve *curve)
{
    mem_free(curve->points);
    *curve = (struct analysis_curve){0};
}

struct analysis_point analysis_final(const struct results_cell *cell,
                                     enum results_error error)
{
    double *raw = mem_alloc(cell->run_count, sizeof *raw);
    for (size_t i = 0; i < cell->run_count; i++)
        raw[i] = cell->runs[i].error[error];
    struct analysis_point point = mean_point((double)NAN, raw, cell->run_count,
                                             cell->noise[error]);
    mem_free(raw);
    return point;
}
