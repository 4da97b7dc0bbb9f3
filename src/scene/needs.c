#include "scene/needs.h"

#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

#define NEEDS_ROW(flag) offsetof(struct needs, flag)

const struct needs_row needs_rows[] = {
    {"area lights", NEEDS_ROW(area_lights), "no shape emits"},
    {"point lights", NEEDS_ROW(point_lights), "there is none"},
    {"two-sided lights", NEEDS_ROW(two_sided_lights), "every lamp emits to one side"},
    {"distant lights", NEEDS_ROW(distant_lights), "there is none"},
    {"environment", NEEDS_ROW(environment), "there is none"},
    {"lens", NEEDS_ROW(lens), "the camera is a pinhole"},
    {"specular vertices", NEEDS_ROW(delta_bsdfs), "no material is smooth"},
    {"vertices to connect", NEEDS_ROW(rough_bsdfs), "no material is rough"},
    {"transmission", NEEDS_ROW(transmission), "no material transmits"},
    {"straight-through surfaces", NEEDS_ROW(straight), "no light goes straight on"},
    {"shading normals", NEEDS_ROW(shading_normals), "all equal the geometric ones"},
    {"choice of lobes", NEEDS_ROW(lobes), "no material has two lobes"},
    {"quadrics", NEEDS_ROW(quadrics), "all shapes are triangle meshes"},
    {"robust intersection", NEEDS_ROW(robust), "few triangles are very thin"},
    {"lights hit by chance", NEEDS_ROW(light_hits), "no shape emits, no environment"},
    {"connections to the camera", NEEDS_ROW(camera_connections), "no material is rough"},
    {"connections to lights", NEEDS_ROW(light_connections), "no material is rough"},
    {"surface parameters", NEEDS_ROW(uv), "no texture reads them"},
    {"bump and normal maps", NEEDS_ROW(bump), "no material has one"},
    {NULL, 0, NULL},
};

bool needs_get(const struct needs *needs, const struct needs_row *row)
{
    bool value;
    memcpy(&value, (const char *)needs + row->offset, sizeof value);
    return value;
}

/* What passes straight on is no event, except at a lamp. */
static void needs_of_events(unsigned flags, bool emits, struct needs *needs)
{
    bool scatters = (flags & BSDF_BLACK) == 0;
    bool passes = !emits && (flags & BSDF_ONLY_STRAIGHT) != 0;
    needs->delta_bsdfs |= scatters && !passes &&
                          (flags & (BSDF_DELTA | BSDF_SOME_DELTA)) != 0;
    needs->rough_bsdfs |= scatters && (flags & BSDF_DELTA) == 0;
}

static void needs_of_shapes(const struct scene *scene, struct needs *needs)
{
    for (size_t i = 0; i < scene->desc->shape_count; i++) {
        const struct shape *shape = &scene->shapes[i];
        unsigned flags = shape->bsdf->flags;
        bool bumped = shape->bsdf->relief.texture && !shape->quadric;
        needs_of_events(flags, shape->light >= 0, needs);
        needs->straight |= shape_passes(shape);
        needs->transmission |= (flags & BSDF_TRANSMITS) != 0;
        needs->bump |= bumped;
        needs->uv |= (flags & BSDF_TEXTURED) != 0 || bumped;
        needs->lobes |= (flags & BSDF_U_LOBE) != 0;
        needs->shading_normals |= shape->triangles.n || bumped;
        needs->quadrics |= shape->quadric != NULL;
        needs->robust |= shape->thin;
    }
}

static void needs_of_lights(const struct scene *scene, struct needs *needs)
{
    for (int i = 0; i < scene->light_count; i++) {
        const struct light *light = &scene->lights[i];
        needs->area_lights |= light->shape >= 0;
        needs->point_lights |= light->delta_position && !light->infinite;
        needs->distant_lights |= light->delta_position && light->infinite;
        needs->two_sided_lights |= light->two_sided;
    }
}

struct needs needs_compute(const struct scene *scene, bool keep_all)
{
    struct needs needs = {.keep_all = keep_all};
    if (keep_all) {
        for (const struct needs_row *row = needs_rows; row->name; row++) {
            const bool yes = true;
            memcpy((char *)&needs + row->offset, &yes, sizeof yes);
        }
        return needs;
    }
    needs_of_shapes(scene, &needs);
    needs_of_lights(scene, &needs);
    needs.lens = scene->camera.lens_radius > 0.0;
    needs.environment = scene->environment != NULL;
    needs.light_hits = needs.area_lights || needs.environment;
    needs.camera_connections = needs.rough_bsdfs;
    needs.light_connections = needs.rough_bsdfs;
    return needs;
}

struct needs needs_of_desc(const struct scene_desc *desc)
{
    struct needs needs = {.lens = desc->camera.lens_radius > 0.0};
    for (size_t i = 0; i < desc->shape_count; i++) {
        const struct shape_desc *shape = &desc->shapes[i];
        needs_of_events(desc->materials[shape->material].flags, shape->emits, &needs);
    }
    for (size_t i = 0; i < desc->light_count; i++) {
        const struct light_desc *light = &desc->lights[i];
        bool distant = light->type == &light_distant;
        bool shines = rgb_luminance(light->intensity) > 0.0;
        needs.distant_lights |= shines && distant;
        needs.point_lights |= shines && !distant && light->type != &light_environment;
    }
    return needs;
}

void needs_left_out(const struct needs *needs, char *text, size_t size)
{
    size_t used = 0;
    if (size > 0)
        snprintf(text, size, "nothing");
    for (const struct needs_row *row = needs_rows; row->name; row++) {
        if (needs_get(needs, row) || used >= size)
            continue;
        int n = snprintf(text + used, size - used, "%s%s", used ? ", " : "", row->name);
        used += (size_t)n;
    }
}
