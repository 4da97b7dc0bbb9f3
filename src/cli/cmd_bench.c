/* etalon bench: the jobs of an experiment, listed or run. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "lab/forecast.h"
#include "lab/parts.h"
#include "lab/runner.h"

#include <math.h>
#include <stdio.h>

#define INTERRUPTED 130 /* as a shell says it of SIGINT */
#define MAX_WORKERS 1000

struct bench {
    struct experiment *experiment;
    struct jobs jobs;
    char *folder;
    const char *references, *only;
    long job, workers; /* 0: not given */
    bool terminal;
};

/* Things that a command can do, of which one counts. */
static const char *const deeds[] = {"list", "collect", "references-only",
                                    "job",  "jobs",    NULL};

static bool read_count(const struct args *args, const char *option, long *value,
                       struct err *err)
{
    const char *text = args_value(args, option);
    if (text == NULL || (text_to_long(text, value) && *value > 0))
        return true;
    return err_set(err, ERR_USAGE, NULL,
                   "--%s: '%s' is not possible; give a whole number from 1 on", option,
                   text);
}

static bool check_args(struct bench *b, const struct args *args, struct err *err)
{
    const char *first = NULL;
    for (int i = 0; deeds[i]; i++) {
        if (args_value(args, deeds[i]) == NULL)
            continue;
        if (first)
            return err_set(err, ERR_USAGE, NULL, "--%s and --%s do not go together",
                           first, deeds[i]);
        first = deeds[i];
    }
    if (args_value(args, "job") && args_value(args, "only"))
        return err_set(err, ERR_USAGE, NULL,
                       "--job and --only do not go together: one number is one job");
    return read_count(args, "job", &b->job, err) &&
           read_count(args, "jobs", &b->workers, err);
}

static bool open_bench(struct bench *b, const struct args *args, struct err *err)
{
    const char *out = args_value(args, "output");
    const char *references = args_value(args, "references");
    b->only = args_value(args, "only");
    b->references = references ? references : "results/references";
    b->terminal = progress_wanted();
    if (!check_args(b, args, err))
        return false;
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
    size_t jobs, done, parts, unknown;
    double seconds; /* of what is to do, as far as it can be told */
};

static void list_job(const struct bench *b, size_t index, const struct csv *runs,
                     struct totals *totals)
{
    const struct job *job = &b->jobs.items[index];
    struct outcome outcome;
    bool done = runs && store_has_job(runs, job->id);
    bool part = !done && part_is_finished(b->folder, job, &outcome);
    double seconds = done   ? forecast_spent(job, runs)
                     : part ? outcome.seconds
                            : forecast_seconds(job, runs);
    char *time = isnan(seconds) ? text_copy("?") : duration(seconds);
    printf("%4zu  %s  %-4s  %12s  %s\n", index + 1, job->id,
           done   ? "done"
           : part ? "part"
                  : "todo",
           time, job->name);
    mem_free(time);
    totals->jobs++;
    totals->done += done;
    totals->parts += part;
    totals->unknown += !done && !part && isnan(seconds);
    totals->seconds += done || part || isnan(seconds) ? 0.0 : seconds;
}

/* Whether an earlier row has the same reference. */
static bool is_listed(const struct csv *runs, size_t row, int column)
{
    for (size_t i = 1; i < row; i++)
        if (text_equal(csv_cell(runs, i, column), csv_cell(runs, row, column)))
            return true;
    return false;
}

static void list_references(const struct csv *runs)
{
    int column = runs ? csv_column(runs, "reference") : -1;
    for (size_t row = 1; column >= 0 && row < runs->rows; row++) {
        const char *path = csv_cell(runs, row, column);
        double noise = csv_number(runs, row, csv_column(runs, "reference_relmse"));
        if (path[0] == '\0' || text_equal(path, ".nan") || is_listed(runs, row, column))
            continue;
        printf("reference of %s: %s, ",
               csv_cell(runs, row, csv_column(runs, "scene_label")), path);
        if (isnan(noise))
            printf("its own noise is not known\n");
        else
            printf("its own noise is a relmse of %.3g\n", noise);
    }
}

static void print_totals(const struct totals *totals)
{
    char *time = duration(totals->seconds);
    printf("%zu jobs, %zu done", totals->jobs, totals->done);
    if (totals->parts > 0)
        printf(", %zu finished in parts", totals->parts);
    printf("; to do: %s", time);
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
            list_job(b, i, runs, &totals);
    list_references(runs);
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

static void on_reference(void *ctx, const struct job *job,
                         const struct reference *reference)
{
    const struct bench *b = ctx;
    if (b->terminal)
        progress_clear();
    printf("reference of %s: %s, its own noise is a relmse of %.3g\n", job->scene->label,
           reference->path, reference->relmse);
    fflush(stdout);
}

static void on_job(void *ctx, const struct runner_report *report)
{
    const struct bench *b = ctx;
    const struct outcome *outcome = report->outcome;
    char *time = duration(outcome->seconds);
    if (b->terminal)
        progress_clear();
    printf("[%zu/%zu] %s: %s", report->number, report->of, report->job->name, time);
    if (!isnan(outcome->relmse))
        printf(", relmse %.4g", outcome->relmse);
    if (!isnan(outcome->noise))
        printf(" (%.2g of it the reference's own)", outcome->noise);
    if (outcome->black)
        printf(", black: no light-carrying path found");
    printf("%s\n", report->taken ? ", from its part" : "");
    fflush(stdout); /* a pipe is told at once too */
    mem_free(time);
}

static void on_death(void *ctx, const struct job *job, const char *how)
{
    const struct bench *b = ctx;
    if (b->terminal)
        progress_clear();
    fflush(stdout);
    fprintf(stderr,
            "etalon: error: the process of '%s' died (%s): this job has no row, the "
            "others go on\n",
            job->name, how);
}

/* The numbers of the jobs that neither have a row nor a finished part. */
static void print_open(const struct bench *b)
{
    struct err ignored = {0};
    struct csv *runs = store_read_runs(b->folder, &ignored);
    size_t count = 0;
    for (size_t i = 0; i < b->jobs.count; i++) {
        const struct job *job = &b->jobs.items[i];
        if ((b->only && !job_matches(job, b->only)) ||
            (runs && store_has_job(runs, job->id)))
            continue;
        printf("%s%zu", count++ ? " " : "not done, by their numbers: ", i + 1);
    }
    printf("%s", count ? "\n" : "");
    csv_destroy(runs);
}

static void print_summary(const struct bench *b, const struct runner_summary *summary)
{
    size_t done = summary->done_before + summary->done_now;
    if (b->job)
        printf("%zu of 1 jobs done, %zu of them now: in %s/parts; --collect joins the "
               "parts\n",
               done, summary->done_now, b->folder);
    else
        printf("%zu of %zu jobs done, %zu of them now: %s/runs.csv\n", done,
               summary->jobs, summary->done_now, b->folder);
    if (summary->waiting > 0)
        printf("%zu of them wait in %s/parts for jobs before them; --collect joins them "
               "now\n",
               summary->waiting, b->folder);
}

static bool act(const struct bench *b, const struct args *args,
                const struct runner_options *options, struct runner_summary *summary,
                struct err *err)
{
    if (b->job)
        return runner_run_one(options, (size_t)b->job, summary, err);
    if (args_value(args, "collect"))
        return runner_collect(options, summary, err);
    if (args_value(args, "references-only"))
        return runner_references(options, summary, err);
    return runner_run(options, summary, err);
}

static int conclude(const struct bench *b, const struct args *args,
                    const struct runner_summary *summary)
{
    if (args_value(args, "references-only"))
        printf("%zu references made, all are in %s\n", summary->references,
               b->references);
    else
        print_summary(b, summary);
    if (args_value(args, "collect"))
        print_open(b);
    fflush(stdout);
    if (summary->interrupted) {
        fprintf(stderr, "interrupted: the running job was abandoned; the same command "
                        "goes on from there\n");
        return INTERRUPTED;
    }
    return summary->lost > 0 ? 1 : 0;
}

static int run_batch(struct bench *b, const struct args *args, struct err *err)
{
    struct runner_summary summary = {0};
    struct runner_options options = {
        .experiment = b->experiment,
        .jobs = &b->jobs,
        .folder = b->folder,
        .references = b->references,
        .only = b->only,
        .workers = (int)(b->workers < MAX_WORKERS ? b->workers : MAX_WORKERS),
        .force = args_value(args, "force") != NULL,
        .cold = args_value(args, "cold") != NULL,
        .stop = interrupt_install(),
        .on_log = on_log,
        .on_half = on_half,
        .on_reference = on_reference,
        .on_progress = b->terminal ? on_progress : NULL,
        .on_job = on_job,
        .on_death = on_death,
        .hook_ctx = b,
    };
    bool ok = act(b, args, &options, &summary, err);
    if (b->terminal)
        progress_clear();
    return ok ? conclude(b, args, &summary) : fail(err);
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct bench b = {0};
    bool listing = args_value(args, "list") != NULL;
    bool ok = open_bench(&b, args, &err) && (!listing || list(&b, &err));
    int status = !ok ? fail(&err) : listing ? 0 : run_batch(&b, args, &err);
    close_bench(&b);
    return status;
}

static const struct arg_option own[] = {
    {"output", 'o', "DIR", NULL, "folder of the results (default results/<experiment>)"},
    {"list", 0, NULL, NULL,
     "prints the jobs: number, id, whether it is done, time it took or is expected to, "
     "name; and the references' own noise"},
    {"jobs", 'j', "N", NULL, "so many at once, in processes that share the threads"},
    {"job", 0, "K", NULL,
     "job K of the list alone, into a part of the results: for job arrays, see below"},
    {"collect", 0, NULL, NULL, "joins the parts that are finished, and runs nothing"},
    {"references-only", 0, NULL, NULL, "makes the references, and runs nothing"},
    {"force", 0, NULL, NULL,
     "takes references of the method under test, of a job's seed or of another depth"},
    {"cold", 0, NULL, NULL,
     "no warm-up before the first job on a scene whose budget is a time"},
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
        "--job K can run any number of times side by side, on any machines that see the\n"
        "folder; the references are best made before:\n"
        "  etalon bench E.yaml --references-only\n"
        "  parallel etalon bench E.yaml --job {} ::: $(seq 96)\n"
        "  etalon bench E.yaml --collect\n"
        "\n"
        "SIGINT (Ctrl-C) or SIGTERM abandons the running job and ends with status 130.\n"
        "The same command goes on where the last one ended, however that was.",
    .run = run,
};
