/* Predicts the memory of a run before it allocates any. */

#include "base/text.h"
#include "integrator/light_classes.h"
#include "integrator/registry.h"
#include "path/features.h"
#include "run/run.h"

/* Bytes per pixel at the end of a run: the picture, two snapshots and one to compare with
 * them, and either the sums
 * of the films or, later, failures, error bars and the variances that they are made of.
 */
#define PICTURE_BYTES (12.0 * sizeof(float) + 3.0 * sizeof(double))

/* Reserve for the end of a run, more than was ever measured. Per pixel: sums of the
 * picture, error bars and verdict, 64; the file of up to 8 channels as it grows, 96; a
 * PNG, 24; alpha, 4. Further: libraries and small tables. */
#define RESERVE_PIXEL 192
#define RESERVE_LEAST ((size_t)16 << 20)
/* A further channel, and the file as it grows by it. */
#define RESERVE_CHANNEL 16

/* Channels of the layers that the settings ask for, at most. */
static int layer_channels(const struct scene *scene, const struct settings *settings)
{
    static const struct {
        long layer;
        int channels;
    } list[] = {{LAYER_ACCEPTANCE, 2},
                {LAYER_FAILURES, 1},
                {LAYER_WORK, 1},
                {LAYER_VISITS, 1},
                {LAYER_FEATURES, FEATURES_CHANNELS}};
    int count = light_classes_channels(settings, settings_depth(settings, scene));
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (settings->layers & list[i].layer)
            count += list[i].channels;
    return count;
}

size_t run_reserve(const struct scene *scene, const struct settings *settings)
{
    size_t pixel = RESERVE_PIXEL +
                   RESERVE_CHANNEL * (size_t)layer_channels(scene, settings);
    return RESERVE_LEAST +
           pixel * (size_t)scene->camera.width * (size_t)scene->camera.height;
}

struct run_memory run_memory(const struct scene *scene, const struct settings *settings)
{
    struct run_memory memory = {
        .pictures = (PICTURE_BYTES + (scene->hide_emitters ? sizeof(float) : 0) +
                     (double)(sizeof(float) * (size_t)layer_channels(scene, settings))) *
                    scene->camera.width * scene->camera.height,
    };
    const struct integrator_type *type = integrator_find(settings->integrator);
    type->methods->memory(type, scene, settings, &memory);
    return memory;
}

double run_memory_sum(const struct run_memory *memory)
{
    return memory->films + memory->states + memory->pictures;
}

bool run_check_memory(const struct run_memory *memory, double available,
                      const struct settings *settings, struct err *err)
{
    double wanted = run_memory_sum(memory) -
                    memory->extra; /* most runs do not need `extra` */
    if (!(wanted > available))
        return true;
    const char *change = settings_uses(settings, "mode") &&
                                 text_equal(settings_mode(settings), "paper")
                             ? ", or another mode than paper, which wants a film for "
                               "each path length"
                             : "";
    return err_set(
        err, ERR_VALUE, NULL,
        "%s may take %.0f MB (films %.0f, states %.0f, pictures %.0f), and "
        "%.0f MB of memory are available: give a smaller --size, --max-depth "
        "or --threads%s%s",
        settings->integrator, wanted / 0x1p20, memory->films / 0x1p20,
        memory->states / 0x1p20, memory->pictures / 0x1p20, available / 0x1p20,
        memory->states > 0.5 * wanted ? ", fewer chains or bootstrap paths" : "", change);
}
