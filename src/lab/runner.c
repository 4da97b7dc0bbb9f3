#include "lab/runner.h"

#include "base/mem.h"
#include "base/text.h"
#include "lab/batch.h"
#include "lab/parts.h"
#include "lab/preflight.h"
#include "lab/runner_parallel.h"

/* --- what there is to do --------------------------------------------------------- */

static enum job_state state_of(const struct batch *b, const struct job *job,
                               const struct csv *runs)
{
    if (runs && store_has_job(runs, job->id))
        return JOB_HAD_ROW;
    return part_is_finished(b->options->folder, job, NULL) ? JOB_IN_PART : JOB_TODO;
}

/* Reads the state of the jobs from the tables. one: of the job of that number (from 1)
 * alone; 0: of all jobs that `only` matches. */
static bool read_job_states(struct batch *b, size_t one, struct err *err)
{
    const struct runner_options *o = b->options;
    struct err inner = {0};
    struct csv *runs = store_read_runs(o->folder, &inner);
    if (runs == NULL && inner.code != ERR_NONE) {
        *err = inner;
        return false;
    }
    *b->summary = (struct runner_summary){0};
    for (size_t i = 0; i < o->jobs->count; i++) {
        const struct job *job = &o->jobs->items[i];
        bool chosen = one ? i + 1 == one : o->only == NULL || job_matches(job, o->only);
        b->states[i] = chosen ? state_of(b, job, runs) : JOB_NOT_WANTED;
        b->summary->jobs += chosen;
        b->summary->done_before += b->states[i] == JOB_HAD_ROW;
    }
    b->to_do = b->summary->jobs - b->summary->done_before;
    csv_destroy(runs);
    return b->summary->jobs > 0 ||
           err_set(err, ERR_USAGE, NULL,
                   "no job's name matches '%s'; --list shows the names", o->only);
}

static bool check_before_work(struct batch *b, struct err *err)
{
    const struct runner_options *o = b->options;
    bool *wanted = mem_alloc(o->jobs->count, sizeof *wanted);
    for (size_t i = 0; i < o->jobs->count; i++)
        wanted[i] = b->states[i] == JOB_TODO;
    struct preflight_options checks = {
        .jobs = o->jobs,
        .wanted = wanted,
        .references = o->references,
        .force = o->force,
        .own_method = o->own_method,
        .on_log = o->on_log,
        .hook_ctx = o->hook_ctx,
    };
    bool ok = preflight(&checks, b->missing, err);
    mem_free(wanted);
    return ok;
}

static void tell_upgrade(const struct batch *b)
{
    const struct runner_options *o = b->options;
    struct log log;
    if (!store_upgraded(b->store) || o->on_log == NULL)
        return;
    log_init(&log);
    log_note(&log, NULL,
             "the tables in '%s' were of an older version: they got today's columns, "
             ".nan where they say nothing",
             o->folder);
    o->on_log(o->hook_ctx, &log);
    log_deinit(&log);
}

/* Opens and locks the results, and reads the states again, as another process may have
 * changed them before. */
static bool open_results(struct batch *b, struct err *err)
{
    const struct jobs *jobs = b->options->jobs;
    b->store = store_open(b->options->folder, false, err);
    if (b->store == NULL || !read_job_states(b, 0, err))
        return false;
    tell_upgrade(b);
    for (size_t i = 0; i < jobs->count; i++)
        if (b->states[i] == JOB_HAD_ROW)
            part_drop(b->options->folder, &jobs->items[i]);
    return true;
}

/* --- jobs ------------------------------------------------------------------------ */

static bool run_in_turn(struct batch *b, struct job_context *context, struct err *err)
{
    const struct jobs *jobs = b->options->jobs;
    bool ok = true;
    for (size_t i = 0; ok && !batch_stopped(b) && i < jobs->count; i++) {
        struct outcome outcome;
        if (b->states[i] == JOB_TODO) {
            ok = job_context_run(context, &jobs->items[i], b->store, &outcome, err);
            if (!ok)
                break;
            b->states[i] = JOB_JOINED;
            part_drop(b->options->folder, &jobs->items[i]);
            batch_report(b, i, &outcome, false);
        }
        ok = batch_join_parts(b, err);
    }
    return ok;
}

static bool run_here(struct batch *b, struct err *err)
{
    struct job_context_options options = batch_context_options(b);
    struct job_context *context = job_context_create(&options);
    batch_report_parts(b);
    bool ok = run_in_turn(b, context, err);
    job_context_destroy(context);
    return ok;
}

/* --- the batch ------------------------------------------------------------------- */

/* Completes the summary. True if the batch succeeded or was stopped. */
static bool finish(struct batch *b, bool ok, const struct err *err)
{
    for (size_t i = 0; b->store && i < b->options->jobs->count; i++)
        b->summary->waiting += b->states[i] == JOB_IN_PART && i > b->cursor;
    b->summary->interrupted = batch_stopped(b) && b->summary->done_now < b->to_do;
    if (b->store)
        parts_tidy(b->options->folder);
    return ok || (b->summary->interrupted && err->code == ERR_NONE);
}

/* Checks everything before the folder is created. */
bool runner_run(const struct runner_options *options, struct runner_summary *summary,
                struct err *err)
{
    struct batch b;
    batch_init(&b, options, summary);
    bool ok = read_job_states(&b, 0, err) && check_before_work(&b, err) &&
              open_results(&b, err) &&
              (options->workers > 1 ? runner_parallel(&b, err) : run_here(&b, err));
    ok = finish(&b, ok, err);
    batch_deinit(&b);
    return ok;
}

static bool run_part(struct batch *b, size_t job, struct err *err)
{
    struct job_context_options options = batch_context_options(b);
    options.shared = true;
    struct job_context *context = job_context_create(&options);
    struct outcome outcome;
    bool ok = part_run(context, b->options->folder, &b->options->jobs->items[job],
                       &outcome, err);
    if (ok)
        batch_report(b, job, &outcome, false);
    job_context_destroy(context);
    return ok;
}

bool runner_run_one(const struct runner_options *options, size_t number,
                    struct runner_summary *summary, struct err *err)
{
    struct batch b;
    size_t count = options->jobs->count;
    if (number < 1 || number > count)
        return err_set(err, ERR_USAGE, NULL,
                       "there is no job %zu; the numbers are 1 to %zu, see --list",
                       number, count);
    batch_init(&b, options, summary);
    bool ok = read_job_states(&b, number, err);
    if (ok && b.states[number - 1] == JOB_TODO)
        ok = check_before_work(&b, err) && run_part(&b, number - 1, err);
    else if (ok)
        summary->done_before = 1;
    ok = finish(&b, ok, err);
    batch_deinit(&b);
    return ok;
}

bool runner_collect(const struct runner_options *options, struct runner_summary *summary,
                    struct err *err)
{
    struct batch b;
    batch_init(&b, options, summary);
    bool ok = read_job_states(&b, 0, err) && open_results(&b, err);
    if (ok)
        batch_report_parts(&b);
    for (size_t i = 0; ok && i < options->jobs->count; i++)
        ok = b.states[i] != JOB_IN_PART || batch_join_part(&b, i, err);
    ok = finish(&b, ok, err);
    batch_deinit(&b);
    return ok;
}

static bool make_references(struct batch *b, struct err *err)
{
    const struct runner_options *o = b->options;
    struct job_context_options options = batch_context_options(b);
    struct job_context *context = job_context_create(&options);
    bool ok = true;
    for (size_t i = 0; ok && !batch_stopped(b) && i < o->jobs->count; i++) {
        if (!b->missing[i])
            continue;
        ok = job_context_make_reference(context, &o->jobs->items[i], err);
        b->summary->references += ok;
        if (ok && o->on_reference)
            o->on_reference(o->hook_ctx, &o->jobs->items[i],
                            job_context_reference(context));
    }
    job_context_destroy(context);
    return ok;
}

bool runner_references(const struct runner_options *options,
                       struct runner_summary *summary, struct err *err)
{
    struct batch b;
    batch_init(&b, options, summary);
    bool ok = read_job_states(&b, 0, err) && check_before_work(&b, err) &&
              make_references(&b, err);
    summary->interrupted = batch_stopped(&b) && !ok;
    batch_deinit(&b);
    return ok || (summary->interrupted && err->code == ERR_NONE);
}
