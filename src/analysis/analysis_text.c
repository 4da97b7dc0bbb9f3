#include "analysis/analysis_text.h"

#include "base/mem.h"
#include "analysis/analysis_curve.h"
#include "analysis/analysis_drift.h"
#include "analysis/analysis_optimum.h"
#include "analysis/analysis_regret.h"
#include "analysis/analysis_slope.h"
#include "analysis/analysis_spectrum.h"
#include "analysis/analysis_speedup.h"
#include "analysis/analysis_split.h"
#include "analysis/analysis_words.h"

#include <math.h>
#include <string.h>

#define CELL_WIDTH  36 /* columns of an interval */
#define MOST_ERRORS 3  /* errors of a table: trimmed, full, the one that was asked for */

struct printer {
    FILE *out;
    const struct results *results;
    const struct analysis_text_options *options;
    const struct families *families;
    const struct results_cell *first; /* of the scene and budget that is printed */
    int label_width;
};

static bool in_group(const struct printer *p, const struct results_cell *cell)
{
    return results_same_budget(cell, p->first);
}

/* --- figures --------------------------------------------------------------------- */

static void print_padded(FILE *out, const char *text)
{
    fprintf(out, "  %-*s", CELL_WIDTH, text);
}

static void print_interval(FILE *out, const struct interval *interval,
                           const char *missing)
{
    char text[96];
    if (interval_is_known(interval))
        snprintf(text, sizeof text, "%.4g [%.4g, %.4g]", interval->value, interval->lo,
                 interval->hi);
    else if (isfinite(interval->value))
        snprintf(text, sizeof text, "%.4g [one seed]", interval->value);
    else
        snprintf(text, sizeof text, "%s", missing);
    print_padded(out, text);
}

static void print_label(const struct printer *p, const char *label)
{
    fprintf(p->out, "  %-*s", p->label_width, label);
}

/* --- cells ----------------------------------------------------------------------- */

/* Trimmed and full relMSE, and the error that was asked for if it is neither. */
static int errors_shown(const struct printer *p, enum results_error errors[MOST_ERRORS])
{
    errors[0] = RESULTS_RELMSE_TRIMMED;
    errors[1] = RESULTS_RELMSE;
    errors[2] = p->options->error;
    return errors[2] == errors[0] || errors[2] == errors[1] ? 2 : 3;
}

static void print_error(const struct printer *p, const struct results_cell *cell)
{
    enum results_error errors[MOST_ERRORS], error = p->options->error;
    int count = errors_shown(p, errors);
    struct analysis_slope slope = analysis_slope(cell, p->options->axis, error);
    print_label(p, cell->label);
    fprintf(p->out, " %5zu", cell->run_count);
    for (int e = 0; e < count; e++) {
        struct analysis_point point = analysis_final(cell, errors[e]);
        print_interval(p->out, &point.raw, "no reference");
        if (p->first->noise[errors[e]] > 0.0)
            print_interval(p->out, &point.corrected, "not above the reference's noise");
    }
    print_interval(p->out, cell->noise[error] > 0.0 ? &slope.corrected : &slope.raw,
                   slope.seeds ? "not above the reference's noise" : "too few snapshots");
    fprintf(p->out, "%s\n", cell->is_biased ? " (biased method)" : "");
}

static void print_noise(const struct printer *p, const enum results_error *errors,
                        int count)
{
    fprintf(p->out, "Noise of the reference:");
    for (int e = 0; e < count; e++) {
        fprintf(p->out, "%s %s ", e ? "," : "", results_error_name(errors[e]));
        if (p->first->noise_is_known[errors[e]])
            fprintf(p->out, "%.4g", p->first->noise[errors[e]]);
        else
            fprintf(p->out, "unknown (nothing is subtracted)");
    }
    fprintf(p->out, "\n");
}

static void print_errors(const struct printer *p)
{
    enum results_error errors[MOST_ERRORS];
    int count = errors_shown(p, errors);
    print_noise(p, errors, count);
    print_label(p, "");
    fprintf(p->out, " seeds");
    for (int e = 0; e < count; e++) {
        print_padded(p->out, results_error_name(errors[e]));
        if (p->first->noise[errors[e]] > 0.0)
            print_padded(p->out, "less the reference's noise");
    }
    print_padded(p->out, "slope (ideal -1)");
    fprintf(p->out, "\n");
    for (size_t i = 0; i < p->results->cell_count; i++)
        if (in_group(p, &p->results->cells[i]))
            print_error(p, &p->results->cells[i]);
}

static void print_speedup(const struct printer *p, const struct results_cell *cell,
                          const struct results_cell *over)
{
    struct analysis_speedup s = analysis_speedup(cell, over, p->options->axis,
                                                 p->options->error);
    print_interval(p->out, &s.ratio, "no common curve");
    if (isfinite(s.error)) {
        fprintf(p->out, " at %s %.4g%s%s", results_error_name(p->options->error), s.error,
                s.at_least ? " (there before its curve begins: a bound)" : "",
                s.resolved ? "" : " (not above the reference's noise)");
        fprintf(p->out, ", %zu seeds%s", s.seeds, s.paired ? ", paired" : "");
    }
    fprintf(p->out, "\n");
}

static void print_speedups(const struct printer *p)
{
    bool any = false;
    for (size_t i = 0; i < p->results->cell_count; i++) {
        const struct results_cell *cell = &p->results->cells[i];
        if (!in_group(p, cell) || cell == p->first)
            continue;
        if (!any)
            fprintf(p->out, "\nSpeed-up over '%s' at equal error\n", p->first->label);
        any = true;
        print_label(p, cell->label);
        print_speedup(p, cell, p->first);
    }
}

static void print_split(const struct printer *p, const struct results_cell *cell)
{
    struct analysis_split s;
    struct err err = {0};
    print_label(p, cell->label);
    if (!analysis_split_cell(p->results, cell, NULL, &s, &err)) {
        fprintf(p->out, "  %s\n", err.message);
        return;
    }
    fprintf(p->out, "  variance %.4g +- %.2g, bias^2 %.3g +- %.2g", s.variance,
            s.variance_se, s.bias2, s.bias2_se);
    if (s.errors_from_blocks)
        fprintf(p->out, " (2 seeds: errors from blocks of pixels, no test)");
    else if (s.bias_is_significant)
        fprintf(p->out, ": %.1f %% of the error",
                100.0 * s.bias2 / (s.bias2 + s.variance));
    else if (isfinite(s.bias2_hi))
        fprintf(p->out, " (not above 0; below %.2g)", fmax(s.bias2_hi, 0.0));
    fprintf(p->out, "%s", s.noise_is_known ? "" : "; with the reference's noise in it");
    if (s.nonfinite > 0)
        fprintf(p->out, "; %ld pixels that are not finite left out", s.nonfinite);
    fprintf(p->out, "\n");
}

static void print_splits(const struct printer *p)
{
    fprintf(p->out, "\nError of a run as variance and bias^2, from the pictures; "
                    "weighted as relMSE, but by "
                    "a pixel's neighbours\n");
    for (size_t i = 0; i < p->results->cell_count; i++)
        if (in_group(p, &p->results->cells[i]))
            print_split(p, &p->results->cells[i]);
}

static void print_spectrum(const struct printer *p, const struct results_cell *cell)
{
    struct analysis_spectrum s;
    struct err err = {0};
    print_label(p, cell->label);
    if (!analysis_spectrum_cell(p->results, cell, &s, &err)) {
        fprintf(p->out, "  %s\n", err.message);
        return;
    }
    fprintf(p->out, "  low/high %.3g;", s.low_over_high);
    for (int b = 0; b < s.mean.count; b++)
        fprintf(p->out, " %.3g: %.3g", s.mean.frequency[b], s.mean.power[b] * s.cost);
    fprintf(p->out, "\n");
}

static void print_spectra(const struct printer *p)
{
    fprintf(
        p->out,
        "\nError spectra: power of a run's relative error times its CPU seconds, by "
        "cycles per pixel (flat: independent pixels); low/high: below 1/16 over above "
        "1/4\n");
    for (size_t i = 0; i < p->results->cell_count; i++)
        if (in_group(p, &p->results->cells[i]))
            print_spectrum(p, &p->results->cells[i]);
}

static void print_drift(const struct printer *p, const struct results_cell *cell)
{
    struct analysis_drift drifts[ANALYSIS_DRIFTS];
    bool any = false;
    if (!analysis_drift(p->results, cell, drifts))
        return;
    print_label(p, cell->label);
    for (int i = 0; i < ANALYSIS_DRIFTS; i++) {
        if (drifts[i].seeds == 0)
            continue;
        fprintf(p->out, "%s %s %.4g -> %.4g (p %.2g)", any ? "," : " ", drifts[i].name,
                drifts[i].start.value, drifts[i].whole.value, drifts[i].p);
        any = true;
    }
    fprintf(p->out, any ? "\n" : "  not measured\n");
}

static void print_drifts(const struct printer *p)
{
    fprintf(p->out,
            "\nStatistics of the start -> of the whole run (p: paired t-test over "
            "seeds); p_l is what the rule says\n");
    for (size_t i = 0; i < p->results->cell_count; i++)
        if (in_group(p, &p->results->cells[i]))
            print_drift(p, &p->results->cells[i]);
}

/* --- families -------------------------------------------------------------------- */

static void print_regret(const struct printer *p, const struct family *family)
{
    struct analysis_regret r = analysis_regret(family, p->options->axis,
                                               p->options->error);
    fprintf(p->out, "    regret:      ");
    print_interval(p->out, &r.regret, r.why);
    if (isfinite(r.naive))
        fprintf(p->out,
                " best manual p_l %g; naive %.4g; at %s %.4g; %zu seeds; "
                "%zu manual values",
                r.best_p_l, r.naive, results_axis_name(p->options->axis), r.x, r.seeds,
                r.compared);
    if (r.left_out > 0)
        fprintf(p->out, ", %zu left out", r.left_out);
    fprintf(p->out, "\n");
    if (isfinite(r.log_mean.value)) {
        fprintf(p->out, "    geometric:   ");
        print_interval(p->out, &r.log_mean, "");
        fprintf(p->out, "\n");
    }
    if (r.best == NULL)
        return;
    fprintf(p->out, "    speed-up:    ");
    print_speedup(p, family->automatic, r.best);
}

static void print_optimum(const struct printer *p, const struct family *family)
{
    struct analysis_optimum o;
    analysis_optimum_make(family, p->options->axis, p->options->error, &o);
    fprintf(p->out, "    best p_l:    ");
    if (isfinite(o.lo)) {
        fprintf(p->out, "  %g to %g of", o.lo, o.hi);
        for (size_t i = 0; i < o.count; i++)
            fprintf(p->out, " %g%s", o.values[i].p_l, o.values[i].in_set ? "*" : "");
        fprintf(p->out, " (* not significantly worse than %g, 5 %%)",
                o.values[o.best].p_l);
        if (isfinite(o.p_l_auto))
            fprintf(p->out, "; automatic %.3g lies %s", o.p_l_auto,
                    o.auto_inside ? "inside" : "outside");
    } else {
        fprintf(p->out, "  %s", o.why);
    }
    fprintf(p->out, "\n");
    analysis_optimum_deinit(&o);
}

static void print_families(const struct printer *p)
{
    bool any = false;
    for (size_t i = 0; i < p->families->count; i++) {
        const struct family *f = &p->families->items[i];
        const struct results_cell *member = f->automatic ? f->automatic : f->manual[0];
        if (!in_group(p, member) || f->manual_count == 0)
            continue;
        if (!any)
            fprintf(p->out, "\nAutomatic against manual p_l\n");
        any = true;
        fprintf(p->out, "  %s\n", f->name);
        if (f->automatic)
            print_regret(p, f);
        print_optimum(p, f);
    }
}

/* --- in words -------------------------------------------------------------------- */

static void print_best(const struct printer *p, enum results_error error)
{
    struct text text = {0};
    struct analysis_ranking ranking;
    analysis_ranking_make(p->results, p->families, p->first, error, &ranking);
    analysis_append_group(&text, p->first);
    text_append(&text, ": ");
    analysis_append_best(&text, &ranking);
    fprintf(p->out, "  %s\n", text.data);
    analysis_ranking_deinit(&ranking);
    mem_free(text.data);
}

static void print_regrets(const struct printer *p, enum results_error error)
{
    struct text text = {0};
    struct analysis_summary summary;
    analysis_summary_make(p->results, p->families, p->options->axis, error, &summary);
    analysis_append_regret(&text, &summary);
    if (text.length > 0)
        fprintf(p->out, "  regret: %s\n", text.data);
    for (size_t i = 0; i < summary.count; i++) {
        const struct analysis_policy *policy = &summary.items[i];
        if (!isnan(policy->p_l) && policy->cells > 0)
            fprintf(p->out, "    %-12s %.3f of %zu, at worst %.3f (%s)\n", policy->name,
                    policy->mean, policy->cells, policy->worst, policy->worst_name);
    }
    analysis_summary_deinit(&summary);
    mem_free(text.data);
}

static bool is_first_of_group(struct printer *p, size_t cell)
{
    p->first = &p->results->cells[cell];
    for (size_t i = 0; i < cell; i++)
        if (in_group(p, &p->results->cells[i]))
            return false;
    return true;
}

static void print_words(struct printer *p)
{
    enum results_error errors[MOST_ERRORS];
    p->first = &p->results->cells[0];
    int count = errors_shown(p, errors);
    for (int e = 0; e < count; e++) {
        fprintf(p->out, "In words, by %s at the end of the runs:\n",
                analysis_error_words(errors[e]));
        for (size_t i = 0; i < p->results->cell_count; i++)
            if (is_first_of_group(p, i))
                print_best(p, errors[e]);
        print_regrets(p, errors[e]);
        fprintf(p->out, "\n");
    }
}

/* --- the whole ------------------------------------------------------------------- */

static void print_group(struct printer *p)
{
    char *budget = results_budget(p->first);
    p->label_width = 0;
    for (size_t i = 0; i < p->results->cell_count; i++) {
        int width = (int)strlen(p->results->cells[i].label);
        if (in_group(p, &p->results->cells[i]) && width > p->label_width)
            p->label_width = width;
    }
    fprintf(p->out, "=== %s, %s: %s against %s ===\n", p->first->scene, budget,
            results_error_name(p->options->error), results_axis_name(p->options->axis));
    print_errors(p);
    print_speedups(p);
    print_families(p);
    print_drifts(p);
    if (p->options->pictures)
        print_splits(p);
    if (p->options->pictures)
        print_spectra(p);
    fprintf(p->out, "\n");
    mem_free(budget);
}

void analysis_text_print(FILE *out, const struct results *results,
                         const struct analysis_text_options *options)
{
    struct families families;
    struct printer p = {
        .out = out, .results = results, .options = options, .families = &families};
    families_make(results, &families);
    if (results->superseded > 0)
        fprintf(out,
                "%zu older rows left out: later ones have the same cell and seed, or "
                "other contents (scene, settings, reference)\n",
                results->superseded);
    if (results->unreadable > 0)
        fprintf(out, "%zu rows without a job or a seed left out\n", results->unreadable);
    if (results->other_trim > 0)
        fprintf(out,
                "trimmed errors of %zu runs left out: of a program that left out another "
                "share of the pixels (today 1 %%)\n",
                results->other_trim);
    fprintf(out, "Figures in brackets are 95 %% intervals over seeds.\n\n");
    if (results->cell_count > 0)
        print_words(&p);
    for (size_t i = 0; i < results->cell_count; i++)
        if (is_first_of_group(&p, i))
            print_group(&p);
    families_deinit(&families);
}
