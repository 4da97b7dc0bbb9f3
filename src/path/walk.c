#include "path/walk.h"

#include "base/mem.h"
#include "path/walk_step.h"

static void subpaths_arrays(struct subpaths *paths, struct mem_plan *plan)
{
    size_t count = (size_t)paths->max_depth + 1;
    paths->camera = mem_take(plan, MEM_APART, 2 * count, sizeof *paths->camera);
    if (paths->scene->needs.uv)
        paths->nodes = mem_take(plan, 0, 2 * count, sizeof *paths->nodes);
    if (paths->scene->needs.straight)
        paths->passed = mem_take(plan, 0, 1, sizeof *paths->passed);
}

void subpaths_init(struct subpaths *paths, const struct scene *scene, int max_depth)
{
    *paths = (struct subpaths){
        .scene = scene,
        .max_depth = max_depth,
        .many_lights = scene->light_count > 1 || scene->needs.keep_all,
        .special = scene->needs.uv || scene->needs.environment ||
                   scene->needs.distant_lights || scene->camera.orthographic,
        .keep = scene->needs.keep_all ? BSDF_U_LOBE | BSDF_U_DIRECTION : 0,
    };
    subpaths_arrays(paths, &(struct mem_plan){.take = true});
    paths->light = paths->camera + max_depth + 1;
}

double subpaths_bytes(const struct scene *scene, int max_depth)
{
    struct mem_plan plan = {.take = false};
    subpaths_arrays(&(struct subpaths){.scene = scene, .max_depth = max_depth}, &plan);
    return plan.bytes;
}

void subpaths_deinit(struct subpaths *paths)
{
    mem_free(paths->camera);
    mem_free(paths->nodes);
    mem_free(paths->passed);
    mem_free(paths->roulette);
}

/* Extends the walk from vertex 0 and its first step d to at most max_vertices vertices;
 * the last of them must pass the filter. Returns the number of vertices. */
WALK_STEP int walk_steps(struct subpaths *paths, struct vertex *v, struct scatter_step d,
                         struct ustream *numbers, int first_place, enum transport mode,
                         bool passes, int max_vertices, enum hit_filter filter)
{
    int count = 1;
    while (count < max_vertices) {
        enum hit_filter this_filter = count + 1 == max_vertices ? filter : HIT_ANY;
        if (!trace_step(paths, &v[count - 1], &d, numbers, first_place + 3 * (count - 1),
                        mode, MIS_BIDIRECTIONAL, passes, this_filter, &v[count]))
            break;
        struct vertex *here = &v[count++];
        if (count == max_vertices || here->hit.bsdf->flags & BSDF_BLACK)
            break;
        double u[3];
        scatter_numbers(paths, numbers, first_place, count - 1, here, passes, u);
        if (!sample_step(paths, here, u, mode, MIS_BIDIRECTIONAL, passes, &d))
            break;
    }
    return count;
}

static int walk(struct subpaths *paths, struct vertex *v, struct scatter_step d,
                struct ustream *numbers, int first_place, enum transport mode,
                int max_vertices, enum hit_filter filter)
{
    return paths->passed ? walk_steps(paths, v, d, numbers, first_place, mode, true,
                                      max_vertices, filter)
                         : walk_steps(paths, v, d, numbers, first_place, mode, false,
                                      max_vertices, filter);
}

void walk_camera(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                 enum hit_filter filter)
{
    double u[2];
    dims_lens(numbers, paths->scene->needs.lens, u);
    sample_lens(paths, u);
    paths->camera_count = 1;
    paths->filtered_out = false;
    if (max_vertices < 2)
        return;
    dims_film(numbers, u);
    struct scatter_step d = sample_film(paths, u);
    paths->camera_count = walk(paths, paths->camera, d, numbers, DIMS_CAMERA_VERTEX,
                               TRANSPORT_RADIANCE, max_vertices, filter);
}

void walk_light(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                enum hit_filter filter)
{
    struct vertex *v = paths->light;
    paths->light_count = 0;
    paths->filtered_out = false;
    if (max_vertices < 2)
        return;
    double u[3];
    dims_light(numbers, DIMS_LIGHT_PICK, paths->many_lights, u);
    const struct light *light = light_sample(paths->scene, u[0], u + 1, &v->hit);
    const double *direction = ustream_take(numbers, DIMS_LIGHT_DIRECTION, 2);
    struct scatter_step d = {.connects = 1.0};
    struct rgb weight;
    if (!light->type->sample_direction(light, &v->hit.at, direction, &d.w, &d.pdf,
                                       &weight))
        return;
    v->kind = VERTEX_LIGHT;
    v->connectible = true;
    v->end_chance = 1.0;
    v->prev_connects = light->delta_position ? 0.0 : 1.0; /* whether s = 0 exists */
    v->delta_event = false;
    v->light = light;
    v->pdf_fwd = light_pdf_point(light, &v->hit.at);
    if (!(v->pdf_fwd > 0.0)) /* see connect_light */
        return;
    v->throughput = rgb_grey(1.0 / v->pdf_fwd);
    v->mis_tail = 0.0;
    v->event_pdf = d.pdf;
    v->event_pdf_rev = 0.0;
    d.throughput = rgb_scale(weight, 1.0 / v->pdf_fwd);
    d.cos = light->delta_position ? 1.0 : fabs((double)vec3_dot(v->hit.at.ng, d.w));
    d.tail_over_pdf = light->delta_position ? 0.0 : 1.0 / v->pdf_fwd;
    paths->light_count = walk(paths, v, d, numbers, DIMS_LIGHT_VERTEX,
                              TRANSPORT_IMPORTANCE, max_vertices, filter);
}
