/* etalon info: what is in a scene, what it needs, what is left out and why. */

#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/options.h"
#include "cli/session.h"

#include <stdio.h>
#include <sys/resource.h>

#define LABEL "%-11s "

static void print_film(const struct session *session)
{
    const struct scene *scene = session->scene;
    const struct camera *camera = &scene->camera;
    const char *whose = session->settings.max_depth > 0 ? "as set"
                        : scene->max_depth > 0          ? "the file's own"
                                                        : "the default";
    printf(LABEL "%dx%d pixels\n", "film", camera->width, camera->height);
    printf(LABEL "%d edges (%s)\n", "max depth",
           settings_depth(&session->settings, scene), whose);
    printf(LABEL "at (%g, %g, %g) towards (%g, %g, %g), ", "camera",
           (double)camera->origin.x, (double)camera->origin.y, (double)camera->origin.z,
           (double)camera->axes.n.x, (double)camera->axes.n.y, (double)camera->axes.n.z);
    if (camera->lens_radius > 0.0)
        printf("thin lens of radius %g focused at %g\n", camera->lens_radius,
               camera->focus_distance);
    else
        printf("pinhole\n");
}

static void print_shapes(const struct scene *scene)
{
    static const char *const names[] = {[SHAPE_MESH] = "mesh",
                                        [SHAPE_SPHERE] = "sphere",
                                        [SHAPE_DISK] = "disk",
                                        [SHAPE_CYLINDER] = "cylinder"};
    const struct scene_desc *desc = scene->desc;
    size_t counts[sizeof names / sizeof names[0]] = {0};
    size_t triangles = 0;
    for (size_t i = 0; i < desc->shape_count; i++) {
        counts[desc->shapes[i].kind]++;
        triangles += scene->shapes[i].triangle_count;
    }
    printf(LABEL "%zu", "shapes", desc->shape_count);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (counts[i] > 0)
            printf(", %s %zu", names[i], counts[i]);
    printf("; %zu triangles\n", triangles);
}

static void print_materials(const struct scene_desc *desc)
{
    printf(LABEL "%zu", "materials", desc->material_count);
    for (int k = 0; bsdf_types[k]; k++) {
        size_t count = 0;
        for (size_t i = 0; i < desc->material_count; i++)
            count += desc->materials[i].type == bsdf_types[k];
        if (count > 0)
            printf(", %s %zu", bsdf_types[k]->name, count);
    }
    printf("\n");
}

static void print_textures(const struct scene_desc *desc)
{
    const struct texture_set *set = &desc->textures;
    if (set->count + set->image_count > 0)
        printf(LABEL "%zu, of %zu pictures; %.1f MB\n", "textures", set->count,
               set->image_count, (double)texture_set_bytes(set) / 0x1p20);
}

static void print_lights(const struct scene *scene)
{
    static const struct light_type *const types[] = {
        &light_area, &light_point, &light_spot, &light_distant, &light_environment};
    printf(LABEL "%d", "lights", scene->light_count);
    for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
        int count = 0;
        for (int i = 0; i < scene->light_count; i++)
            count += scene->lights[i].type == types[k];
        if (count > 0)
            printf(", %s %d", types[k]->name, count);
    }
    printf("; emission is scaled by 1/%g\n", scene->emission_scale);
}

static void print_cost(const struct session *session)
{
    const struct scene *scene = session->scene;
    struct rusage usage;
    printf(LABEL "(%g, %g, %g) to (%g, %g, %g)\n", "bounds", (double)scene->bounds_min.x,
           (double)scene->bounds_min.y, (double)scene->bounds_min.z,
           (double)scene->bounds_max.x, (double)scene->bounds_max.y,
           (double)scene->bounds_max.z);
    printf(LABEL "%s\n", "rays", accel_description(scene->accel));
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        printf(LABEL "%.1f MB at most while loading, which took %.2f s\n", "memory",
               (double)usage.ru_maxrss / 1024.0, session->load_seconds);
}

static void print_needs(const struct needs *needs)
{
    int count = 0;
    printf("needs\n");
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (needs_get(needs, row))
            printf("  %s\n", row->name);
    printf("left out\n");
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (!needs_get(needs, row)) {
            printf("  %-26s %s\n", row->name, row->reason);
            count++;
        }
    if (count == 0)
        printf("  nothing%s\n", needs->keep_all ? ": keep_all is set" : "");
}

static void print_file_settings(const struct scene_desc *desc)
{
    if (desc->setting_count > 0)
        printf("settings of the file\n");
    for (size_t i = 0; i < desc->setting_count; i++) {
        const struct setting_desc *s = &desc->settings[i];
        printf("  %s = %s (%s:%d:%d)\n", s->key, s->value,
               s->place.file ? s->place.file : desc->path, s->place.line, s->place.col);
    }
}

static void print_all(const struct session *session)
{
    const struct scene *scene = session->scene;
    printf(LABEL "%s\n", "scene", scene->desc->path);
    print_film(session);
    print_shapes(scene);
    print_materials(scene->desc);
    print_textures(scene->desc);
    print_lights(scene);
    print_cost(session);
    print_needs(&scene->needs);
    print_file_settings(scene->desc);
    if (scene->desc->log.count > 0)
        printf("notes of loading\n");
    log_print(&scene->desc->log, stdout);
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct session session;
    if (!session_open(&session, args->operands[0], args, &err))
        return fail(&err);
    print_all(&session);
    session_close(&session);
    return 0;
}

const struct command command_info = {
    .name = "info",
    .summary = "what is in a scene, what it needs, what is left out and why",
    .operands = "SCENE [options]",
    .operand_count = 1,
    .groups = {options_scene},
    .lists_settings = true,
    .run = run,
};
