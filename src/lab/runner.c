#include "lab/runner.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"
#include "image/exr.h"
#include "import/import.h"
#include "lab/preflight.h"
#include "lab/reference.h"
#include "lab/scene_settings.h"

/* What consecutive jobs share: a scene that is loaded, and the reference for it. */
struct stage {
    const struct experiment_scene *entry;
    struct settings file; /* defaults and what the scene file says */
    struct scene_options built;
    struct scene *scene;
    double seconds_load;
    char left_out[512];
    struct image *reference;
    int reference_depth; /* a rendered one is made for one depth */
};

struct runner {
    const struct runner_options *options;
    struct runner_summary *summary;
    struct store *store;
    bool *wanted; /* by job: to be run now */
    size_t wanted_count;
    struct stage stage;
    struct error_row *curve; /* of the job that runs */
    size_t curve_count, curve_capacity;
};

static bool stopped(const struct runner *r)
{
    return r->options->stop && *r->options->stop;
}

/* --- the stage ------------------------------------------------------------------- */

static void drop_reference(struct stage *stage)
{
    image_destroy(stage->reference);
    stage->reference = NULL;
}

static void leave(struct stage *stage)
{
    drop_reference(stage);
    scene_destroy(stage->scene);
    *stage = (struct stage){0};
}

static bool fits(const struct stage *stage, const struct settings *settings)
{
    struct scene_options o = scene_settings_options(settings);
    return o.width == stage->built.width && o.height == stage->built.height &&
           o.keep_all == stage->built.keep_all;
}

static bool load(struct stage *stage, const struct job *job, struct settings *settings,
                 struct err *err)
{
    double begin = clock_wall();
    struct import_options importing = {.threads = par_threads_available()};
    struct scene_desc *desc = import_scene(job->scene->path, &importing, err);
    if (desc == NULL)
        return false;
    settings_init(&stage->file);
    bool ok = scene_settings_apply(desc, &stage->file, err);
    *settings = stage->file;
    if (!ok || !job_settings(job, settings, err)) {
        scene_desc_destroy(desc);
        return false;
    }
    stage->built = scene_settings_options(settings);
    stage->scene = scene_build(desc, &stage->built, err);
    if (stage->scene == NULL)
        return false;
    stage->entry = job->scene;
    needs_left_out(&stage->scene->needs, stage->left_out, sizeof stage->left_out);
    stage->seconds_load = clock_wall() - begin;
    return true;
}

/* The scene of this job, in its size, and the job's settings in full. */
static bool enter(struct stage *stage, const struct job *job, struct settings *settings,
                  struct err *err)
{
    if (stage->scene && stage->entry == job->scene) {
        *settings = stage->file;
        if (!job_settings(job, settings, err))
            return false;
        if (fits(stage, settings))
            return true;
    }
    leave(stage);
    return load(stage, job, settings, err);
}

static bool render_reference(struct runner *r, const struct job *job,
                             const struct settings *settings, struct err *err)
{
    struct stage *stage = &r->stage;
    struct reference_request request = {
        .spec = job->reference,
        .scene = stage->scene,
        .settings = stage->file,
        .scene_fingerprint = job->scene_fingerprint,
        .label = job->scene->label,
        .folder = r->options->references,
        .stop = r->options->stop,
        .on_half = r->options->on_half,
        .on_progress = r->options->on_progress,
        .hook_ctx = r->options->hook_ctx,
    };
    request.settings.max_depth = settings->max_depth;
    request.settings.width = settings->width;
    request.settings.height = settings->height;
    request.settings.keep_all = settings->keep_all;
    request.settings.threads = settings->threads;
    stage->reference = reference_obtain(&request, err);
    return stage->reference != NULL;
}

/* False on failure or when it was stopped. */
static bool have_reference(struct runner *r, const struct job *job,
                           const struct settings *settings, struct err *err)
{
    struct stage *stage = &r->stage;
    const struct reference_spec *spec = job->reference;
    int depth = settings_depth(settings, stage->scene);
    bool rendered = spec->kind == REFERENCE_RENDERED;
    if (!rendered && spec->kind != REFERENCE_FILE)
        return true;
    if (stage->reference && (!rendered || stage->reference_depth == depth))
        return true;
    drop_reference(stage);
    stage->reference_depth = depth;
    if (rendered)
        return render_reference(r, job, settings, err);
    stage->reference = exr_read(spec->file, &spec->at, err);
    return stage->reference != NULL;
}

/* --- a job ----------------------------------------------------------------------- */

static bool keep_row(void *ctx, const struct error_row *row)
{
    struct runner *r = ctx;
    r->curve = mem_grow(r->curve, &r->curve_capacity, r->curve_count + 1,
                        sizeof *r->curve);
    r->curve[r->curve_count++] = *row;
    return true;
}

static void pass_progress(void *ctx, const struct run_progress *progress)
{
    const struct runner *r = ctx;
    r->options->on_progress(r->options->hook_ctx, progress);
}

static bool write_picture(const struct runner *r, const struct job *job,
                          const struct statistics_record *record, struct err *err)
{
    int count;
    struct exr_attribute *of_run = statistics_attributes(record, &count);
    struct exr_attribute *all = mem_alloc((size_t)count + 3, sizeof *all);
    all[0] = (struct exr_attribute){"etalon:experiment", r->options->experiment->name};
    all[1] = (struct exr_attribute){"etalon:job", job->id};
    all[2] = (struct exr_attribute){"etalon:label", job->label};
    for (int i = 0; i < count; i++)
        all[3 + i] = of_run[i];
    char *path = store_picture_path(r->store, job->id);
    struct exr_layer layers[STATISTICS_LAYERS];
    int layer_count = statistics_layers(&record->run, layers);
    bool ok = exr_write(path, record->run.image, all, count + 3, layers, layer_count,
                        err);
    mem_free(path);
    mem_free(all);
    statistics_attributes_destroy(of_run, count);
    return ok;
}

static bool deliver(struct runner *r, const struct job *job,
                    const struct run_result *result, const struct settings *settings,
                    struct err *err)
{
    struct stage *stage = &r->stage;
    struct statistics_record record;
    struct metric metric = {0};
    statistics_record_init(&record, result, settings, stage->scene, stage->left_out);
    record.seconds_load = stage->seconds_load;
    struct store_result row = {
        .job = job->id,
        .label = job->label,
        .scene_label = job->scene->label,
        .record = &record,
        .metric = stage->reference ? &metric : NULL,
        .curve = r->curve,
        .curve_count = r->curve_count,
    };
    if (stage->reference &&
        !metric_compare(result->image, stage->reference, &metric, err))
        return false;
    if (!write_picture(r, job, &record, err) || !store_append(r->store, &row, err))
        return false;
    struct runner_report report = {.number = ++r->summary->done_now,
                                   .of = r->wanted_count,
                                   .job = job,
                                   .result = result,
                                   .metric = row.metric};
    if (r->options->on_job)
        r->options->on_job(r->options->hook_ctx, &report);
    return true;
}

/* A run that was stopped is none: it leaves no row. */
static bool run_job(struct runner *r, const struct job *job, struct err *err)
{
    struct settings settings;
    struct run_result result = {0};
    if (!enter(&r->stage, job, &settings, err) || !have_reference(r, job, &settings, err))
        return false;
    struct run_options options = {
        .scene = r->stage.scene,
        .settings = &settings,
        .reference = r->stage.reference,
        .stop = r->options->stop,
        .on_progress = r->options->on_progress ? pass_progress : NULL,
        .on_error_row = keep_row,
        .hook_ctx = r,
    };
    r->curve_count = 0;
    bool ok = run_render(&options, &result, err) && !result.interrupted &&
              deliver(r, job, &result, &settings, err);
    run_result_deinit(&result);
    return ok;
}

/* --- the batch ------------------------------------------------------------------- */

/* Which jobs are to be run, by what the table of finished ones says now. */
static bool choose(struct runner *r, struct err *err)
{
    const struct jobs *jobs = r->options->jobs;
    const char *only = r->options->only;
    struct err inner = {0};
    struct csv *runs = store_read_runs(r->options->folder, &inner);
    if (runs == NULL && inner.code != ERR_NONE) {
        *err = inner;
        return false;
    }
    *r->summary = (struct runner_summary){0};
    r->wanted_count = 0;
    for (size_t i = 0; i < jobs->count; i++) {
        const struct job *job = &jobs->items[i];
        bool chosen = only == NULL || job_matches(job, only);
        bool done = chosen && runs && store_has_job(runs, job->id);
        r->wanted[i] = chosen && !done;
        r->summary->jobs += chosen;
        r->summary->done_before += done;
        r->wanted_count += r->wanted[i];
    }
    csv_destroy(runs);
    return r->summary->jobs > 0 ||
           err_set(err, ERR_USAGE, NULL,
                   "no job's name matches '%s'; --list shows the names", only);
}

/* What is wrong is told before the folder is made. */
static bool prepare(struct runner *r, struct err *err)
{
    const struct runner_options *o = r->options;
    if (!choose(r, err) || !preflight(o->jobs, r->wanted, o->on_log, o->hook_ctx, err))
        return false;
    r->store = store_open(o->folder, err);
    return r->store && choose(r, err);
}

static bool run_all(struct runner *r, struct err *err)
{
    const struct jobs *jobs = r->options->jobs;
    bool ok = true;
    for (size_t i = 0; ok && !stopped(r) && i < jobs->count; i++)
        if (r->wanted[i])
            ok = run_job(r, &jobs->items[i], err);
    r->summary->interrupted = stopped(r) && r->summary->done_now < r->wanted_count;
    return ok || (r->summary->interrupted && err->code == ERR_NONE);
}

bool runner_run(const struct runner_options *options, struct runner_summary *summary,
                struct err *err)
{
    struct runner r = {.options = options, .summary = summary};
    *summary = (struct runner_summary){0};
    r.wanted = mem_alloc(options->jobs->count, sizeof *r.wanted);
    bool ok = prepare(&r, err) && run_all(&r, err);
    leave(&r.stage);
    store_close(r.store);
    mem_free(r.wanted);
    mem_free(r.curve);
    return ok;
}
