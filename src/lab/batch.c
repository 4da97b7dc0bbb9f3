#include "lab/batch.h"

#include "base/mem.h"
#include "lab/parts.h"

bool batch_stopped(const struct batch *batch)
{
    return batch->options->stop && *batch->options->stop;
}

struct job_context_options batch_context_options(const struct batch *batch)
{
    const struct runner_options *o = batch->options;
    return (struct job_context_options){
        .experiment = o->experiment,
        .folder = o->folder,
        .references = o->references,
        .cold = o->cold,
        .stop = o->stop,
        .on_half = o->on_half,
        .on_progress = o->on_progress,
        .hook_ctx = o->hook_ctx,
    };
}

void batch_init(struct batch *batch, const struct runner_options *options,
                struct runner_summary *summary)
{
    size_t count = options->jobs->count;
    *summary = (struct runner_summary){0};
    *batch = (struct batch){.options = options, .summary = summary};
    batch->states = mem_alloc(count, sizeof *batch->states);
    batch->missing = mem_alloc(count, sizeof *batch->missing);
}

void batch_deinit(struct batch *batch)
{
    store_close(batch->store);
    mem_free(batch->states);
    mem_free(batch->missing);
}

void batch_report(struct batch *batch, size_t job, const struct outcome *outcome,
                  bool taken)
{
    const struct runner_options *o = batch->options;
    struct runner_report report = {.number = ++batch->summary->done_now,
                                   .of = batch->to_do,
                                   .job = &o->jobs->items[job],
                                   .outcome = outcome,
                                   .taken = taken};
    if (o->on_job)
        o->on_job(o->hook_ctx, &report);
}

void batch_report_parts(struct batch *batch)
{
    const struct runner_options *o = batch->options;
    struct outcome outcome;
    for (size_t i = 0; i < o->jobs->count; i++)
        if (batch->states[i] == JOB_IN_PART &&
            part_is_finished(o->folder, &o->jobs->items[i], &outcome))
            batch_report(batch, i, &outcome, true);
}

bool batch_join_part(struct batch *batch, size_t job, struct err *err)
{
    const struct runner_options *o = batch->options;
    if (!part_join(batch->store, o->folder, &o->jobs->items[job], err))
        return false;
    batch->states[job] = JOB_JOINED;
    return true;
}

bool batch_join_parts(struct batch *batch, struct err *err)
{
    for (; batch->cursor < batch->options->jobs->count; batch->cursor++) {
        enum job_state state = batch->states[batch->cursor];
        if (state == JOB_TODO || state == JOB_RUNNING)
            return true;
        if (state == JOB_IN_PART && !batch_join_part(batch, batch->cursor, err))
            return false;
    }
    return true;
}
