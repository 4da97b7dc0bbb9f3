#include "lab/preflight.h"

#include "image/exr.h"
#include "import/import.h"
#include "lab/scene_settings.h"

/* The size of the pictures that this job makes, without building its scene. */
static bool picture_size(const struct scene_desc *desc, const struct settings *settings,
                         struct camera *camera, struct err *err)
{
    bool own = settings->width > 0 && settings->height > 0;
    return camera_build(&desc->camera, own ? (int)settings->width : desc->width,
                        own ? (int)settings->height : desc->height, camera, err);
}

static bool check_size(const struct job *job, const struct scene_desc *desc,
                       const struct settings *settings, const struct image *reference,
                       struct err *err)
{
    struct camera camera;
    if (!picture_size(desc, settings, &camera, err))
        return false;
    if (reference->width == camera.width && reference->height == camera.height)
        return true;
    return err_set(err, ERR_VALUE, &job->reference->at,
                   "the reference '%s' has %dx%d pixels, the pictures of '%s' %dx%d",
                   job->reference->given, reference->width, reference->height, job->name,
                   camera.width, camera.height);
}

static bool check_job(const struct job *job, const struct scene_desc *desc,
                      const struct image *reference, struct err *err)
{
    struct settings settings;
    settings_init(&settings);
    return scene_settings_apply(desc, &settings, err) &&
           job_settings(job, &settings, err) &&
           (reference == NULL || check_size(job, desc, &settings, reference, err));
}

/* All jobs of a scene share the reference. */
static bool check_scene(const struct jobs *jobs, const bool *wanted, size_t first,
                        const struct scene_desc *desc, struct err *err)
{
    const struct reference_spec *spec = jobs->items[first].reference;
    struct image *reference = NULL;
    if (spec->kind == REFERENCE_FILE) {
        reference = exr_read(spec->file, &spec->at, err);
        if (reference == NULL)
            return false;
    }
    bool ok = true;
    for (size_t i = first; ok && i < jobs->count; i++)
        if (wanted[i] && jobs->items[i].scene == jobs->items[first].scene)
            ok = check_job(&jobs->items[i], desc, reference, err);
    image_destroy(reference);
    return ok;
}

static bool is_first_of_scene(const struct jobs *jobs, const bool *wanted, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (wanted[i] && jobs->items[i].scene == jobs->items[index].scene)
            return false;
    return wanted[index];
}

bool preflight(const struct jobs *jobs, const bool *wanted,
               void (*on_log)(void *hook_ctx, const struct log *log), void *hook_ctx,
               struct err *err)
{
    bool ok = true;
    for (size_t i = 0; ok && i < jobs->count; i++) {
        if (!is_first_of_scene(jobs, wanted, i))
            continue;
        struct scene_desc *desc = import_scene(jobs->items[i].scene->path, NULL, err);
        if (desc == NULL)
            return false;
        if (on_log)
            on_log(hook_ctx, &desc->log);
        ok = check_scene(jobs, wanted, i, desc, err);
        scene_desc_destroy(desc);
    }
    return ok;
}
