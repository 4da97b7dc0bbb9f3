#include "cli/info.h"

#include "base/machine.h"
#include "integrator/registry.h"

#include <assert.h>

static void count(struct info_counts *counts, const char *name, long found)
{
    if (found == 0)
        return;
    assert(counts->kinds < INFO_KINDS);
    counts->rows[counts->kinds].name = name;
    counts->rows[counts->kinds++].count = found;
    counts->total += found;
}

static void count_shapes(struct info *info, const struct scene *scene)
{
    static const char *const names[] = {[SHAPE_MESH] = "mesh",
                                        [SHAPE_SPHERE] = "sphere",
                                        [SHAPE_DISK] = "disk",
                                        [SHAPE_CYLINDER] = "cylinder"};
    const struct scene_desc *desc = scene->desc;
    long found[sizeof names / sizeof names[0]] = {0};
    for (size_t i = 0; i < desc->shape_count; i++) {
        found[desc->shapes[i].kind]++;
        info->triangles += scene->shapes[i].triangles.count;
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        count(&info->shapes, names[i], found[i]);
}

static void count_materials(struct info *info, const struct scene_desc *desc)
{
    for (int k = 0; bsdf_types[k]; k++) {
        long found = 0;
        for (size_t i = 0; i < desc->material_count; i++)
            found += desc->materials[i].type == bsdf_types[k];
        count(&info->materials, bsdf_types[k]->name, found);
    }
}

static void count_lights(struct info *info, const struct scene *scene)
{
    static const struct light_type *const types[] = {&light_area,    &light_area_textured,
                                                     &light_point,   &light_spot,
                                                     &light_distant, &light_environment};
    for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
        long found = 0;
        for (int i = 0; i < scene->light_count; i++)
            found += scene->lights[i].type == types[k];
        count(&info->lights, types[k]->name, found);
    }
}

void info_gather(struct info *info, const struct session *session)
{
    *info = (struct info){.session = session, .memory = memory_of_scene(session->scene)};
    info->peak_bytes = machine_memory_peak();
    count_shapes(info, session->scene);
    count_materials(info, session->scene->desc);
    count_lights(info, session->scene);
    info->run = run_memory(session->scene, &session->settings);
    info->now_bytes = machine_memory_now();
    info->available_bytes = machine_memory_available();
}

double info_render_peak(const struct info *info)
{
    return fmax(info->peak_bytes, info->now_bytes + run_memory_sum(&info->run));
}
