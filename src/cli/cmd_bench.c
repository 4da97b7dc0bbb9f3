/* etalon bench: the jobs of an experiment, listed or run. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/bench_list.h"
#include "cli/bench_tell.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "lab/parts.h"
#include "lab/runner.h"

#include <math.h>
#include <stdio.h>

#define INTERRUPTED 130 /* exit status, as shells report SIGINT */
#define MAX_WORKERS 1000

struct bench {
    struct experiment *experiment;
    struct jobs jobs;
    char *folder;
    const char *references, *only;
    long job, workers; /* 0: not given */
    bool terminal;
};

/* Options that exclude each other. */
static const char *const actions[] = {"list", "collect", "references-only",
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
    for (int i = 0; actions[i]; i++) {
        if (args_value(args, actions[i]) == NULL)
            continue;
        if (first)
            return err_set(err, ERR_USAGE, NULL, "--%s and --%s do not go together",
                           first, actions[i]);
        first = actions[i];
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

/* --- the run --------------------------------------------------------------------- */

/* Prints the numbers of the jobs that are neither in the table nor finished in a part. */
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
    };
    bench_tell(&options, &b->terminal);
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
    bool ok = open_bench(&b, args, &err) &&
              (!listing || bench_list(&b.jobs, b.folder, b.only, &err));
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
     "takes references of the method under test, of a job's seed, of another depth, or "
     "that may lack light which their integrator cannot sample"},
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
        "Values may be lists; the jobs are the product of all. Of several values of a\n"
        "setting the last in this order counts: scene file, experiment, entry of "
        "scenes,\n"
        "entry of integrators. File names are relative to the experiment file.\n"
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
