#include "analysis/analysis_drift.h"

#include "base/mem.h"
#include "chain/plarge.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>

static const char *const names[ANALYSIS_DRIFTS] = {"eta_s", "eta_l", "eta_0", "r", "p_l"};

/* The rule's p_l for these figures, without its interval. */
static double rule(double eta_s, double eta_l, double eta_0)
{
    struct statistics s = {
        .eta_s = eta_s, .eta_l = eta_l, .eta_0 = eta_0, .r = eta_l / eta_0};
    bool known = isfinite(eta_s) && isfinite(eta_l) && isfinite(eta_0);
    return known ? plarge_zsolnai2013(&s).p_l : (double)NAN;
}

/* suffix: "" for the start, "_run" for the whole. A figure whose standard error is not
 * finite was not measured, for example eta_s in a run of large steps alone. */
static double figure(const struct results *results, const struct results_run *run,
                     const char *name, const char *suffix)
{
    char *column = text_format("%s%s", name, suffix);
    char *error = text_format("%s%s_se", name, suffix);
    double value = results_number(results, run, column);
    bool measured = csv_column(results->runs, error) < 0 ||
                    isfinite(results_number(results, run, error));
    mem_free(column);
    mem_free(error);
    return measured ? value : (double)NAN;
}

static double figure_or_rule(const struct results *results, const struct results_run *run,
                             const char *name, const char *suffix)
{
    if (!text_equal(name, "p_l"))
        return figure(results, run, name, suffix);
    return rule(figure(results, run, "eta_s", suffix),
                figure(results, run, "eta_l", suffix),
                figure(results, run, "eta_0", suffix));
}

static double test_p(const double *x, size_t n)
{
    struct welford w = {0};
    for (size_t i = 0; i < n; i++)
        welford_add(&w, x[i]);
    double se = welford_se(&w);
    if (n < 2)
        return (double)NAN;
    if (!(se > 0.0))
        return w.mean == 0.0 ? 1.0 : 0.0;
    return 2.0 * student_tail(fabs(w.mean) / se, (double)n - 1.0);
}

static struct analysis_drift drift_of(const struct results *results,
                                      const struct results_cell *cell, const char *name)
{
    struct analysis_drift drift = {.name = name};
    double *start = mem_alloc(cell->run_count, sizeof *start);
    double *whole = mem_alloc(cell->run_count, sizeof *whole);
    double *difference = mem_alloc(cell->run_count, sizeof *difference);
    for (size_t i = 0; i < cell->run_count; i++) {
        double a = figure_or_rule(results, &cell->runs[i], name, "");
        double b = figure_or_rule(results, &cell->runs[i], name, "_run");
        if (!isfinite(a) || !isfinite(b))
            continue;
        start[drift.seeds] = a;
        whole[drift.seeds] = b;
        difference[drift.seeds++] = b - a;
    }
    drift.start = interval_mean(start, drift.seeds);
    drift.whole = interval_mean(whole, drift.seeds);
    drift.difference = interval_mean(difference, drift.seeds);
    drift.p = test_p(difference, drift.seeds);
    mem_free(start);
    mem_free(whole);
    mem_free(difference);
    return drift;
}

bool analysis_drift(const struct results *results, const struct results_cell *cell,
                    struct analysis_drift drifts[ANALYSIS_DRIFTS])
{
    for (int i = 0; i < ANALYSIS_DRIFTS; i++)
        drifts[i] = drift_of(results, cell, names[i]);
    return cell->has_chains;
}
