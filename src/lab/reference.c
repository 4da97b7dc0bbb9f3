#include "lab/reference.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "lab/folder.h"
#include "lab/reference_noise.h"
#include "lab/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* To be raised when the program changes such that references converge to other pictures.
 */
#define REFERENCE_VERSION 1

struct making {
    const struct reference_request *request;
    char *folder;
    struct image *halves[REFERENCE_HALVES];
    struct reference *out;
};

void reference_deinit(struct reference *reference)
{
    image_destroy(reference->picture);
    mem_free(reference->path);
    *reference = (struct reference){0};
}

bool reference_request_init(struct reference_request *request, const struct job *job,
                            const struct settings *file, const struct settings *own,
                            struct err *err)
{
    const struct axes *given = &job->reference->settings;
    struct settings *settings = &request->settings;
    struct err inner = {0};
    *request = (struct reference_request){.spec = job->reference,
                                          .settings = *file,
                                          .scene_fingerprint = job->scene_fingerprint,
                                          .label = job->scene->label};
    settings->max_depth = own->max_depth;
    settings->width = own->width;
    settings->height = own->height;
    settings->keep_all = own->keep_all;
    settings->integrator = "bdpt";
    settings->until_converged = false; /* a reference gets its full budget */
    settings->until_relmse = 0.0;
    settings->layers = 0;
    for (size_t i = 0; i < given->count; i++) {
        const struct choice *c = &given->items[i].choices[0];
        if (!settings_set(settings, c->key, c->value, &c->at, err))
            return false;
    }
    return settings_check(settings, &inner) ||
           err_set(err, inner.code, &job->reference->at, "%s", inner.message);
}

/* --- where it is ----------------------------------------------------------------- */

char *reference_folder(const struct reference_request *request)
{
    const struct axes *given = &request->spec->settings;
    char digits[HASH_DIGITS + 1];
    struct hash hash;
    hash_init(&hash);
    hash_number(&hash, REFERENCE_VERSION);
    hash_number(&hash, request->scene_fingerprint);
    hash_number(&hash, (uint64_t)request->width);
    hash_number(&hash, (uint64_t)request->height);
    hash_number(&hash, (uint64_t)request->max_depth);
    hash_text(&hash, request->settings.integrator);
    for (size_t i = 0; i < given->count; i++) {
        hash_text(&hash, given->items[i].choices[0].key);
        hash_text(&hash, given->items[i].choices[0].value);
    }
    hash_digits(&hash, digits);
    return text_format("%s/%s-%s", request->folder, request->label, digits);
}

static bool has_noise(const char *folder)
{
    char *path = text_join(folder, "noise.yaml");
    bool finished = access(path, F_OK) == 0;
    mem_free(path);
    return finished;
}

bool reference_is_made(const struct reference_request *request)
{
    char *folder = reference_folder(request);
    bool made = has_noise(folder);
    mem_free(folder);
    return made;
}

char *reference_path_from(const struct reference *reference, const char *folder)
{
    char *here = realpath(folder, NULL), *there = realpath(reference->path, NULL);
    char *above = here ? text_directory(here) : text_copy("");
    size_t length = strlen(above);
    char *path;
    if (there && length > 1 && strncmp(there, above, length) == 0 && there[length] == '/')
        path = text_format("..%s", there + length);
    else
        path = text_copy(there ? there : reference->path);
    mem_free(above);
    free(here);
    free(there);
    return path;
}

/* --- making ---------------------------------------------------------------------- */

static bool write_picture(const struct making *m, const char *path,
                          const struct run_result *result,
                          const struct settings *settings, struct err *err)
{
    struct statistics_record record;
    char left_out[512];
    int count;
    const struct scene *scene = m->request->scene;
    needs_left_out(&scene->needs, left_out, sizeof left_out);
    statistics_record_init(&record, result, settings, scene, left_out);
    struct exr_attribute *attributes = statistics_attributes(&record, &count);
    bool ok = exr_write(path, result->image, attributes, count, NULL, err);
    statistics_attributes_destroy(attributes, count);
    return ok;
}

static bool check_sampled(const struct reference_request *request,
                          const struct run_result *result, struct err *err)
{
    double unsampled = result->statistics.unsampled;
    return !(unsampled > 0.0) ||
           err_set(
               err, ERR_VALUE, &request->spec->at,
               "half of the reference's budget ended before %.2g %% of the pixels had "
               "a sample: give it more time",
               100.0 * unsampled);
}

static struct image *render_half(const struct making *m, const char *path, int half,
                                 struct err *err)
{
    const struct reference_request *request = m->request;
    struct settings settings = request->settings;
    settings.seed = REFERENCE_SEED + half;
    settings.seconds /= REFERENCE_HALVES;
    settings.mutations_per_pixel /= REFERENCE_HALVES;
    struct run_options options = {
        .scene = request->scene,
        .settings = &settings,
        .stop = request->stop,
        .on_progress = request->on_progress,
        .hook_ctx = request->hook_ctx,
    };
    struct run_result result = {0};
    if (request->on_half)
        request->on_half(request->hook_ctx, m->folder, half);
    if (run_render(&options, &result, err) && !result.interrupted &&
        check_sampled(request, &result, err) &&
        write_picture(m, path, &result, &settings, err)) {
        struct image *image = result.image;
        result.image = NULL;
        run_result_deinit(&result);
        return image;
    }
    run_result_deinit(&result);
    return NULL;
}

/* A half that an earlier process finished is used again. */
static bool obtain_half(struct making *m, int half, struct err *err)
{
    char *path = text_format("%s/half%d.exr", m->folder, half + 1);
    m->halves[half] = access(path, F_OK) == 0 ? exr_read(path, NULL, err)
                                              : render_half(m, path, half, err);
    mem_free(path);
    return m->halves[half] != NULL;
}

static bool write_mean(struct making *m, struct err *err)
{
    static const struct exr_attribute attributes[] = {
        {"etalon:mean_of", "half1.exr"},
        {"etalon:mean_and", "half2.exr"},
    };
    m->out->picture = image_mean(m->halves[0], m->halves[1]);
    return exr_write(m->out->path, m->out->picture, attributes,
                     (int)(sizeof attributes / sizeof attributes[0]), NULL, err);
}

/* --- reading --------------------------------------------------------------------- */

/* Also brings an older noise.yaml up to date, if the folder can be written, so that
 * others who read the file find the same figures. */
static bool read_made_noise(struct making *m, struct err *err)
{
    struct reference_noise read;
    if (!reference_noise_read(m->folder, m->out->picture, &read, err))
        return false;
    m->out->noise = read.noise;
    if (read.from_pictures && isfinite(read.noise.relmse))
        (void)reference_noise_write(m->folder, &read.noise, NULL);
    return true;
}

static bool read_made(struct making *m, struct err *err)
{
    m->out->picture = exr_read(m->out->path, NULL, err);
    return m->out->picture && read_made_noise(m, err);
}

static bool make(struct making *m, struct err *err)
{
    bool busy, ok;
    if (!folder_make(m->folder, err))
        return false;
    int lock = folder_lock(m->folder, true, &busy, err);
    if (lock < 0)
        return false;
    if (has_noise(m->folder)) {
        ok = read_made(m, err);
    } else {
        folder_remove_parts(m->folder);
        ok = obtain_half(m, 0, err) && obtain_half(m, 1, err) && write_mean(m, err) &&
             noise_of_mean(m->halves[0], m->out->picture, &m->out->noise, err) &&
             reference_noise_write(m->folder, &m->out->noise, err);
    }
    close(lock);
    return ok;
}

bool reference_obtain(const struct reference_request *request,
                      struct reference *reference, struct err *err)
{
    struct making m = {
        .request = request, .folder = reference_folder(request), .out = reference};
    struct err inner = {0};
    *reference = (struct reference){.path = text_join(m.folder, "mean.exr")};
    bool ok = has_noise(m.folder) ? read_made(&m, &inner) : make(&m, &inner);
    bool stopped = request->stop && *request->stop;
    if (!ok && !stopped && err)
        *err = inner;
    if (!ok)
        reference_deinit(reference);
    for (int i = 0; i < REFERENCE_HALVES; i++)
        image_destroy(m.halves[i]);
    mem_free(m.folder);
    return ok;
}

bool reference_read(const char *path, const struct place *at, struct reference *reference,
                    struct err *err)
{
    char *folder = text_directory(path);
    char *mean_of = exr_read_attribute(path, "etalon:mean_of");
    struct reference_noise noise = {.noise = reference_noise_unknown()};
    *reference = (struct reference){.path = text_copy(path)};
    reference->picture = exr_read(path, at, err);
    bool known = mean_of && text_ends_with(path, "mean.exr") && has_noise(folder);
    bool ok = reference->picture &&
              (!known || reference_noise_read(folder, reference->picture, &noise, err));
    reference->noise = noise.noise;
    if (!ok)
        reference_deinit(reference);
    mem_free(mean_of);
    mem_free(folder);
    return ok;
}
