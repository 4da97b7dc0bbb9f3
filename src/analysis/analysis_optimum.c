#include "analysis/analysis_optimum.h"

#include "base/mem.h"
#include "analysis/analysis_panel.h"
#include "analysis/interval.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>

/* p of mean(log a - log b) > 0; the mean itself in *mean. */
static double test_worse(const double *a, const double *b, size_t n, double *mean)
{
    struct welford w = {0};
    for (size_t i = 0; i < n; i++)
        welford_add(&w, log(a[i] / b[i]));
    *mean = w.mean;
    double se = welford_se(&w);
    /* The same difference for every seed: equal pictures, or a certain loss. */
    if (!(se > 0.0))
        return w.mean > 0.0 ? 0.0 : 1.0;
    return student_tail(w.mean / se, (double)n - 1.0);
}

static void take_values(const struct analysis_panel *panel,
                        struct analysis_optimum *optimum)
{
    size_t skip = panel->has_auto ? 1 : 0;
    optimum->count = panel->cell_count - skip;
    optimum->values = mem_alloc(optimum->count, sizeof *optimum->values);
    for (size_t v = 0; v < optimum->count; v++) {
        const double *row = analysis_panel_row(panel, v + skip);
        optimum->values[v] = (struct analysis_optimum_value){
            .cell = panel->cells[v + skip],
            .p_l = panel->cells[v + skip]->p_l,
            .mean = interval_log_mean(row, panel->seed_count).value,
            .worse = (double)NAN,
            .p = (double)NAN,
        };
        if (optimum->values[v].mean < optimum->values[optimum->best].mean)
            optimum->best = v;
    }
}

static void test_values(const struct analysis_panel *panel,
                        struct analysis_optimum *optimum)
{
    size_t skip = panel->has_auto ? 1 : 0;
    const double *best = analysis_panel_row(panel, optimum->best + skip);
    double others = fmax(1.0, (double)optimum->count - 1.0);
    optimum->level = -expm1(log1p(-ANALYSIS_OPTIMUM_ALPHA) / others); /* [Sidak67] */
    for (size_t v = 0; v < optimum->count; v++) {
        struct analysis_optimum_value *value = &optimum->values[v];
        double mean;
        value->p = test_worse(analysis_panel_row(panel, v + skip), best,
                              panel->seed_count, &mean);
        value->worse = exp(mean);
        value->in_set = value->p >= optimum->level;
        if (!value->in_set)
            continue;
        optimum->lo = fmin(optimum->lo, value->p_l); /* fmin ignores a NaN */
        optimum->hi = fmax(optimum->hi, value->p_l);
    }
}

void analysis_optimum_make(const struct family *family, enum results_axis axis,
                           enum results_error error, struct analysis_optimum *optimum)
{
    const double nan = (double)NAN;
    struct analysis_panel panel;
    *optimum = (struct analysis_optimum){.lo = nan, .hi = nan, .level = nan};
    analysis_panel_make(family, axis, error, false, &panel);
    optimum->x = panel.x;
    optimum->seeds = panel.seed_count;
    optimum->left_out = panel.left_out;
    optimum->why = panel.why;
    optimum->p_l_auto = family->automatic ? family->automatic->p_l_mean : nan;
    if (panel.why[0] == '\0') {
        take_values(&panel, optimum);
        if (panel.seed_count >= 2)
            test_values(&panel, optimum);
        else
            optimum->why = "not enough seeds in common: two are needed";
    }
    optimum->auto_inside = optimum->p_l_auto >= optimum->lo &&
                           optimum->p_l_auto <= optimum->hi;
    analysis_panel_deinit(&panel);
}

void analysis_optimum_deinit(struct analysis_optimum *optimum)
{
    mem_free(optimum->values);
    *optimum = (struct analysis_optimum){0};
}
