#include "lab/preflight.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "lab/reference_check.h"
#include "lab/scene_settings.h"

struct check {
    const struct preflight_options *options;
    bool *missing;
    char **folders; /* folders of missing references, without repeats */
    size_t folder_count, folder_capacity;
    const struct scene_desc *desc; /* the current scene, */
    struct settings file;          /* the settings of its file, */
    struct reference reference;    /* and its reference if that is a file */
    struct provenance provenance;
};

/* The size of the pictures of this job, without building its scene. */
static bool picture_size(const struct scene_desc *desc, const struct settings *settings,
                         struct camera *camera, struct err *err)
{
    bool own = settings->width > 0 && settings->height > 0;
    return camera_build(&desc->camera, own ? (int)settings->width : desc->width,
                        own ? (int)settings->height : desc->height, camera, err);
}

static bool check_picture(const struct job *job, const struct camera *camera,
                          const struct image *reference, struct err *err)
{
    if (reference->width != camera->width || reference->height != camera->height)
        return err_set(err, ERR_VALUE, &job->reference->at,
                       "the reference '%s' has %dx%d pixels, the pictures of '%s' %dx%d",
                       job->reference->given, reference->width, reference->height,
                       job->name, camera->width, camera->height);
    if (image_nonfinite(reference) > 0)
        return err_set(err, ERR_VALUE, &job->reference->at,
                       "%ld pixels of the reference '%s' are not finite",
                       image_nonfinite(reference), job->reference->given);
    return true;
}

static void note_missing(struct check *c, size_t job,
                         const struct reference_request *request)
{
    if (c->missing == NULL || reference_is_made(request))
        return;
    char *folder = reference_folder(request);
    bool known = false;
    for (size_t i = 0; i < c->folder_count; i++)
        known = known || text_equal(c->folders[i], folder);
    c->missing[job] = !known;
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    c->folders = mem_grow(c->folders, &c->folder_capacity, c->folder_count + 1,
                          sizeof *c->folders);
    c->folders[c->folder_count++] = folder;
}

static bool check_rendered(struct check *c, size_t index, const struct settings *settings,
                           const struct camera *camera, int depth, struct err *err)
{
    const struct job *job = &c->options->jobs->items[index];
    struct reference_request request;
    if (!reference_request_init(&request, job, &c->file, settings, err))
        return false;
    request.width = camera->width;
    request.height = camera->height;
    request.max_depth = depth;
    request.folder = c->options->references;
    struct provenance provenance = {0};
    provenance_of_request(&request, &provenance);
    bool ok = c->options->force ||
              reference_check(job, settings, depth, c->desc, &provenance,
                              c->options->own_method, err);
    provenance_deinit(&provenance);
    if (ok)
        note_missing(c, index, &request);
    return ok;
}

static bool check_job(struct check *c, size_t index, struct err *err)
{
    const struct job *job = &c->options->jobs->items[index];
    struct settings settings = c->file;
    struct camera camera;
    if (!job_settings(job, &settings, err) ||
        !picture_size(c->desc, &settings, &camera, err))
        return false;
    int depth = settings_depth_of(&settings, c->desc->max_depth);
    if (job->reference->kind == REFERENCE_RENDERED)
        return check_rendered(c, index, &settings, &camera, depth, err);
    if (job->reference->kind != REFERENCE_FILE)
        return true;
    return check_picture(job, &camera, c->reference.picture, err) &&
           (c->options->force ||
            reference_check(job, &settings, depth, c->desc, &c->provenance,
                            c->options->own_method, err));
}

/* Checks all jobs of a scene; they share one reference. */
static bool check_jobs(struct check *c, size_t first, struct err *err)
{
    const struct jobs *jobs = c->options->jobs;
    const struct reference_spec *spec = jobs->items[first].reference;
    if (spec->kind == REFERENCE_FILE) {
        if (!reference_read(spec->file, &spec->at, &c->reference, err))
            return false;
        provenance_of_file(spec->file, &c->provenance);
    }
    bool ok = true;
    for (size_t i = first; ok && i < jobs->count; i++)
        if (c->options->wanted[i] && jobs->items[i].scene == jobs->items[first].scene)
            ok = check_job(c, i, err);
    reference_deinit(&c->reference);
    provenance_deinit(&c->provenance);
    return ok;
}

static bool check_scene(struct check *c, size_t first, struct err *err)
{
    const struct preflight_options *o = c->options;
    struct scene_desc *desc = import_scene(o->jobs->items[first].scene->path, NULL, err);
    if (desc == NULL)
        return false;
    if (o->on_log)
        o->on_log(o->hook_ctx, &desc->log);
    c->desc = desc;
    settings_init(&c->file);
    bool ok = scene_settings_apply(desc, &c->file, err) && check_jobs(c, first, err);
    scene_desc_destroy(desc);
    return ok;
}

static bool is_first_of_scene(const struct jobs *jobs, const bool *wanted, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (wanted[i] && jobs->items[i].scene == jobs->items[index].scene)
            return false;
    return wanted[index];
}

bool preflight(const struct preflight_options *options, bool *missing, struct err *err)
{
    struct check c = {.options = options, .missing = missing};
    bool ok = true;
    for (size_t i = 0; ok && i < options->jobs->count; i++)
        if (is_first_of_scene(options->jobs, options->wanted, i))
            ok = check_scene(&c, i, err);
    for (size_t i = 0; i < c.folder_count; i++)
        mem_free(c.folders[i]);
    mem_free(c.folders);
    return ok;
}
