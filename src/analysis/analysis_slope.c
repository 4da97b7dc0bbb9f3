#include "analysis/analysis_slope.h"

#include "base/mem.h"
#include "analysis/analysis_curve.h"

#include <math.h>

/* Two snapshots always lie on a line. */
enum { SNAPSHOTS_LEAST = 3 };

struct fit {
    double count, x, y, xx, xy; /* means, and sums of products of deviations */
};

static void fit_add(struct fit *fit, double x, double y)
{
    fit->count += 1.0;
    double dx = x - fit->x;
    fit->x += dx / fit->count;
    fit->y += (y - fit->y) / fit->count;
    fit->xx += dx * (x - fit->x);
    fit->xy += dx * (y - fit->y);
}

/* NaN if there are too few snapshots, or one whose error is not above the noise. */
static double slope_of(const struct results_run *run, enum results_axis axis,
                       enum results_error error, double noise)
{
    double first, last;
    struct fit fit = {0};
    if (!analysis_range(run, axis, &first, &last))
        return (double)NAN;
    for (size_t i = 0; i < run->snapshot_count; i++) {
        const struct results_snapshot *s = &run->snapshots[i];
        if (s->at[axis] < sqrt(first) * sqrt(last))
            continue;
        double y = s->error[error] - noise;
        fit_add(&fit, log(s->at[axis]), y > 0.0 ? log(y) : (double)NAN);
    }
    return fit.count >= SNAPSHOTS_LEAST && fit.xx > 0.0 ? fit.xy / fit.xx : (double)NAN;
}

struct analysis_slope analysis_slope(const struct results_cell *cell,
                                     enum results_axis axis, enum results_error error)
{
    struct analysis_slope slope = {0};
    double *raw = mem_alloc(cell->run_count, sizeof *raw);
    double *corrected = mem_alloc(cell->run_count, sizeof *corrected);
    for (size_t i = 0; i < cell->run_count; i++) {
        double of_run = slope_of(&cell->runs[i], axis, error, 0.0);
        if (isnan(of_run))
            continue;
        raw[slope.seeds] = of_run;
        corrected[slope.seeds++] = slope_of(&cell->runs[i], axis, error,
                                            cell->noise[error]);
    }
    slope.raw = interval_mean(raw, slope.seeds);
    slope.corrected = interval_mean(corrected, slope.seeds);
    mem_free(raw);
    mem_free(corrected);
    return slope;
}
