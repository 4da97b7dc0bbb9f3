/* What a run will take of memory, before it takes any. */

#include "base/text.h"
#include "integrator/registry.h"
#include "run/run.h"

/* Of a pixel, when a run is over: the picture and two earlier ones, and either the sums
 * that films are added up in or failures, the error and the variances that it is made of.
 */
#define PICTURE_BYTES (9.0 * sizeof(float) + 3.0 * sizeof(double))

/* What the end of a run takes beside what is there by then, whatever comes of it; more
 * than is seen to be taken. Of a pixel: the sums that the picture is made of, errors and
 * a verdict, 64; the file of up to 7 channels as it grows, 84; a PNG, 24. And what
 * libraries and small tables take. */
#define RESERVE_PIXEL 192
#define RESERVE_LEAST ((size_t)16 << 20)

size_t run_reserve(const struct scene *scene)
{
    return RESERVE_LEAST + (size_t)RESERVE_PIXEL * (size_t)scene->camera.width *
                               (size_t)scene->camera.height;
}

struct run_memory run_memory(const struct scene *scene, const struct settings *settings)
{
    struct run_memory memory = {
        .pictures = PICTURE_BYTES * scene->camera.width * scene->camera.height,
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
    double wanted = run_memory_sum(memory) - memory->extra; /* most do without it */
    if (!(wanted > available))
        return true;
    const char *change = text_equal(settings->integrator, "pfmlt") &&
                                 text_equal(settings->mode, "paper")
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
