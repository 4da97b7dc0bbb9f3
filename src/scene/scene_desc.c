#include "scene/scene_desc.h"

#include "base/mem.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

struct scene_desc *scene_desc_create(const char *path)
{
    struct scene_desc *desc = mem_alloc(1, sizeof *desc);
    desc->path = text_copy(path);
    log_init(&desc->log);
    desc->camera.to_world = xform_identity();
    desc->camera.place.file = desc->path;
    desc->camera.crop[1] = desc->camera.crop[3] = 1.0;
    return desc;
}

void scene_desc_destroy(struct scene_desc *desc)
{
    if (!desc)
        return;
    for (size_t i = 0; i < desc->shape_count; i++)
        mesh_destroy(desc->shapes[i].mesh);
    for (size_t i = 0; i < desc->setting_count; i++) {
        mem_free(desc->settings[i].key);
        mem_free(desc->settings[i].value);
    }
    for (size_t i = 0; i < desc->string_count; i++)
        mem_free(desc->strings[i]);
    for (size_t i = 0; i < desc->part_count; i++)
        mem_free(desc->parts[i]);
    mem_free(desc->parts);
    texture_set_deinit(&desc->textures);
    mem_free(desc->materials);
    mem_free(desc->shapes);
    mem_free(desc->instances.list);
    mem_free(desc->lights);
    mem_free(desc->settings);
    mem_free(desc->strings);
    log_deinit(&desc->log);
    mem_free(desc->path);
    mem_free(desc->definitions);
    mem_free(desc->lost_light);
    mem_free(desc);
}

int scene_desc_add_material(struct scene_desc *desc, const struct bsdf *bsdf)
{
    desc->materials = mem_grow(desc->materials, &desc->material_capacity,
                               desc->material_count + 1, sizeof *desc->materials);
    desc->materials[desc->material_count] = *bsdf;
    return (int)desc->material_count++;
}

const struct bsdf *scene_desc_add_part(struct scene_desc *desc, const struct bsdf *bsdf)
{
    struct bsdf *part = mem_alloc(1, sizeof *part);
    *part = *bsdf;
    desc->parts = mem_grow(desc->parts, &desc->part_capacity, desc->part_count + 1,
                           sizeof(struct bsdf *));
    desc->parts[desc->part_count++] = part;
    return part;
}

int scene_desc_add_shape(struct scene_desc *desc, const struct shape_desc *shape)
{
    desc->shapes = mem_grow(desc->shapes, &desc->shape_capacity, desc->shape_count + 1,
                            sizeof *desc->shapes);
    desc->shapes[desc->shape_count] = *shape;
    return (int)desc->shape_count++;
}

int scene_desc_add_object(struct scene_desc *desc)
{
    return ++desc->object_count;
}

void scene_desc_add_instance(struct scene_desc *desc,
                             const struct instance_desc *instance)
{
    desc->instances.list = mem_grow(desc->instances.list, &desc->instances.capacity,
                                    desc->instances.count + 1,
                                    sizeof *desc->instances.list);
    desc->instances.list[desc->instances.count++] = *instance;
}

int scene_desc_add_light(struct scene_desc *desc, const struct light_desc *light)
{
    desc->lights = mem_grow(desc->lights, &desc->light_capacity, desc->light_count + 1,
                            sizeof *desc->lights);
    desc->lights[desc->light_count] = *light;
    return (int)desc->light_count++;
}

void scene_desc_add_setting(struct scene_desc *desc, const char *key, const char *value,
                            const struct place *at)
{
    desc->settings = mem_grow(desc->settings, &desc->setting_capacity,
                              desc->setting_count + 1, sizeof *desc->settings);
    struct setting_desc *setting = &desc->settings[desc->setting_count++];
    *setting = (struct setting_desc){.key = text_copy(key), .value = text_copy(value)};
    if (at) {
        setting->place = *at;
        setting->place.file = scene_desc_keep(desc, at->file);
    }
}

const char *scene_desc_keep(struct scene_desc *desc, const char *file)
{
    if (!file)
        return NULL;
    for (size_t i = desc->string_count; i-- > 0;) /* the newest is the likeliest */
        if (strcmp(desc->strings[i], file) == 0)
            return desc->strings[i];
    desc->strings = mem_grow(desc->strings, &desc->string_capacity,
                             desc->string_count + 1, sizeof *desc->strings);
    desc->strings[desc->string_count] = text_copy(file);
    return desc->strings[desc->string_count++];
}

void scene_desc_lose_light(struct scene_desc *desc, const char *what,
                           const struct place *at)
{
    if (desc->lost_light)
        return;
    desc->lost_light = text_copy(what);
    desc->lost_light_place = *at;
    if (at->file)
        desc->lost_light_place.file = scene_desc_keep(desc, at->file);
}

struct rgb scene_desc_clamp(struct scene_desc *desc, struct rgb value,
                            const struct place *at)
{
    if (!(value.r < 0.0 || value.g < 0.0 || value.b < 0.0))
        return value;
    log_note(&desc->log, at, "a negative colour component was clamped to 0");
    return rgb(value.r < 0.0 ? 0.0 : value.r, value.g < 0.0 ? 0.0 : value.g,
               value.b < 0.0 ? 0.0 : value.b);
}
