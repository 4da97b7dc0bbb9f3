/* Surfaces too near to each other for rays to tell them apart. */

#include "base/mem.h"
#include "scene/limits.h"

#include <stdio.h>
#include <stdlib.h>

/* Resolution of distances along rays, relative to the largest length involved: two
 * roundings of 2^-24, times two. */
#define LIMITS_RESOLUTION 0x1p-22
#define LIMITS_PROBES     32 /* points on each shape or lamp, evenly distributed: */
#define LIMITS_GOLDEN_U   0.7548776662466927
#define LIMITS_GOLDEN_V   0.5698402909980532

/* --- shapes upon each other ------------------------------------------------------- */

struct box {
    float side[6]; /* lower, upper */
    const struct place *place;
};

/* By all sides, so that equal boxes are neighbours. */
static int compare_boxes(const void *a, const void *b)
{
    const float *x = ((const struct box *)a)->side, *y = ((const struct box *)b)->side;
    for (int k = 0; k < 6; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static bool same_box(const struct box *a, const struct box *b, double distance)
{
    for (int k = 0; k < 6; k++)
        if (!(fabs((double)a->side[k] - (double)b->side[k]) <= distance))
            return false;
    return true;
}

/* Resolution of rays: the largest distance is the extent of the shapes and the camera. */
static double resolution(const struct scene *scene, const struct box *boxes, size_t count)
{
    struct vec3 eye = scene->camera.origin;
    double reach = (double)vec3_max_abs(eye);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 6; k++)
            reach = fmax(reach, fabs((double)boxes[i].side[k]));
    return LIMITS_RESOLUTION * reach;
}

static struct ray_endpoint surface_point(const struct shape *shape, const double u[2])
{
    if (shape->quadric)
        return quadric_sample(shape->quadric, u);
    double place = u[0] * shape->triangles.count, first = place - floor(place);
    float b1 = (float)(0.5 * first), b2 = (float)(0.5 * u[1]);
    return triangle_point(&shape->triangles, (uint32_t)place, b1, b2);
}

/* Whether a ray from `distance` above the point finds another shape that is parallel to
 * this one, near the point but not as near as an offset. */
static bool shadowed(const struct scene *scene, int id, const struct ray_endpoint *point,
                     struct vec3 away, double distance)
{
    struct ray_endpoint from = {.p = vec3_mad(point->p, (float)distance, away)};
    struct hit hit;
    if (!accel_intersect(scene, &from, vec3_neg(away), &hit) || hit.shape == id ||
        fabs((double)vec3_dot(hit.at.ng, away)) < 0.999)
        return false;
    double apart = fabs((double)vec3_dot(vec3_sub(hit.at.p, point->p), away));
    return apart > (double)(point->offset + hit.at.offset) && apart < distance;
}

/* Rays from afar hit either of two such surfaces, and rays from the one behind cannot
 * leave. */
static bool too_near(const struct scene *scene, int id, double distance)
{
    for (int i = 0; i < LIMITS_PROBES; i++) {
        double u[2] = {fmod(0.5 + i * LIMITS_GOLDEN_U, 1.0),
                       fmod(0.5 + i * LIMITS_GOLDEN_V, 1.0)};
        struct ray_endpoint point = surface_point(&scene->shapes[id], u);
        if (shadowed(scene, id, &point, point.ng, distance) ||
            shadowed(scene, id, &point, vec3_neg(point.ng), distance))
            return true;
    }
    return false;
}

static void note_near(const struct scene *scene, double distance)
{
    size_t count = scene->objects[0].shape_count;
    for (size_t i = 0; i < count; i++) {
        const struct shape *shape = &scene->shapes[i];
        const struct place *at = &scene->desc->shapes[i].place;
        if (i >= LIMITS_SHAPES)
            log_note(
                &scene->desc->log, at,
                "beyond the first %d shapes it was not looked at whether one lies too "
                "near to another surface",
                LIMITS_SHAPES);
        else if ((shape->quadric || shape->triangles.count > 0) &&
                 too_near(scene, (int)i, distance))
            log_note(&scene->desc->log, at,
                     "a surface lies within %.1g of another, less than rays can tell "
                     "apart: where the one behind is seen, it is too dark; move them "
                     "apart, or to the same place",
                     distance);
    }
}

/* Searches the sorted boxes after the first; *cut: some were not compared because of
 * LIMITS_NEIGHBOURS. */
static const struct box *find_same(const struct box *first, const struct box *end,
                                   double distance, bool *cut)
{
    double last = (double)first->side[0] + distance;
    *cut = false;
    for (const struct box *b = first + 1; b < end && (double)b->side[0] <= last; b++) {
        *cut = b - first > LIMITS_NEIGHBOURS;
        if (*cut || same_box(first, b, distance))
            return *cut ? NULL : b;
    }
    return NULL;
}

static void note_same(struct log *log, const struct box *boxes, size_t count,
                      double distance)
{
    for (size_t i = 0; i < count; i++) {
        bool cut;
        const struct box *same = find_same(&boxes[i], boxes + count, distance, &cut);
        if (same)
            log_note(log, same->place,
                     "two shapes fill the same box but for %.1g, less than rays can tell "
                     "apart: which of them is met is a matter of rounding",
                     distance);
        if (cut)
            log_note(log, boxes[i].place,
                     "a shape begins at the x of more than %d others: whether it fills "
                     "the same box as one of the rest was not looked at",
                     LIMITS_NEIGHBOURS);
    }
}

static void add_box(struct box *boxes, size_t *count, const float lower[3],
                    const float upper[3], const struct place *place)
{
    if (!(lower[0] <= upper[0]))
        return; /* there is nothing of it */
    struct box *box = &boxes[(*count)++];
    for (int k = 0; k < 3; k++) {
        box->side[k] = lower[k];
        box->side[k + 3] = upper[k];
    }
    box->place = place;
}

void limits_note_shapes(const struct scene *scene)
{
    struct scene_desc *desc = scene->desc;
    size_t count = 0, shapes = scene->objects[0].shape_count;
    struct box *boxes = mem_alloc(shapes + scene->instance_count + 1, sizeof *boxes);
    for (size_t i = 0; i < shapes; i++) {
        float lower[3], upper[3];
        shape_bounds(&scene->shapes[i], desc->shapes[i].mesh, lower, upper);
        add_box(boxes, &count, lower, upper, &desc->shapes[i].place);
    }
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        add_box(boxes, &count, instance->lower, instance->upper, instance->place);
    }
    qsort(boxes, count, sizeof *boxes, compare_boxes);
    double distance = resolution(scene, boxes, count);
    note_same(&desc->log, boxes, count, distance);
    mem_free(boxes);
    note_near(scene, distance);
}

/* --- lamps ------------------------------------------------------------------------ */

/* A short segment through a point of a lamp, along its normal, and what else it crosses.
 */
struct probe {
    const struct scene *scene;
    const struct ray_endpoint *at;
    double reach; /* to either side */
    int lamp;     /* shapes */
    int other;    /* -1: none yet */
};

static bool crosses_quadric(const struct quadric *quadric, struct vec3 p, struct vec3 ng,
                            double reach)
{
    const float o[3] = {p.x, p.y, p.z}, d[3] = {ng.x, ng.y, ng.z};
    struct quadric_hit hit;
    return quadric_intersect(quadric, o, d, -reach, reach, &hit);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* (a x b) . n */
static double triple(const double a[3], const double b[3], const double n[3])
{
    return (a[1] * b[2] - a[2] * b[1]) * n[0] + (a[2] * b[0] - a[0] * b[2]) * n[1] +
           (a[0] * b[1] - a[1] * b[0]) * n[2];
}

/* In double, as the segment is only some float roundings long. */
static bool crosses_triangle(const struct triangles *mesh, uint32_t triangle,
                             struct vec3 p, struct vec3 ng, double reach)
{
    double e1[3], e2[3], n[3];
    const float *corner = mesh->p + 3 * (size_t)mesh->index[3 * (size_t)triangle];
    const double d[3] = {(double)ng.x, (double)ng.y, (double)ng.z};
    double q[3] = {(double)p.x - (double)corner[0], (double)p.y - (double)corner[1],
                   (double)p.z - (double)corner[2]};
    triangle_cross(mesh, triangle, e1, e2, n);
    double t = -dot(n, q) / dot(n, d);
    if (!(fabs(t) <= reach))
        return false;
    for (int k = 0; k < 3; k++)
        q[k] += t * d[k];
    double b1 = triple(q, e2, n), b2 = triple(e1, q, n);
    return b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= dot(n, n);
}

static bool find_other(void *self, const struct instance *instance, int shape,
                       uint32_t triangle)
{
    struct probe *probe = self;
    const struct shape *of = &probe->scene->shapes[shape];
    struct vec3 p = probe->at->p, ng = probe->at->ng;
    if (instance) { /* distances along the ray stay */
        p = instance_point_inside(instance, p);
        ng = instance_vector_inside(instance, ng);
    }
    if (shape != probe->lamp &&
        (of->quadric ? crosses_quadric(of->quadric, p, ng, probe->reach)
                     : crosses_triangle(&of->triangles, triangle, p, ng, probe->reach)))
        probe->other = shape;
    return probe->other < 0;
}

/* The shape that a lamp lies on, or -1. Not found by rays: of coincident surfaces each
 * ray hits the same one, and a lamp that is always hit hides the other. */
static int lies_upon(const struct scene *scene, const struct light *light)
{
    double size = 4.0 * LIMITS_RESOLUTION * sqrt(light->area);
    struct probe probe = {.scene = scene, .lamp = light->shape, .other = -1};
    for (int i = 0; i < LIMITS_PROBES && probe.other < 0; i++) {
        double u[2] = {fmod(0.5 + i * LIMITS_GOLDEN_U, 1.0),
                       fmod(0.5 + i * LIMITS_GOLDEN_V, 1.0)};
        struct ray_endpoint point;
        light->type->sample_point(scene, light, u, &point);
        probe.at = &point;
        probe.reach = 4.0 * LIMITS_RESOLUTION *
                          (double)abs_components_dot(point.ng, point.p) +
                      size;
        accel_near(scene, point.p, (float)(2.0 * probe.reach), find_other, &probe);
    }
    return probe.other;
}

/* Notes the lamp. Rays cannot be forced to hit one of the two: a lamp just above a floor
 * lights it, the same lamp just below does not. */
static void note_lamp(struct scene_desc *desc, int lamp, int other)
{
    const struct place *at = &desc->shapes[other].place;
    char where[600] = "";
    if (at->file)
        snprintf(where, sizeof where, " (that of %s:%d:%d)", at->file, at->line, at->col);
    log_note(&desc->log, &desc->shapes[lamp].place,
             "a lamp lies upon another surface%s: which of them is seen, and whether the "
             "lamp lights it, is a matter of rounding; move the lamp off it",
             where);
}

void limits_note_lamps(const struct scene *scene)
{
    struct scene_desc *desc = scene->desc;
    int looked = 0, other;
    for (int i = 0; i < scene->light_count; i++) {
        const struct light *light = &scene->lights[i];
        if (light->shape < 0)
            continue;
        const struct place *at = &desc->shapes[light->shape].place;
        if (looked++ >= LIMITS_LAMPS)
            log_note(&desc->log, at,
                     "beyond the first %d lamps it was not looked at whether one lies "
                     "upon another surface",
                     LIMITS_LAMPS);
        else if ((other = lies_upon(scene, light)) >= 0)
            note_lamp(desc, light->shape, other);
    }
}
