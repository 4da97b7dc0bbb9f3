#include "lab/reference.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "lab/folder.h"
#include "lab/scalar.h"
#include "lab/statistics.h"

#include <string.h>
#include <unistd.h>

/* To be raised when a change of the program changes what a reference converges to. */
#define REFERENCE_VERSION 1
/* Far from the seeds of jobs: a half would hang together with a run of its own seed. */
#define FIRST_SEED 1000000001L

struct reference {
    const struct reference_request *request;
    struct settings settings; /* of a half, but for the seed */
    char *folder;
    struct image *halves[2];
    struct image *mean;
};

static bool settle(struct reference *r, struct err *err)
{
    const struct axes *given = &r->request->spec->settings;
    struct settings *settings = &r->settings;
    struct err inner = {0};
    *settings = r->request->settings;
    settings->integrator = "bdpt";
    for (size_t i = 0; i < given->count; i++) {
        const struct choice *c = &given->items[i].choices[0];
        if (!settings_set(settings, c->key, c->value, &c->at, err))
            return false;
    }
    settings->seconds *= 0.5;
    settings->mutations_per_pixel *= 0.5;
    return settings_check(settings, &inner) ||
           err_set(err, inner.code, &r->request->spec->at, "%s", inner.message);
}

static char *folder_of(const struct reference *r)
{
    const struct reference_request *request = r->request;
    const struct axes *given = &request->spec->settings;
    char digits[HASH_DIGITS + 1];
    struct hash hash;
    hash_init(&hash);
    hash_number(&hash, REFERENCE_VERSION);
    hash_number(&hash, request->scene_fingerprint);
    hash_number(&hash, (uint64_t)request->scene->camera.width);
    hash_number(&hash, (uint64_t)request->scene->camera.height);
    hash_number(&hash, (uint64_t)settings_depth(&r->settings, request->scene));
    hash_text(&hash, r->settings.integrator);
    for (size_t i = 0; i < given->count; i++) {
        hash_text(&hash, given->items[i].choices[0].key);
        hash_text(&hash, given->items[i].choices[0].value);
    }
    hash_digits(&hash, digits);
    return text_format("%s/%s-%s", request->folder, request->label, digits);
}

static char *file_of(const struct reference *r, const char *name)
{
    return text_format("%s/%s", r->folder, name);
}

static bool write_picture(const struct reference *r, const char *path,
                          const struct run_result *result,
                          const struct settings *settings, struct err *err)
{
    struct statistics_record record;
    char left_out[512];
    int count;
    const struct scene *scene = r->request->scene;
    needs_left_out(&scene->needs, left_out, sizeof left_out);
    statistics_record_init(&record, result, settings, scene, left_out);
    struct exr_attribute *attributes = statistics_attributes(&record, &count);
    bool ok = exr_write(path, result->image, attributes, count, NULL, 0, err);
    statistics_attributes_destroy(attributes, count);
    return ok;
}

static struct image *render_half(const struct reference *r, const char *path, int half,
                                 struct err *err)
{
    const struct reference_request *request = r->request;
    struct settings settings = r->settings;
    settings.seed = FIRST_SEED + half;
    struct run_options options = {
        .scene = request->scene,
        .settings = &settings,
        .stop = request->stop,
        .on_progress = request->on_progress,
        .hook_ctx = request->hook_ctx,
    };
    struct run_result result = {0};
    if (request->on_half)
        request->on_half(request->hook_ctx, r->folder, half);
    if (run_render(&options, &result, err) && !result.interrupted &&
        write_picture(r, path, &result, &settings, err))
        return result.image;
    run_result_deinit(&result);
    return NULL;
}

/* A half that an earlier process finished is as good as one of ours. */
static bool obtain_half(struct reference *r, int half, struct err *err)
{
    char name[16];
    snprintf(name, sizeof name, "half%d.exr", half + 1);
    char *path = file_of(r, name);
    r->halves[half] = access(path, F_OK) == 0 ? exr_read(path, NULL, err)
                                              : render_half(r, path, half, err);
    mem_free(path);
    return r->halves[half] != NULL;
}

static bool write_mean(struct reference *r, struct err *err)
{
    static const struct exr_attribute attributes[] = {
        {"etalon:mean_of", "half1.exr"},
        {"etalon:mean_and", "half2.exr"},
    };
    r->mean = image_mean(r->halves[0], r->halves[1]);
    char *path = file_of(r, "mean.exr");
    bool ok = exr_write(path, r->mean, attributes,
                        (int)(sizeof attributes / sizeof attributes[0]), NULL, 0, err);
    mem_free(path);
    return ok;
}

static void append_figure(struct text *text, const char *key, double value)
{
    text_append(text, "%s: ", key);
    scalar_append_number(text, value);
    text_append(text, "\n");
}

static bool write_noise(const struct reference *r, struct err *err)
{
    struct metric noise;
    struct text text = {0};
    if (!metric_compare(r->halves[0], r->mean, &noise, err))
        return false;
    append_figure(&text, "mean_ratio", noise.mean_ratio);
    append_figure(&text, "rmse", noise.rmse);
    append_figure(&text, "relmse", noise.relmse);
    append_figure(&text, "relmse_trimmed", noise.relmse_trimmed);
    char *path = file_of(r, "noise.yaml");
    bool ok = text_write_file(path, text.data, text.length, err);
    mem_free(path);
    mem_free(text.data);
    return ok;
}

static bool is_finished(const struct reference *r)
{
    char *path = file_of(r, "noise.yaml");
    bool finished = access(path, F_OK) == 0;
    mem_free(path);
    return finished;
}

static bool read_mean(struct reference *r, struct err *err)
{
    char *path = file_of(r, "mean.exr");
    r->mean = exr_read(path, NULL, err);
    mem_free(path);
    return r->mean != NULL;
}

static bool make(struct reference *r, struct err *err)
{
    bool busy;
    if (!folder_make(r->folder, err))
        return false;
    int lock = folder_lock(r->folder, true, &busy, err);
    if (lock < 0)
        return false;
    bool ok;
    if (is_finished(r)) {
        ok = read_mean(r, err);
    } else {
        folder_remove_parts(r->folder);
        ok = obtain_half(r, 0, err) && obtain_half(r, 1, err) && write_mean(r, err) &&
             write_noise(r, err);
    }
    close(lock);
    return ok;
}

struct image *reference_obtain(const struct reference_request *request, struct err *err)
{
    struct reference r = {.request = request};
    if (!settle(&r, err))
        return NULL;
    r.folder = folder_of(&r);
    struct err inner = {0};
    bool ok = is_finished(&r) ? read_mean(&r, &inner) : make(&r, &inner);
    bool stopped = request->stop && *request->stop;
    if (!ok && !stopped && err)
        *err = inner;
    if (!ok) {
        image_destroy(r.mean);
        r.mean = NULL;
    }
    image_destroy(r.halves[0]);
    image_destroy(r.halves[1]);
    mem_free(r.folder);
    return r.mean;
}
