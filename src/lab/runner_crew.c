#include "lab/runner_crew.h"

#include "base/clock.h"
#include "base/mem.h"
#include "lab/crew.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

struct foreman {
    struct batch *batch;
    struct crew *crew;
    bool references; /* the task is to make references, else to run jobs */
    bool halted;     /* something failed, or it was stopped: nothing more is given out */
    bool told;       /* workers know that it was stopped */
    struct err *err;
    double begin;
    struct run_progress *progress; /* by job, of those that run */
    double paths;                  /* of those that are done */
    size_t done;
};

static const struct job *job_of(const struct foreman *f, size_t index)
{
    return &f->batch->options->jobs->items[index];
}

static bool is_task(const struct foreman *f, size_t job)
{
    return f->references ? f->batch->missing[job] : f->batch->states[job] == JOB_TODO;
}

static void give_out(struct foreman *f)
{
    const struct jobs *jobs = f->batch->options->jobs;
    for (size_t i = 0; !f->halted && crew_is_idle(f->crew) && i < jobs->count; i++) {
        if (!is_task(f, i))
            continue;
        if (!crew_give(f->crew, i, f->references, f->err)) {
            f->halted = true;
            return;
        }
        if (f->references)
            f->batch->missing[i] = false;
        else
            f->batch->states[i] = JOB_RUNNING;
    }
}

/* All jobs as one: the share of those that are to run, and the work of all. */
static void show_progress(struct foreman *f, const struct crew_event *event)
{
    const struct runner_options *o = f->batch->options;
    struct run_progress sum = {.paths = f->paths,
                               .wall_s = clock_wall() - f->begin,
                               .acceptance = (double)NAN,
                               .p_large = (double)NAN};
    double share = (double)f->done;
    f->progress[event->job] = event->progress;
    for (size_t i = 0; i < o->jobs->count; i++) {
        share += f->progress[i].share;
        sum.paths += f->progress[i].paths;
        sum.cpu_s += f->progress[i].cpu_s;
    }
    sum.share = f->references ? event->progress.share : share / (double)f->batch->to_do;
    if (o->on_progress)
        o->on_progress(o->hook_ctx, &sum);
}

static void finish(struct foreman *f, const struct crew_event *event)
{
    if (f->references)
        return;
    f->batch->states[event->job] = JOB_PART;
    f->paths += event->outcome.paths;
    f->done++;
    batch_report(f->batch, event->job, &event->outcome, false);
}

static void fail(struct foreman *f, const struct err *cause)
{
    if (f->err->code == ERR_NONE)
        *f->err = *cause;
    f->halted = true;
}

static void bury(struct foreman *f, const struct crew_event *event)
{
    const struct runner_options *o = f->batch->options;
    int status = event->wait_status;
    char how[64];
    if (WIFSIGNALED(status))
        snprintf(how, sizeof how, "%s", strsignal(WTERMSIG(status)));
    else
        snprintf(how, sizeof how, "exit status %d", WEXITSTATUS(status));
    if (f->references) {
        struct err err = {0};
        err_set(&err, ERR_IO, &job_of(f, event->job)->reference->at,
                "the process that made this reference died (%s)", how);
        fail(f, &err);
        return;
    }
    f->batch->states[event->job] = JOB_LOST;
    f->batch->summary->lost++;
    if (o->on_death)
        o->on_death(o->hook_ctx, job_of(f, event->job), how);
}

static void handle(struct foreman *f, const struct crew_event *event)
{
    const struct runner_options *o = f->batch->options;
    if (event->kind == CREW_PROGRESS)
        show_progress(f, event);
    else if (event->kind == CREW_HALF && o->on_half)
        o->on_half(o->hook_ctx, event->folder, event->half);
    if (event->kind < CREW_DONE)
        return;
    f->progress[event->job] = (struct run_progress){0};
    if (!f->references)
        f->batch->states[event->job] = JOB_TODO; /* unless it went well */
    if (event->kind == CREW_DONE)
        finish(f, event);
    else if (event->kind == CREW_DIED)
        bury(f, event);
    else if (event->kind == CREW_FAILED)
        fail(f, &event->err);
    else
        f->halted = true;
}

static void heed_stop(struct foreman *f)
{
    if (!batch_stopped(f->batch) || f->told)
        return;
    f->halted = f->told = true;
    crew_stop(f->crew);
}

static void settle(struct foreman *f)
{
    struct err err = {0};
    if (!f->references && !batch_settle(f->batch, &err))
        fail(f, &err);
}

/* Gives out tasks and takes results until there are none, or until something fails: then
 * until those that run are through. */
static bool drive(struct batch *batch, int workers, bool references, struct err *err)
{
    struct stage_options stage = batch_stage(batch);
    stage.shared = workers > 1;
    struct foreman f = {.batch = batch,
                        .crew = crew_create(batch->options->jobs, &stage, workers, err),
                        .references = references,
                        .err = err,
                        .done = batch->summary->done_now,
                        .begin = clock_wall()};
    if (f.crew == NULL)
        return false;
    f.progress = mem_alloc(batch->options->jobs->count, sizeof *f.progress);
    settle(&f);
    heed_stop(&f);
    give_out(&f);
    while (crew_is_busy(f.crew)) {
        struct crew_event event;
        crew_wait(f.crew, &event);
        handle(&f, &event);
        settle(&f);
        heed_stop(&f);
        give_out(&f);
    }
    crew_destroy(f.crew);
    mem_free(f.progress);
    return !f.halted;
}

/* References first, one at a time with all threads: else all workers would wait for the
 * one that makes theirs. */
static bool make_references(struct batch *batch, struct err *err)
{
    for (size_t i = 0; i < batch->options->jobs->count; i++)
        if (batch->missing[i])
            return drive(batch, 1, true, err);
    return true;
}

bool runner_crew(struct batch *batch, struct err *err)
{
    batch_report_parts(batch);
    return make_references(batch, err) &&
           drive(batch, batch->options->workers, false, err);
}
