#include "lab/stage.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"
#include "image/exr.h"
#include "import/import.h"
#include "lab/reference.h"
#include "lab/scene_settings.h"

#include <math.h>

#define WARM_UP_SECONDS   0.5  /* at most, */
#define WARM_UP_SHARE     0.1  /* and at most this share of the budget */
#define WARM_UP_BOOTSTRAP 2000 /* paths at most: one round that cannot be cut short */

struct stage {
    struct stage_options options;
    const struct experiment_scene *entry;
    struct settings file; /* defaults and what the scene file says */
    struct scene_options built;
    struct scene *scene;
    double seconds_load;
    char left_out[512];
    bool warm;
    struct reference reference;
    int reference_depth;     /* a rendered one is made for one depth */
    struct error_row *curve; /* of the job that runs */
    size_t curve_count, curve_capacity;
};

struct stage *stage_create(const struct stage_options *options)
{
    struct stage *stage = mem_alloc(1, sizeof *stage);
    stage->options = *options;
    return stage;
}

static void leave(struct stage *stage)
{
    reference_deinit(&stage->reference);
    scene_destroy(stage->scene);
    stage->scene = NULL;
    stage->warm = false;
}

void stage_destroy(struct stage *stage)
{
    if (stage == NULL)
        return;
    leave(stage);
    mem_free(stage->curve);
    mem_free(stage);
}

/* --- the scene ------------------------------------------------------------------- */

static int threads_of(const struct stage *stage)
{
    return stage->options.threads > 0 ? stage->options.threads : par_threads_available();
}

/* In full: defaults, the scene file's, the job's. */
static bool settle(const struct stage *stage, const struct job *job,
                   struct settings *settings, struct err *err)
{
    *settings = stage->file;
    if (!job_settings(job, settings, err))
        return false;
    if (settings->threads == 0)
        settings->threads = stage->options.threads;
    return true;
}

static bool fits(const struct stage *stage, const struct settings *settings)
{
    struct scene_options o = scene_settings_options(settings);
    return o.width == stage->built.width && o.height == stage->built.height &&
           o.keep_all == stage->built.keep_all && o.compact == stage->built.compact;
}

static bool load(struct stage *stage, const struct job *job, struct settings *settings,
                 struct err *err)
{
    double begin = clock_wall();
    struct import_options importing = {.threads = threads_of(stage)};
    struct scene_desc *desc = import_scene(job->scene->path, &importing, err);
    if (desc == NULL)
        return false;
    settings_init(&stage->file);
    if (!scene_settings_apply(desc, &stage->file, err) ||
        !settle(stage, job, settings, err)) {
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
        if (!settle(stage, job, settings, err))
            return false;
        if (fits(stage, settings))
            return true;
    }
    leave(stage);
    return load(stage, job, settings, err);
}

/* --- the reference --------------------------------------------------------------- */

static bool obtain(struct stage *stage, const struct job *job,
                   const struct settings *settings, struct err *err)
{
    const struct stage_options *o = &stage->options;
    struct reference_request request;
    if (!reference_request_init(&request, job, &stage->file, settings, err))
        return false;
    if (request.settings.threads == 0 && o->shared)
        request.settings.threads = settings->threads;
    request.width = stage->scene->camera.width;
    request.height = stage->scene->camera.height;
    request.max_depth = stage->reference_depth;
    request.folder = o->references;
    request.scene = stage->scene;
    request.stop = o->stop;
    request.on_half = o->on_half;
    request.on_progress = o->on_progress;
    request.hook_ctx = o->hook_ctx;
    return reference_obtain(&request, &stage->reference, err);
}

/* False on failure or when it was stopped. */
static bool have_reference(struct stage *stage, const struct job *job,
                           const struct settings *settings, struct err *err)
{
    const struct reference_spec *spec = job->reference;
    int depth = settings_depth(settings, stage->scene);
    bool rendered = spec->kind == REFERENCE_RENDERED;
    if (!rendered && spec->kind != REFERENCE_FILE)
        return true;
    if (stage->reference.picture && (!rendered || stage->reference_depth == depth))
        return true;
    reference_deinit(&stage->reference);
    stage->reference_depth = depth;
    return rendered ? obtain(stage, job, settings, err)
                    : reference_read(spec, &stage->reference, err);
}

bool stage_prepare(struct stage *stage, const struct job *job, struct err *err)
{
    struct settings settings;
    return enter(stage, job, &settings, err) &&
           have_reference(stage, job, &settings, err);
}

const struct reference *stage_reference(const struct stage *stage)
{
    return &stage->reference;
}

/* --- a job ----------------------------------------------------------------------- */

static bool warm_up(struct stage *stage, const struct settings *settings, struct err *err)
{
    struct settings briefly = *settings;
    double share = WARM_UP_SHARE * settings->seconds;
    if (stage->warm || stage->options.cold || !(settings->seconds > 0.0))
        return true;
    briefly.seconds = share < WARM_UP_SECONDS ? share : WARM_UP_SECONDS;
    if (briefly.bootstrap > WARM_UP_BOOTSTRAP)
        briefly.bootstrap = WARM_UP_BOOTSTRAP;
    struct run_options options = {
        .scene = stage->scene, .settings = &briefly, .stop = stage->options.stop};
    struct run_result result = {0};
    stage->warm = run_render(&options, &result, err);
    run_result_deinit(&result);
    return stage->warm;
}

static bool keep_row(void *ctx, const struct error_row *row)
{
    struct stage *stage = ctx;
    stage->curve = mem_grow(stage->curve, &stage->curve_capacity, stage->curve_count + 1,
                            sizeof *stage->curve);
    stage->curve[stage->curve_count++] = *row;
    return true;
}

static void pass_progress(void *ctx, const struct run_progress *progress)
{
    const struct stage *stage = ctx;
    stage->options.on_progress(stage->options.hook_ctx, progress);
}

static bool write_picture(const struct stage *stage, const struct job *job,
                          const struct store *store,
                          const struct statistics_record *record, struct err *err)
{
    int count;
    struct exr_attribute *of_run = statistics_attributes(record, &count);
    struct exr_attribute *all = mem_alloc((size_t)count + 3, sizeof *all);
    all[0] = (struct exr_attribute){"etalon:experiment", stage->options.experiment->name};
    all[1] = (struct exr_attribute){"etalon:job", job->id};
    all[2] = (struct exr_attribute){"etalon:label", job->label};
    for (int i = 0; i < count; i++)
        all[3 + i] = of_run[i];
    char *path = store_picture_path(store, job->id);
    bool ok = exr_write(path, record->run.image, all, count + 3, &record->run.layers,
                        err);
    mem_free(path);
    mem_free(all);
    statistics_attributes_destroy(of_run, count);
    return ok;
}

static bool deliver(const struct stage *stage, const struct job *job, struct store *store,
                    const struct run_result *result, const struct settings *settings,
                    struct outcome *outcome, struct err *err)
{
    const struct reference *reference = &stage->reference;
    bool measured = reference->picture != NULL;
    struct statistics_record record;
    struct metric metric = {0};
    statistics_record_init(&record, result, settings, stage->scene, stage->left_out);
    record.seconds_load = stage->seconds_load;
    char *path = measured ? reference_path_from(reference, stage->options.folder) : NULL;
    struct store_result row = {
        .job = job->id,
        .label = job->label,
        .scene_label = job->scene->label,
        .experiment = stage->options.experiment->name,
        .cell = job->cell,
        .record = &record,
        .metric = measured ? &metric : NULL,
        .reference = measured ? reference : NULL,
        .reference_path = path,
        .curve = stage->curve,
        .curve_count = stage->curve_count,
    };
    bool ok = (!measured ||
               metric_compare(result->image, reference->picture, &metric, err)) &&
              write_picture(stage, job, store, &record, err) &&
              store_append(store, &row, err);
    *outcome = (struct outcome){
        .seconds = result->seconds_total,
        .paths = result->statistics.paths,
        .relmse = measured ? metric.relmse : (double)NAN,
        .noise = measured ? reference->relmse : (double)NAN,
        .black = !(result->statistics.b > 0.0),
    };
    mem_free(path);
    return ok;
}

bool stage_run(struct stage *stage, const struct job *job, struct store *store,
               struct outcome *outcome, struct err *err)
{
    struct settings settings;
    struct run_result result = {0};
    if (!enter(stage, job, &settings, err) ||
        !have_reference(stage, job, &settings, err) || !warm_up(stage, &settings, err))
        return false;
    struct run_options options = {
        .scene = stage->scene,
        .settings = &settings,
        .reference = stage->reference.picture,
        .stop = stage->options.stop,
        .on_progress = stage->options.on_progress ? pass_progress : NULL,
        .on_error_row = keep_row,
        .hook_ctx = stage,
    };
    stage->curve_count = 0;
    bool ok = run_render(&options, &result, err) && !result.interrupted &&
              deliver(stage, job, store, &result, &settings, outcome, err);
    run_result_deinit(&result);
    return ok;
}
