#include "cli/summary.h"

#include "path/passage.h"

#include <math.h>

#define LABEL "%-12s "

static void print_estimate(const char *label, double value, double se, FILE *out)
{
    fprintf(out, LABEL "%.6g +- %.2g\n", label, value, se);
}

static void print_run(const struct statistics_record *r, FILE *out)
{
    const struct run_statistics *s = &r->run.statistics;
    const struct settings *settings = &r->settings;
    bool modes = settings_uses(settings, "mode"),
         built = settings_uses(settings, "builder");
    fprintf(out, LABEL "%s%s%s", "integrator", settings->integrator, modes ? " " : "",
            modes ? settings_mode(settings) : "");
    if (r->biased)
        fprintf(out, " (biased: failed proposals are no states)");
    if (built)
        fprintf(out, " over %s", settings->builder);
    if (settings_uses(settings, "kernel"))
        fprintf(out, ", %s kernel", settings->kernel);
    if (r->chains)
        fprintf(out, ", estimator %s, %ld chains", settings->estimator, s->chains);
    fprintf(out, ", depth %d, %dx%d\n", r->run.max_depth, r->width, r->height);
    if (s->race.chosen[0])
        fprintf(out, LABEL "%s, %s\n", "chosen", s->race.chosen, s->race.reason);
    fprintf(out, LABEL "%.0f %s, %.4g per pixel", "paths", s->paths,
            r->chains ? "mutations" : "samples", r->run.mutations_per_pixel);
    if (r->chains)
        fprintf(out, ", after %.0f bootstrap paths", s->bootstrap_paths);
    fputc('\n', out);
    if (!isnan(s->adaptive.start))
        fprintf(out,
                LABEL "adaptive after %.0f samples per pixel, predicted %.2f times the "
                      "relMSE x time of uniform samples\n",
                "film sampling", s->adaptive.start, s->adaptive.predicted);
    print_estimate("b", s->b, s->b_se, out);
    if (r->chains && !s->b_trusted)
        fprintf(out,
                LABEL
                "its error rests on %.3g effective samples and cannot be trusted; b "
                "is probably too small\n",
                "", s->b_samples);
}

static void print_chains(const struct statistics_record *r, FILE *out)
{
    const struct run_statistics *s = &r->run.statistics;
    const struct statistics *start = &s->start;
    print_estimate("eta_s", start->eta_s, start->eta_s_se, out);
    print_estimate("eta_l", start->eta_l, start->eta_l_se, out);
    print_estimate("eta_0", start->eta_0, start->eta_0_se, out);
    fprintf(out, LABEL "%.4g (99 %%: %.4g to %.4g)\n", "r", start->r, start->r_lo,
            start->r_hi);
    fprintf(out, LABEL "%.4g (%s) %s\n", "p_l", s->plarge.p_l, r->p_l_source,
            r->p_l_reason);
    fprintf(out, LABEL "%.4f; %.4f of all proposals carry no light\n", "acceptance",
            s->acceptance, s->failure_rate);
    if (s->split.used) {
        const struct split_figures *split = &s->split;
        fprintf(out, LABEL "floor %.3g, ceiling %.3g, mean target %.3g\n", "split",
                split->floor, split->ceiling, split->b);
        fprintf(out, LABEL "%s\n", "", split->reason);
    }
    if (s->seeds_few)
        fprintf(out,
                LABEL "chains begin at few paths (effective number %.3g of %.0f): eta_s, "
                      "eta_l, r and p_l have larger errors than stated\n",
                "seeds", s->seeds_effective, s->bootstrap_paths);
    if (s->chains_never_moved > 0.0 && !s->plain_only)
        fprintf(out, LABEL "%.0f of %ld never moved; at most %.0f rejections in a row\n",
                "chains", s->chains_never_moved, r->run.statistics.chains,
                s->most_rejections_in_row);
}

/* Prints a row for every path length that has chains of its own. */
static void print_lengths(const struct run_statistics *s, FILE *out)
{
    if (s->length_count > 0)
        fprintf(out, LABEL "%6s %7s %20s %7s %7s %7s %7s %7s\n", "whole run", "edges",
                "chains", "b", "eta_s", "eta_l", "eta_0", "failed", "p_l");
    if (s->plain_lengths > 0)
        fprintf(out, LABEL "%6s %7s %14.5g +- %.2g  (%.0f plain samples)\n", "",
                s->plain_lengths > 1 ? "1, 2" : "1", "none", s->plain_b, s->plain_b_se,
                s->plain_samples);
    for (int i = 0; i < s->length_count; i++) {
        const struct length_statistics *l = &s->lengths[i];
        char b[64];
        snprintf(b, sizeof b, "%.5g +- %.2g", l->b, l->b_se);
        fprintf(out, LABEL "%6d %7d %20s %7.4f %7.4f %7.4f %7.4f %7.3f%s\n", "",
                l->length, l->chains, b, l->whole.eta_s, l->whole.eta_l, l->whole.eta_0,
                l->failure_rate, l->p_l, l->found ? "" : "  not found by the bootstrap");
    }
}

static void print_failures(const struct run_statistics *s, FILE *out)
{
    const double *f = s->counters.failures;
    if (s->length_count == 0)
        return;
    fprintf(out,
            LABEL
            "%.0f of a camera path, %.0f of a light path, %.0f blocked, %.0f zero\n",
            "failures", f[FAILURE_CAMERA_PATH], f[FAILURE_LIGHT_PATH], f[FAILURE_BLOCKED],
            f[FAILURE_ZERO]);
    if (s->counters.excluded > 0.0)
        fprintf(out, LABEL "%.0f paths, no states of any chain\n", "excluded",
                s->counters.excluded);
    if (s->counters.second_stage > 0.0)
        fprintf(out, LABEL "%.0f paths, acceptance %.4f\n", "second stage",
                s->counters.second_stage, s->second_acceptance);
    if (s->jumps > 0.0)
        fprintf(out, LABEL "%.0f, acceptance %.6f, %.0f without an inverse\n", "jumps",
                s->jumps, s->jump_acceptance, f[FAILURE_INVERSE]);
}

/* Of mutations that differ in what they cost. */
static void print_mutations(const struct run_statistics *s, FILE *out)
{
    for (int i = 0; i < s->move_count; i++) {
        const struct move_statistics *m = &s->moves[i];
        if (m->work > 0.0 && m->proposed > 0.0)
            fprintf(out,
                    LABEL
                    "%.0f proposed, acceptance %.4f; class changed %.3f, blocked %.3f; "
                    "cost %.1f, weight %.3g\n",
                    m->name, m->proposed, m->acceptance,
                    m->failures[FAILURE_CLASS] / m->proposed,
                    m->failures[FAILURE_BLOCKED] / m->proposed, m->work, m->weight);
    }
}

static void print_troubles(const struct run_statistics *s, FILE *out)
{
    if (s->nonfinite > 0.0)
        fprintf(out, LABEL "%.0f values were not finite and count as black\n",
                "non-finite", s->nonfinite);
    if (s->saturated > 0.0)
        fprintf(out, LABEL "%.0f splats were too bright for the film\n", "saturated",
                s->saturated);
    if (s->edges_cut > 0.0)
        fprintf(out,
                LABEL "%.0f edges that pass more than %d panes or masks count as black\n",
                "cut", s->edges_cut, PASSAGE_MOST);
}

/* Prints the verdict, and the error of the whole picture by its error bars. */
static void print_verdict(const struct run_result *run, FILE *out)
{
    const struct verdict *v = &run->verdict;
    const char *before = ": ";
    fprintf(out, LABEL "%s", "verdict", verdict_name(v->call));
    if (v->call == VERDICT_BLIND)
        fprintf(out, " to %s", run->blind_to);
    if (v->call >= VERDICT_BLIND) {
        fprintf(out, ": %d of %d tiles disagree", v->tiles_bad, v->tiles);
        before = "; ";
    }
    fprintf(out, "%s%s\n", v->words[0] ? before : "", v->words);
    if (v->se == NULL)
        return;
    fprintf(out, LABEL "relmse %.3g +- %.1g by %d parts of the run", "error", v->relmse,
            v->relmse_se, v->replicas);
    if (!isnan(v->rhat_max)) /* NaN: the run was too short */
        fprintf(out, "; largest R-hat %.3g", v->rhat_max);
    fputc('\n', out);
}

static void print_until(const struct statistics_record *r, FILE *out)
{
    const struct run_result *run = &r->run;
    if (!settings_until(&r->settings))
        return;
    fprintf(out, LABEL "by %s after %d look%s", "ended",
            run->end == RUN_UNTIL ? "its until condition" : run_end_name(run->end),
            run->until.looks, run->until.looks == 1 ? "" : "s");
    if (r->settings.until_relmse > 0.0 && !isnan(run->until.bound))
        fprintf(out, "; relmse at most %.3g at the last", run->until.bound);
    fputc('\n', out);
}

static void print_time(const struct statistics_record *r, FILE *out)
{
    const struct run_result *run = &r->run;
    fprintf(out, LABEL "%.2f s", "time", run->seconds_total);
    if (r->chains)
        fprintf(out, " (start %.2f s)", run->statistics.seconds_startup);
    fprintf(out, ", %.2f s CPU on %d thread%s", run->seconds_cpu, run->threads,
            run->threads == 1 ? "" : "s");
    if (run->seconds_cpu > 0.0)
        fprintf(out, ", %.4g M paths per CPU second",
                (run->statistics.paths + run->statistics.bootstrap_paths) * 1e-6 /
                    run->seconds_cpu);
    fputc('\n', out);
}

void summary_print(const struct statistics_record *r, const struct metric *metric,
                   FILE *out)
{
    print_run(r, out);
    if (r->chains)
        print_chains(r, out);
    print_lengths(&r->run.statistics, out);
    print_failures(&r->run.statistics, out);
    print_mutations(&r->run.statistics, out);
    print_troubles(&r->run.statistics, out);
    print_verdict(&r->run, out);
    print_until(r, out);
    if (metric)
        fprintf(out, LABEL "relmse %.4g (trimmed %.4g), mean ratio %.5f\n", "reference",
                metric->relmse, metric->relmse_trimmed, metric->mean_ratio);
    print_time(r, out);
}
