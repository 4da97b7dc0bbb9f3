#include "cli/delivery.h"

#include "base/mem.h"
#include "base/text.h"
#include "cli/output.h"
#include "cli/summary.h"
#include "image/exr.h"
#include "image/preview.h"
#include "lab/statistics.h"
#include "settings/setting.h"

bool delivery_init(struct delivery *d, const char *out, const char *stats,
                   struct err *err)
{
    *d = (struct delivery){.out = out, .stats = stats};
    if (!text_ends_with(out, ".exr"))
        return err_set(err, ERR_USAGE, NULL, "-o '%s': the picture's name ends in .exr",
                       out);
    d->preview = output_with_ending(out, ".png");
    d->failures = output_with_ending(out, ".failures.png");
    return output_check(out, err) && output_check(d->preview, err) &&
           output_check(d->failures, err) && output_check(stats, err);
}

void delivery_deinit(struct delivery *d)
{
    mem_free(d->preview);
    mem_free(d->failures);
}

bool delivery_check_reference(const struct image *reference, const char *path,
                              const struct camera *camera, struct err *err)
{
    struct place at = {path, 0, 0};
    if (reference == NULL)
        return true;
    if (reference->width != camera->width || reference->height != camera->height)
        return err_set(err, ERR_VALUE, &at,
                       "the reference has %dx%d pixels, the picture %dx%d: give another, "
                       "or another --size",
                       reference->width, reference->height, camera->width,
                       camera->height);
    if (image_nonfinite(reference) > 0)
        return err_set(err, ERR_VALUE, &at,
                       "%ld pixels of the reference are not finite: give another",
                       image_nonfinite(reference));
    return true;
}

/* What auto chose may lack layers that another would have. */
static void warn_of_layers(const struct session *session, const struct run_result *result)
{
    struct settings chosen = session->settings;
    struct text names = {0};
    if (!result->statistics.race.chosen[0])
        return;
    chosen.integrator = result->statistics.race.chosen;
    chosen.layers = settings_layers_lacking(&chosen);
    if (chosen.layers == 0)
        return;
    setting_print(settings_find("layers"), &chosen, &names);
    fprintf(stderr, "warning: auto chose %s, which has no layers of these: %s\n",
            chosen.integrator, names.data);
    mem_free(names.data);
}

static void warn_of_result(const struct session *session, const struct run_result *result)
{
    const struct run_statistics *s = &result->statistics;
    if (settings_until(&session->settings) && result->end == RUN_BUDGET)
        fprintf(stderr, "warning: the budget ended before the until condition "
                        "was met: give it more\n");
    if (result->interrupted)
        fprintf(stderr, "interrupted: the picture so far was written\n");
    if (s->unsampled > 0.0)
        fprintf(stderr,
                "warning: the run ended before each pixel had a sample: %.2g %% of them "
                "are black; give it more time\n",
                100.0 * s->unsampled);
    else if (!(s->b > 0.0))
        fprintf(stderr, "warning: no light-carrying path found in %.0f samples\n",
                s->paths + s->bootstrap_paths);
    else if (s->start_mutations < 1.0 && s->plain_lengths > 0 && !s->plain_only)
        fprintf(stderr,
                "warning: the run ended before its chains began: path lengths beyond %d "
                "are missing; give it more time, or fewer paths: --set bootstrap=N\n",
                s->plain_lengths);
    else if (s->paths < 1.0)
        fprintf(stderr, "warning: the run ended during the bootstrap and the picture is "
                        "black; give it more time, or fewer paths: --set bootstrap=N\n");
}

/* The share of failed proposals as a picture: black for none, white for all, blue where
 * no state was. */
static bool write_failure_map(const struct delivery *d, const struct run_result *result,
                              struct err *err)
{
    const struct image *like = result->image;
    const float *shares = layers_find(&result->layers, "failures.Y");
    if (shares == NULL)
        return true;
    struct image *map = image_create(like->width, like->height);
    for (long i = 0; i < (long)like->width * like->height; i++) {
        float share = shares[i];
        for (int channel = 0; channel < 3; channel++)
            map->pixels[3 * i + channel] = share >= 0.0f ? share
                                                         : (channel == 2 ? 0.2f : 0.0f);
    }
    bool ok = preview_write_png(d->failures, map, 0.0, err);
    image_destroy(map);
    return ok;
}

static bool write_picture(const struct delivery *d, const struct run_result *result,
                          const struct statistics_record *record, struct err *err)
{
    int count;
    struct exr_attribute *attributes = statistics_attributes(record, &count);
    bool ok = exr_write(d->out, result->image, attributes, count, &result->layers, err) &&
              preview_write_png(d->preview, result->image, (double)NAN, err) &&
              write_failure_map(d, result, err);
    statistics_attributes_destroy(attributes, count);
    return ok;
}

bool delivery_write(const struct delivery *d, const struct session *session,
                    const struct run_result *result, struct err *err)
{
    struct statistics_record record;
    struct metric metric;
    statistics_record_init(&record, result, &session->settings, session->scene,
                           session->left_out);
    record.seconds_load = session->load_seconds;
    if (!write_picture(d, result, &record, err) ||
        (d->stats && !statistics_write(d->stats, &record, err)))
        return false;
    if (d->reference && !metric_compare(result->image, d->reference, &metric, err))
        return false;
    warn_of_result(session, result);
    warn_of_layers(session, result);
    bool failures = layers_find(&result->layers, "failures.Y") != NULL;
    summary_print(&record, d->reference ? &metric : NULL, stdout);
    printf("%-12s %s, %s%s%s\n", "written", d->out, d->preview, failures ? ", " : "",
           failures ? d->failures : "");
    return true;
}
