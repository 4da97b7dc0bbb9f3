#include "scene/scene.h"

#include "base/clock.h"
#include "base/machine.h"
#include "base/mem.h"
#include "base/par.h"
#include "math/warp.h"
#include "scene/emission.h"
#include "scene/limits.h"
#include "scene/placement.h"

static bool scene_check_desc(const struct scene_desc *desc, struct err *err)
{
    for (size_t i = 0; i < desc->shape_count; i++) {
        const struct shape_desc *shape = &desc->shapes[i];
        if (shape->material < 0 || (size_t)shape->material >= desc->material_count)
            return err_set(err, ERR_VALUE, &shape->place,
                           "shape %zu names material %d, but there are %zu (from 0)", i,
                           shape->material, desc->material_count);
        if (shape->emits && !rgb_is_finite(shape->radiance))
            return err_set(err, ERR_VALUE, &shape->place,
                           "the radiance of a light must be finite");
    }
    for (size_t i = 0; i < desc->light_count; i++) {
        const struct light_desc *light = &desc->lights[i];
        const char *kind = light->type ? light->type->name : light_point.name;
        if (!rgb_is_finite(light->intensity))
            return err_set(err, ERR_VALUE, &light->place,
                           "the intensity of a %s light must be finite", kind);
        const double(*m)[4] = light->to_world.m;
        if (!isfinite((float)(m[0][3] + m[1][3] + m[2][3])))
            return err_set(err, ERR_VALUE, &light->place,
                           "the position of a %s light must be finite", kind);
    }
    return true;
}

/* Notes and errors of a shape, kept so that they are reported in the order of shapes. */
struct shape_report {
    struct log log;
    struct err *err; /* NULL on success */
};

struct shape_work {
    struct scene *scene;
    struct shape_report *reports; /* [shape_count] */
};

static void scene_build_shape(void *ctx, long index, int thread)
{
    (void)thread;
    const struct shape_work *work = ctx;
    struct scene_desc *desc = work->scene->desc;
    struct shape_report *report = &work->reports[index];
    struct err err = {0};
    log_init(&report->log);
    if (shape_build(&work->scene->shapes[index], &desc->shapes[index], desc->materials,
                    &report->log, &err))
        return;
    report->err = mem_alloc(1, sizeof err);
    *report->err = err;
}

/* One block for the records of all meshes, so that it lies on huge pages though each mesh
 * be small. */
static void scene_build_records(struct scene *scene, size_t count)
{
    size_t triangles = 0, floats = 0;
    for (size_t i = 0; i < count; i++) {
        triangles += scene->shapes[i].triangles.count;
        floats += triangle_record_floats(&scene->shapes[i].triangles);
    }
    if (triangles == 0 || triangles > SHAPE_RECORDS_MOST)
        return;
    scene->records = mem_aligned(MEM_APART, floats, sizeof *scene->records);
    scene->records_bytes = floats * sizeof *scene->records;
    float *next = scene->records;
    for (size_t i = 0; i < count; i++) {
        triangle_use_records(&scene->shapes[i].triangles, next);
        next += triangle_record_floats(&scene->shapes[i].triangles);
    }
}

static bool scene_build_shapes(struct scene *scene, int threads, struct err *err)
{
    struct scene_desc *desc = scene->desc;
    size_t count = desc->shape_count;
    scene->shapes = mem_alloc(count + 1, sizeof *scene->shapes);
    struct shape_report *reports = mem_alloc(count + 1, sizeof *reports);
    par_for((long)count, par_threads(threads), scene_build_shape,
            &(struct shape_work){scene, reports});
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        if (good)
            log_merge(&desc->log, &reports[i].log);
        if (good && reports[i].err) {
            struct place at = {reports[i].err->file, reports[i].err->line,
                               reports[i].err->col};
            good = err_set(err, reports[i].err->code, &at, "%s", reports[i].err->message);
        }
        log_deinit(&reports[i].log);
        mem_free(reports[i].err);
    }
    mem_free(reports);
    if (good)
        scene_build_records(scene, count);
    return good;
}

static double scene_map_max(const struct texture_image *map)
{
    if (!map)
        return 1.0;
    double max = 0.0;
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            max = fmax(max, rgb_max(texture_image_texel(map, x, y)));
    return max;
}

static double scene_radiance_max(const struct shape_desc *shape)
{
    return rgb_max(shape->radiance) * (shape->emission ? shape->emission_peak : 1.0);
}

/* The largest component of all emission; 0 without any. */
static double scene_emission_max(const struct scene_desc *desc)
{
    double max = 0.0;
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].emits)
            max = fmax(max, scene_radiance_max(&desc->shapes[i]));
    for (size_t i = 0; i < desc->light_count; i++)
        max = fmax(max, rgb_max(desc->lights[i].intensity) *
                            scene_map_max(desc->lights[i].map));
    return max;
}

/* The power of two at or below the largest component of all emission. */
static double scene_emission_scale(double max)
{
    int exponent;
    if (!(max > 0.0))
        return 1.0;
    frexp(max, &exponent);
    return ldexp(1.0, exponent - 1);
}

/* Adds the light unless it has no power, which is noted. */
static void scene_add_light(struct scene *scene, const struct light *light,
                            const struct place *at)
{
    if (light->power > 0.0) {
        scene->lights[scene->light_count++] = *light;
        return;
    }
    log_note(&scene->desc->log, at, "a light without power was left out");
}

static void scene_add_area_light(struct scene *scene, size_t id)
{
    struct shape_desc *desc = &scene->desc->shapes[id];
    struct rgb radiance = scene_desc_clamp(scene->desc, desc->radiance, &desc->place);
    struct light light = {.type = &light_area,
                          .radiance = rgb_scale(radiance, 1.0 / scene->emission_scale),
                          .shape = (int32_t)id,
                          .two_sided = desc->two_sided,
                          .area = shape_area(&scene->shapes[id])};
    struct rgb mean = light.radiance;
    if (desc->emission) {
        light.type = &light_area_textured;
        mean = rgb_mul(
            mean, emission_build(scene, &light, desc->emission, desc->emission_peak));
    }
    light.power = rgb_luminance(mean) * light.area * MATH_PI *
                  (light.two_sided ? 2.0 : 1.0);
    int before = scene->light_count;
    scene_add_light(scene, &light, &desc->place);
    if (scene->light_count > before)
        scene->shapes[id].light = before;
}

/* A scene has one environment: the brighter of two. */
static void scene_choose_environment(struct scene *scene, struct light *second,
                                     const struct place *at)
{
    struct light *first = &scene->lights[scene->environment - scene->lights];
    bool brighter = second->power > first->power;
    log_note(&scene->desc->log, at,
             "a scene has one environment: of two the brighter one was kept, the %s",
             brighter ? "second" : "first");
    environment_deinit(&(brighter ? first : second)->environment);
    if (brighter)
        *first = *second;
}

static bool scene_add_light_source(struct scene *scene, const struct light_desc *desc,
                                   const struct light_sphere *sphere, struct err *err)
{
    struct rgb intensity = scene_desc_clamp(scene->desc, desc->intensity, &desc->place);
    struct light light = {.type = desc->type ? desc->type : &light_point,
                          .radiance = rgb_scale(intensity, 1.0 / scene->emission_scale),
                          .shape = -1,
                          .sphere = *sphere};
    if (!light.type->build(desc, &light, err))
        return false;
    int before = scene->light_count;
    bool environment = light.infinite && !light.delta_position;
    if (environment && light.power > 0.0 && scene->environment) {
        scene_choose_environment(scene, &light, &desc->place);
        return true;
    }
    scene_add_light(scene, &light, &desc->place);
    if (scene->light_count == before)
        environment_deinit(&light.environment);
    else if (environment)
        scene->environment = &scene->lights[before];
    return true;
}

static void scene_grow_box(float box[2][3], const float lower[3], const float upper[3])
{
    for (int k = 0; k < 3; k++) {
        box[0][k] = fminf(box[0][k], lower[k]);
        box[1][k] = fmaxf(box[1][k], upper[k]);
    }
}

/* A sphere around the vertices or quadrics of all shapes, and the boxes of instances. */
static struct light_sphere scene_sphere(const struct scene *scene)
{
    float box[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const float *lower = box[0], *upper = box[1];
    for (size_t i = 0; i < scene->objects[0].shape_count; i++) {
        float one[2][3];
        shape_bounds(&scene->shapes[i], scene->desc->shapes[i].mesh, one[0], one[1]);
        scene_grow_box(box, one[0], one[1]);
    }
    for (size_t i = 0; i < scene->instance_count; i++)
        scene_grow_box(box, scene->instances[i].lower, scene->instances[i].upper);
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += ((double)upper[k] - (double)lower[k]) *
                  ((double)upper[k] - (double)lower[k]);
    if (!(lower[0] <= upper[0]))
        return (struct light_sphere){{0.0f, 0.0f, 0.0f}, 1.0};
    struct vec3 centre = {0.5f * (lower[0] + upper[0]), 0.5f * (lower[1] + upper[1]),
                          0.5f * (lower[2] + upper[2])};
    return (struct light_sphere){centre, 0.5 * sqrt(square) * (1.0 + 1e-4)};
}

static bool scene_build_triangles(const struct scene *scene, struct light *light)
{
    const struct shape *shape = &scene->shapes[light->shape];
    if (shape->quadric)
        return true;
    const struct triangles *mesh = &shape->triangles;
    double *areas = mem_alloc(mesh->count, sizeof *areas);
    for (uint32_t i = 0; i < mesh->count; i++)
        areas[i] = triangle_area(mesh, i);
    bool good = dist_build(&light->triangles, areas, (int)mesh->count);
    mem_free(areas);
    return good;
}

/* Choice by power, and each light's density of a point. */
static bool scene_build_choice(struct scene *scene, struct err *err)
{
    if (scene->light_count == 0 && scene->desc->lost_light)
        return err_set(err, ERR_VALUE, &scene->desc->lost_light_place,
                       "%s is not read, and there is no other: the scene needs a light, "
                       "or a shape that emits",
                       scene->desc->lost_light);
    if (scene->light_count == 0)
        return err_set(err, ERR_VALUE, NULL,
                       "%s: no emitter: the scene needs a light, or a shape that emits; "
                       "what is black "
                       "or without area does not count",
                       scene->desc->path);
    double *power = mem_alloc((size_t)scene->light_count, sizeof *power);
    for (int i = 0; i < scene->light_count; i++)
        power[i] = scene->lights[i].power;
    bool good = dist_build(&scene->light_choice, power, scene->light_count);
    mem_free(power);
    for (int i = 0; good && i < scene->light_count; i++) {
        struct light *light = &scene->lights[i];
        light->pick = dist_pdf(&scene->light_choice, i);
        if (!(light->pick > 0.0))
            log_note(&scene->desc->log, NULL,
                     "a light with less than 2^-53 of all power is never sampled");
        light->pdf_point = light->shape < 0 ? light->pick : light->pick / light->area;
        if (light->shape >= 0)
            good = scene_build_triangles(scene, light);
    }
    return good || err_set(err, ERR_VALUE, NULL, "%s: the lights' power overflows",
                           scene->desc->path);
}

/* Environments keep the texels in their own order. */
static void scene_release_maps(struct scene_desc *desc)
{
    for (size_t i = 0; i < desc->light_count; i++)
        if (desc->lights[i].map)
            texture_set_release(&desc->textures, desc->lights[i].map);
}

static bool scene_build_lights(struct scene *scene, struct err *err)
{
    const struct scene_desc *desc = scene->desc;
    double max = scene_emission_max(desc);
    if (!limits_check_emission(scene, max, err))
        return false;
    scene->emission_scale = scene_emission_scale(max);
    scene->lights = mem_alloc(desc->shape_count + desc->light_count + 1,
                              sizeof *scene->lights);
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].emits)
            scene_add_area_light(scene, i);
    struct light_sphere sphere = scene_sphere(scene);
    for (size_t i = 0; i < desc->light_count; i++)
        if (!scene_add_light_source(scene, &desc->lights[i], &sphere, err))
            return false;
    scene_release_maps(scene->desc);
    return scene_build_choice(scene, err);
}

static bool scene_build_parts(struct scene *scene, const struct scene_options *options,
                              struct err *err)
{
    const struct scene_desc *desc = scene->desc;
    bool own_size = options->width > 0 && options->height > 0;
    int width = own_size ? options->width : desc->width;
    int height = own_size ? options->height : desc->height;
    emission_split(scene->desc);
    if (!placement_resolve(scene, options, err) || !scene_check_desc(desc, err) ||
        !camera_build(&desc->camera, width, height, &scene->camera, err) ||
        !limits_check_places(scene, err) || !limits_check_camera(scene, err) ||
        !scene_build_shapes(scene, options->threads, err))
        return false;
    placement_bound(scene);
    if (!limits_check_size(scene, err) || !scene_build_lights(scene, err))
        return false;
    scene->needs = needs_compute(scene, options->keep_all);
    scene->load_peak = machine_memory_peak();
    scene->accel = accel_build(scene, options->compact, options->threads, err);
    if (!scene->accel)
        return false;
    accel_bounds(scene->accel, &scene->bounds_min, &scene->bounds_max);
    limits_note_shapes(scene);
    limits_note_lamps(scene);
    return true;
}

struct scene *scene_build(struct scene_desc *desc, const struct scene_options *options,
                          struct err *err)
{
    double start = clock_wall();
    struct scene *scene = mem_alloc(1, sizeof *scene);
    scene->desc = desc;
    scene->max_depth = desc->max_depth;
    scene->hide_emitters = desc->hide_emitters;
    scene->edges_cut = mem_alloc(1, sizeof *scene->edges_cut);
    if (!scene_build_parts(scene, options, err)) {
        scene_destroy(scene);
        return NULL;
    }
    scene->load_seconds = clock_wall() - start;
    return scene;
}

void scene_destroy(struct scene *scene)
{
    if (!scene)
        return;
    accel_destroy(scene->accel);
    for (int i = 0; i < scene->light_count; i++) {
        dist_deinit(&scene->lights[i].triangles);
        environment_deinit(&scene->lights[i].environment);
    }
    mem_free(scene->lights);
    dist_deinit(&scene->light_choice);
    for (size_t i = 0; scene->shapes && i < scene->desc->shape_count; i++)
        shape_deinit(&scene->shapes[i]);
    mem_free(scene->shapes);
    mem_free(scene->records);
    mem_free(scene->objects);
    mem_free(scene->instances);
    mem_free(scene->edges_cut);
    scene_desc_destroy(scene->desc);
    mem_free(scene);
}
