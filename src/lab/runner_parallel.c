#include "lab/runner_parallel.h"

#include "base/clock.h"
#include "base/mem.h"
#include "lab/worker_pool.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

struct dispatcher {
    struct batch *batch;
    struct worker_pool *pool;
    bool references; /* tasks are references, else jobs */
    bool halted;     /* after a failure or a stop: no more tasks are given out */
    bool stop_sent;  /* workers were told to stop */
    struct err *err;
    double begin;
    struct run_progress *progress; /* by job, of running jobs */
    double paths;                  /* of finished jobs */
    size_t done;
};

static const struct job *job_of(const struct dispatcher *d, size_t index)
{
    return &d->batch->options->jobs->items[index];
}

static bool is_task(const struct dispatcher *d, size_t job)
{
    return d->references ? d->batch->missing[job] : d->batch->states[job] == JOB_TODO;
}

static void dispatch_tasks(struct dispatcher *d)
{
    const struct jobs *jobs = d->batch->options->jobs;
    for (size_t i = 0; !d->halted && worker_pool_is_idle(d->pool) && i < jobs->count;
         i++) {
        if (!is_task(d, i))
            continue;
        if (!worker_pool_give(d->pool, i, d->references, d->err)) {
            d->halted = true;
            return;
        }
        if (d->references)
            d->batch->missing[i] = false;
        else
            d->batch->states[i] = JOB_RUNNING;
    }
}

/* Shows the progress of all jobs together: the share of the jobs to run, and the total
 * work. */
static void show_progress(struct dispatcher *d, const struct worker_event *event)
{
    const struct runner_options *o = d->batch->options;
    struct run_progress sum = {.paths = d->paths,
                               .wall_s = clock_wall() - d->begin,
                               .acceptance = (double)NAN,
                               .p_large = (double)NAN};
    double share = (double)d->done;
    d->progress[event->job] = event->progress;
    for (size_t i = 0; i < o->jobs->count; i++) {
        share += d->progress[i].share;
        sum.paths += d->progress[i].paths;
        sum.cpu_s += d->progress[i].cpu_s;
    }
    sum.share = d->references ? event->progress.share : share / (double)d->batch->to_do;
    if (o->on_progress)
        o->on_progress(o->hook_ctx, &sum);
}

static void finish(struct dispatcher *d, const struct worker_event *event)
{
    if (d->references)
        return;
    d->batch->states[event->job] = JOB_IN_PART;
    d->paths += event->outcome.paths;
    d->done++;
    batch_report(d->batch, event->job, &event->outcome, false);
}

static void fail(struct dispatcher *d, const struct err *cause)
{
    if (d->err->code == ERR_NONE)
        *d->err = *cause;
    d->halted = true;
}

static void report_death(struct dispatcher *d, const struct worker_event *event)
{
    const struct runner_options *o = d->batch->options;
    int status = event->wait_status;
    char how[64];
    if (WIFSIGNALED(status))
        snprintf(how, sizeof how, "%s", strsignal(WTERMSIG(status)));
    else
        snprintf(how, sizeof how, "exit status %d", WEXITSTATUS(status));
    if (d->references) {
        struct err err = {0};
        err_set(&err, ERR_IO, &job_of(d, event->job)->reference->at,
                "the process that made this reference died (%s)", how);
        fail(d, &err);
        return;
    }
    d->batch->states[event->job] = JOB_LOST;
    d->batch->summary->lost++;
    if (o->on_death)
        o->on_death(o->hook_ctx, job_of(d, event->job), how);
}

static void handle(struct dispatcher *d, const struct worker_event *event)
{
    const struct runner_options *o = d->batch->options;
    if (event->kind == WORKER_PROGRESS)
        show_progress(d, event);
    else if (event->kind == WORKER_REFERENCE_HALF && o->on_half)
        o->on_half(o->hook_ctx, event->folder, event->half);
    if (event->kind < WORKER_DONE)
        return;
    d->progress[event->job] = (struct run_progress){0};
    if (!d->references)
        d->batch->states[event->job] = JOB_TODO; /* replaced below if it succeeded */
    if (event->kind == WORKER_DONE)
        finish(d, event);
    else if (event->kind == WORKER_DIED)
        report_death(d, event);
    else if (event->kind == WORKER_FAILED)
        fail(d, &event->err);
    else
        d->halted = true;
}

static void pass_on_stop(struct dispatcher *d)
{
    if (!batch_stopped(d->batch) || d->stop_sent)
        return;
    d->halted = d->stop_sent = true;
    worker_pool_stop(d->pool);
}

static void join_finished(struct dispatcher *d)
{
    struct err err = {0};
    if (!d->references && !batch_join_parts(d->batch, &err))
        fail(d, &err);
}

/* Gives out tasks and handles events until no task is left; after a failure, until the
 * running tasks have ended. */
static bool run_pool(struct batch *batch, int workers, bool references, struct err *err)
{
    struct job_context_options context = batch_context_options(batch);
    context.shared = workers > 1;
    struct dispatcher d = {
        .batch = batch,
        .pool = worker_pool_create(batch->options->jobs, &context, workers, err),
        .references = references,
        .err = err,
        .done = batch->summary->done_now,
        .begin = clock_wall()};
    if (d.pool == NULL)
        return false;
    d.progress = mem_alloc(batch->options->jobs->count, sizeof *d.progress);
    join_finished(&d);
    pass_on_stop(&d);
    dispatch_tasks(&d);
    while (worker_pool_is_busy(d.pool)) {
        struct worker_event event;
        worker_pool_wait(d.pool, &event);
        handle(&d, &event);
        join_finished(&d);
        pass_on_stop(&d);
        dispatch_tasks(&d);
    }
    worker_pool_destroy(d.pool);
    mem_free(d.progress);
    return !d.halted;
}

/* Makes references first, one at a time on all threads; otherwise all workers would wait
 * for the one that makes theirs. */
static bool make_references(struct batch *batch, struct err *err)
{
    for (size_t i = 0; i < batch->options->jobs->count; i++)
        if (batch->missing[i])
            return run_pool(batch, 1, true, err);
    return true;
}

bool runner_parallel(struct batch *batch, struct err *err)
{
    batch_report_parts(batch);
    return make_references(batch, err) &&
           run_pool(batch, batch->options->workers, false, err);
}
