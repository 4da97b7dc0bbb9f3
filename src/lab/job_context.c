#include "lab/job_context.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"
#include "image/exr.h"
#include "image/flip.h"
#include "import/import.h"
#include "lab/reference.h"
#include "lab/scene_settings.h"

#include <math.h>

#define WARM_UP_SECONDS 0.5 /* s, at most, */
#define WARM_UP_SHARE   0.1 /* and at most this share of the budget */
#define WARM_UP_BOOTSTRAP \
    2000 /* paths at most, as the bootstrap cannot be interrupted within a round */

struct job_context {
    struct job_context_options options;
    const struct experiment_scene *entry;
    struct settings file; /* defaults, then the settings of the scene file */
    struct scene_options built;
    struct scene *scene;
    double seconds_load;
    char left_out[512];
    bool warm;
    struct reference reference;
    int reference_depth;     /* max_depth for which a rendered reference was made */
    struct error_row *curve; /* error log of the current job */
    size_t curve_count, curve_capacity;
};

struct job_context *job_context_create(const struct job_context_options *options)
{
    struct job_context *context = mem_alloc(1, sizeof *context);
    context->options = *options;
    return context;
}

static void unload(struct job_context *context)
{
    reference_deinit(&context->reference);
    scene_destroy(context->scene);
    context->scene = NULL;
    context->warm = false;
}

void job_context_destroy(struct job_context *context)
{
    if (context == NULL)
        return;
    unload(context);
    mem_free(context->curve);
    mem_free(context);
}

/* --- the scene ------------------------------------------------------------------- */

/* All settings of a job: defaults, then the scene file's, then the job's. */
static bool resolve_settings(const struct job_context *context, const struct job *job,
                             struct settings *settings, struct err *err)
{
    *settings = context->file;
    if (!job_settings(job, settings, err))
        return false;
    if (settings->threads == 0)
        settings->threads = context->options.threads;
    return true;
}

static bool is_built_alike(const struct job_context *context,
                           const struct settings *settings)
{
    struct scene_options o = scene_settings_options(settings);
    return o.width == context->built.width && o.height == context->built.height &&
           o.keep_all == context->built.keep_all && o.compact == context->built.compact;
}

static bool load(struct job_context *context, const struct job *job,
                 struct settings *settings, struct err *err)
{
    double begin = clock_wall();
    struct import_options importing = {.threads = par_threads(context->options.threads)};
    struct scene_desc *desc = import_scene(job->scene->path, &importing, err);
    if (desc == NULL)
        return false;
    settings_init(&context->file);
    if (!scene_settings_apply(desc, &context->file, err) ||
        !resolve_settings(context, job, settings, err)) {
        scene_desc_destroy(desc);
        return false;
    }
    context->built = scene_settings_options(settings);
    context->scene = scene_build(desc, &context->built, err);
    if (context->scene == NULL)
        return false;
    context->entry = job->scene;
    needs_left_out(&context->scene->needs, context->left_out, sizeof context->left_out);
    context->seconds_load = clock_wall() - begin;
    return true;
}

/* Loads the scene of this job in its size, unless it is loaded, and resolves the job's
 * settings. */
static bool load_for_job(struct job_context *context, const struct job *job,
                         struct settings *settings, struct err *err)
{
    if (context->scene && context->entry == job->scene) {
        if (!resolve_settings(context, job, settings, err))
            return false;
        if (is_built_alike(context, settings))
            return true;
    }
    unload(context);
    return load(context, job, settings, err);
}

/* --- the reference --------------------------------------------------------------- */

static bool obtain_rendered(struct job_context *context, const struct job *job,
                            const struct settings *settings, struct err *err)
{
    const struct job_context_options *o = &context->options;
    struct reference_request request;
    if (!reference_request_init(&request, job, &context->file, settings, err))
        return false;
    if (request.settings.threads == 0 && o->shared)
        request.settings.threads = settings->threads;
    request.width = context->scene->camera.width;
    request.height = context->scene->camera.height;
    request.max_depth = context->reference_depth;
    request.folder = o->references;
    request.scene = context->scene;
    request.stop = o->stop;
    request.on_half = o->on_half;
    request.on_progress = o->on_progress;
    request.hook_ctx = o->hook_ctx;
    return reference_obtain(&request, &context->reference, err);
}

/* False on failure or when it was stopped. */
static bool have_reference(struct job_context *context, const struct job *job,
                           const struct settings *settings, struct err *err)
{
    const struct reference_spec *spec = job->reference;
    int depth = settings_depth(settings, context->scene);
    bool rendered = spec->kind == REFERENCE_RENDERED;
    if (!rendered && spec->kind != REFERENCE_FILE)
        return true;
    if (context->reference.picture && (!rendered || context->reference_depth == depth))
        return true;
    reference_deinit(&context->reference);
    context->reference_depth = depth;
    return rendered ? obtain_rendered(context, job, settings, err)
                    : reference_read(spec->file, &spec->at, &context->reference, err);
}

bool job_context_make_reference(struct job_context *context, const struct job *job,
                                struct err *err)
{
    struct settings settings;
    return load_for_job(context, job, &settings, err) &&
           have_reference(context, job, &settings, err);
}

const struct reference *job_context_reference(const struct job_context *context)
{
    return &context->reference;
}

/* --- a job ----------------------------------------------------------------------- */

static bool warm_up(struct job_context *context, const struct settings *settings,
                    struct err *err)
{
    struct settings short_run = *settings;
    double share = WARM_UP_SHARE * settings->seconds;
    if (context->warm || context->options.cold || !(settings->seconds > 0.0))
        return true;
    short_run.seconds = share < WARM_UP_SECONDS ? share : WARM_UP_SECONDS;
    if (short_run.bootstrap > WARM_UP_BOOTSTRAP)
        short_run.bootstrap = WARM_UP_BOOTSTRAP;
    struct run_options options = {
        .scene = context->scene, .settings = &short_run, .stop = context->options.stop};
    struct run_result result = {0};
    context->warm = run_render(&options, &result, err);
    run_result_deinit(&result);
    return context->warm;
}

static bool keep_row(void *ctx, const struct error_row *row)
{
    struct job_context *context = ctx;
    context->curve = mem_grow(context->curve, &context->curve_capacity,
                              context->curve_count + 1, sizeof *context->curve);
    context->curve[context->curve_count++] = *row;
    return true;
}

static void pass_progress(void *ctx, const struct run_progress *progress)
{
    const struct job_context *context = ctx;
    context->options.on_progress(context->options.hook_ctx, progress);
}

static bool write_picture(const struct job_context *context, const struct job *job,
                          const struct store *store,
                          const struct statistics_record *record, struct err *err)
{
    int count;
    struct exr_attribute *of_run = statistics_attributes(record, &count);
    struct exr_attribute *all = mem_alloc((size_t)count + 3, sizeof *all);
    all[0] = (struct exr_attribute){"etalon:experiment",
                                    context->options.experiment->name};
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

static bool write_results(const struct job_context *context, const struct job *job,
                          struct store *store, const struct run_result *result,
                          const struct settings *settings, struct outcome *outcome,
                          struct err *err)
{
    const struct reference *reference = &context->reference;
    bool measured = reference->picture != NULL;
    struct statistics_record record;
    struct metric metric = {0};
    struct flip flip = {0};
    statistics_record_init(&record, result, settings, context->scene, context->left_out);
    record.seconds_load = context->seconds_load;
    char *path = measured ? reference_path_from(reference, context->options.folder)
                          : NULL;
    struct store_result row = {
        .job = job->id,
        .label = job->label,
        .scene_label = job->scene->label,
        .experiment = context->options.experiment->name,
        .cell = job->cell,
        .record = &record,
        .metric = measured ? &metric : NULL,
        .reference = measured ? reference : NULL,
        .reference_path = path,
        .curve = context->curve,
        .curve_count = context->curve_count,
    };
    bool ok = (!measured ||
               (metric_compare(result->image, reference->picture, &metric, err) &&
                flip_compare(result->image, reference->picture, &flip, err)));
    row.flip = flip.hdr;
    ok = ok && write_picture(context, job, store, &record, err) &&
         store_append(store, &row, err);
    *outcome = (struct outcome){
        .seconds = result->seconds_total,
        .paths = result->statistics.paths,
        .relmse = measured ? metric.relmse : (double)NAN,
        .noise = measured ? reference->noise.relmse : (double)NAN,
        .black = !(result->statistics.b > 0.0),
    };
    mem_free(path);
    return ok;
}

bool job_context_run(struct job_context *context, const struct job *job,
                     struct store *store, struct outcome *outcome, struct err *err)
{
    struct settings settings;
    struct run_result result = {0};
    if (!load_for_job(context, job, &settings, err) ||
        !have_reference(context, job, &settings, err) ||
        !warm_up(context, &settings, err))
        return false;
    struct run_options options = {
        .scene = context->scene,
        .settings = &settings,
        .reference = context->reference.picture,
        .stop = context->options.stop,
        .on_progress = context->options.on_progress ? pass_progress : NULL,
        .on_error_row = keep_row,
        .hook_ctx = context,
    };
    context->curve_count = 0;
    bool ok = run_render(&options, &result, err) && !result.interrupted &&
              write_results(context, job, store, &result, &settings, outcome, err);
    run_result_deinit(&result);
    return ok;
}
