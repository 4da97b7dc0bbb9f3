#include "cli/bench_tell.h"

#include "base/mem.h"
#include "cli/bench_list.h"
#include "cli/progress.h"

#include <math.h>
#include <stdio.h>

static void clear(const bool *terminal)
{
    if (*terminal)
        progress_clear();
}

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
    clear(ctx);
    printf("reference, half %d of 2: %s\n", half + 1, folder);
    fflush(stdout);
}

static void on_reference(void *ctx, const struct job *job,
                         const struct reference *reference)
{
    clear(ctx);
    printf("reference of %s: %s, its own noise is a relmse of %.3g\n", job->scene->label,
           reference->path, reference->noise.relmse);
    fflush(stdout);
}

static void on_job(void *ctx, const struct runner_report *report)
{
    const struct outcome *outcome = report->outcome;
    char *time = bench_duration(outcome->seconds);
    clear(ctx);
    printf("[%zu/%zu] %s: %s", report->number, report->of, report->job->name, time);
    if (!isnan(outcome->relmse))
        printf(", relmse %.4g", outcome->relmse);
    if (!isnan(outcome->noise))
        printf(" (%.2g of it the reference's own)", outcome->noise);
    if (outcome->black)
        printf(", black: no light-carrying path found");
    printf("%s\n", report->taken ? ", from its part" : "");
    fflush(stdout); /* so that a pipe gets the line at once */
    mem_free(time);
}

static void on_death(void *ctx, const struct job *job, const char *how)
{
    clear(ctx);
    fflush(stdout);
    fprintf(stderr,
            "etalon: error: the process of '%s' died (%s): this job has no row, the "
            "others go on\n",
            job->name, how);
}

void bench_tell(struct runner_options *options, bool *terminal)
{
    options->on_log = on_log;
    options->on_half = on_half;
    options->on_reference = on_reference;
    options->on_progress = *terminal ? on_progress : NULL;
    options->on_job = on_job;
    options->on_death = on_death;
    options->hook_ctx = terminal;
}
