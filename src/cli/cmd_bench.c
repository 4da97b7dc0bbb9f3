/* etalon bench: the jobs of an experiment, listed or run. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "lab/forecast.h"
#include "lab/runner.h"

#include <math.h>
#include <stdio.h>

#define INTERRUPTED 130 /* as a shell says it of SIGINT */

struct bench {
    struct experiment *experiment;
    struct jobs jobs;
    char *folder;
    const char *references, *only;
    bool terminal;
};

static bool open_bench(struct bench *b, const struct args *args, struct err *err)
{
    const char *out = args_value(args, "output");
    const char *references = args_value(args, "references");
    b->only = args_value(args, "only");
    b->references = references ? references : "results/references";
    b->terminal = progress_wanted();
    b->experiment = experiment_load(args->operands[0], err);
    if (b->experiment == NULL)
        return false;
    b->folder = out ? text_copy(out) : text_format("results/%s", b->experiment->name);
    return jobs_make(b->experiment, &b->jobs, err);
}

static void close_bench(struct bench *b)
{
    jobs_deinit(&b->jobs);
    experiment_destroy(b->experiment);
    mem_free(b->folder);
}

/* "1:02:03", "2:03", or "4.5 s"; to be freed. */
static char *duration(double seconds)
{
    long s = lround(seconds);
    if (seconds < 60.0)
        return text_format("%.1f s", seconds);
    if (s < 3600)
        return text_format("%ld:%02ld min", s / 60, s % 60);
    return text_format("%ld:%02ld:%02ld h", s / 3600, s / 60 % 60, s % 60);
}

/* --- the list -------------------------------------------------------------------- */

struct totals {
    size_t jobs, done, unknown;
    double seconds; /* of what is to do, as far as it can be told */
};

static void list_job(const struct job *job, const struct csv *runs, struct totals *totals)
{
    bool done = runs && store_has_job(runs, job->id);
    double seconds = done ? forecast_spent(job, runs) : forecast_seconds(job, runs);
    char *time = isnan(seconds) ? text_copy("?") : duration(seconds);
    printf("%s  %-4s  %12s  %s\n", job->id, done ? "done" : "todo", time, job->name);
    mem_free(time);
    totals->jobs++;
    totals->done += done;
    totals->unknown += !done && isnan(seconds);
    totals->seconds += done || isnan(seconds) ? 0.0 : seconds;
}

static void print_totals(const struct totals *totals)
{
    char *time = duration(totals->seconds);
    printf("%zu jobs, %zu done; to do: %s", totals->jobs, totals->done, time);
    if (totals->unknown > 0)
        printf(" and %zu of unknown length", totals->unknown);
    printf(" (rendering alone, without references)\n");
    mem_free(time);
}

static bool list(const struct bench *b, struct err *err)
{
    struct totals totals = {0};
    struct csv *runs = store_read_runs(b->folder, err);
    if (runs == NULL && err->code != ERR_NONE)
        return false;
    for (size_t i = 0; i < b->jobs.count; i++)
        if (b->only == NULL || job_matches(&b->jobs.items[i], b->only))
            list_job(&b->jobs.items[i], runs, &totals);
    csv_destroy(runs);
    print_totals(&totals);
    return true;
}

/* --- the run --------------------------------------------------------------------- */

static void on_log(void *ctx, const struct log *log)
{
    (void)ctx;
    log_print(log, stderr);
}

static void on_progress(void *ctx, const struct run_progress *progress)
{
    (void)ctx;
    progress_show(progress);
}

static void on_half(void *ctx, const char *folder, int half)
{
    const struct bench *b = ctx;
    if (b->terminal)
        progress_clear();
    printf("reference, half %d of 2: %s\n", half + 1, folder);
    fflush(stdout);
}

static void on_job(void *ctx, const struct runner_report *report)
{
    const struct bench *b = ctx;
    char *time = duration(report->result->seconds_total);
    if (b->terminal)
        progress_clear();
    printf("[%zu/%zu] %s: %s", report->number, report->of, report->job->name, time);
    if (report->metric)
        printf(", relmse %.4g", report->metric->relmse);
    if (!(report->result->statistics.b > 0.0))
        printf(", black: no light-carrying path found");
    printf("\n");
    fflush(stdout); /* a pipe is told at once too */
    mem_free(time);
}

static int run_batch(struct bench *b, struct err *err)
{
    struct runner_summary summary;
    struct runner_options options = {
        .experiment = b->experiment,
        .jobs = &b->jobs,
        .folder = b->folder,
        .references = b->references,
        .only = b->only,
        .stop = interrupt_install(),
        .on_log = on_log,
        .on_half = on_half,
        .on_progress = b->terminal ? on_progress : NULL,
        .on_job = on_job,
        .hook_ctx = b,
    };
    bool ok = runner_run(&options, &summary, err);
    if (b->terminal)
        progress_clear();
    if (!ok)
        return fail(err);
    size_t done = summary.done_before + summary.done_now;
    printf("%zu of %zu jobs done, %zu of them now: %s/runs.csv\n", done, summary.jobs,
           summary.done_now, b->folder);
    if (!summary.interrupted)
        return 0;
    fflush(stdout);
    fprintf(stderr, "interrupted: the running job was abandoned; the same command goes "
                    "on from there\n");
    return INTERRUPTED;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct bench b = {0};
    bool listing = args_value(args, "list") != NULL;
    bool ok = open_bench(&b, args, &err) && (!listing || list(&b, &err));
    int status = !ok ? fail(&err) : listing ? 0 : run_batch(&b, &err);
    close_bench(&b);
    return status;
}

static const struct arg_option own[] = {
    {"output", 'o', "DIR", NULL, "folder of the results (default results/<experiment>)"},
    {"list", 0, NULL, NULL,
     "prints the jobs: id, whether it is done, time it took or is expected to, name"},
    {"only", 0, "PATTERN", NULL,
     "jobs with this in their name, or whose name matches it as a shell pattern"},
    {"references", 0, "DIR", NULL,
     "folder of rendered references, kept and used again (default results/references)"},
    {0},
};

const struct command command_bench = {
    .name = "bench",
    .summary = "runs a batch of renders from an experiment file, resumable",
    .operands = "EXPERIMENT.yaml [options]",
    .operand_count = 1,
    .groups = {own},
    .lists_settings = true,
    .notes =
        "An experiment file, every key:\n"
        "  experiment: NAME        of the results' folder\n"
        "  description: TEXT       for people\n"
        "  scenes: [FILE, {scene: FILE, label: NAME, reference: ..., SETTING: ...}]\n"
        "  integrators: [NAME, {integrator: NAME, label: NAME, SETTING: ...}]\n"
        "  seeds: N                is 1..N; or a list\n"
        "  budget: {seconds: S}    or {mutations_per_pixel: N}, or a list of these\n"
        "  reference: FILE.exr     or none, or {integrator: bdpt, seconds: S}: rendered\n"
        "                          once, in two halves\n"
        "  SETTING: VALUE          any of the settings above\n"
        "Values may be lists; the jobs are the product of all. What is said nearer to a\n"
        "job counts: in the scene file, for all, under scenes, under integrators. File\n"
        "names are relative to the experiment file.\n"
        "\n"
        "SIGINT (Ctrl-C) or SIGTERM abandons the running job and ends with status 130.\n"
        "The same command goes on where the last one ended, however that was.",
    .run = run,
};
