#include "scene/limits.h"

#include "base/mem.h"

#include <stdlib.h>

/* Distances along rays, in units of the largest length at hand, that floats tell apart:
 * two roundings of 2^-24, and twice that. */
#define LIMITS_RESOLUTION 0x1p-22
#define LIMITS_DIRECTION  0x1p-24 /* how far components of one are off */
#define LIMITS_NEIGHBOURS 64      /* shapes compared with each */
#define LIMITS_LAMPS      1024    /* lamps looked at */
#define LIMITS_PROBES     32      /* points on each, evenly spread: */
#define LIMITS_GOLDEN_U   0.7548776662466927
#define LIMITS_GOLDEN_V   0.5698402909980532

/* Each component of a direction is off by up to 2^-24: on a plane at distance 1 a ray
 * ends that far off; from the edge of a lens as wide as a, which sees the plane of focus
 * at an angle, 1 + a^2 times as far. */
bool limits_check_camera(const struct scene *scene, struct err *err)
{
    const struct camera *camera = &scene->camera;
    const struct place *at = &scene->desc->camera.place;
    double pixel = fmin(camera->dx / camera->width, -camera->dy / camera->height);
    double lens = camera->lens_radius > 0.0 ? camera->lens_radius / camera->focus_distance
                                            : 0.0;
    double off = LIMITS_DIRECTION * (1.0 + lens * lens) / pixel;
    if (!(off <= 1.0))
        return err_set(
            err, ERR_VALUE, at,
            "the camera's rays, whose directions are floats, miss their pixels "
            "by up to %.3g of their width: take a wider field of view, fewer "
            "pixels or a smaller lens",
            off);
    if (off > 0.25)
        log_note(
            &scene->desc->log, at,
            "the camera's rays, whose directions are floats, are off by up to %.2g of "
            "a pixel",
            off);
    return true;
}

bool limits_check_size(const struct scene *scene, struct err *err)
{
    float lower[3], upper[3];
    double reach = 0.0, size = 0.0;
    if (scene->desc->shape_count == 0)
        return true;
    for (size_t i = 0; i < scene->desc->shape_count; i++) {
        shape_bounds(&scene->shapes[i], scene->desc->shapes[i].mesh, lower, upper);
        for (int k = 0; k < 3 && lower[0] <= upper[0]; k++) {
            double low = (double)lower[k], high = (double)upper[k];
            reach = fmax(reach, fmax(fabs(low), fabs(high)));
            size = fmax(size, high - low);
        }
    }
    if (size >= LIMITS_SMALLEST && reach <= LIMITS_LARGEST)
        return true;
    return err_set(err, ERR_VALUE, NULL,
                   "%s: the largest shape spans %.3g units and coordinates reach %.3g; "
                   "rays in floats work from %.1g to %.1g: scale the scene",
                   scene->desc->path, size, reach, LIMITS_SMALLEST, LIMITS_LARGEST);
}

bool limits_check_emission(const struct scene *scene, double max, struct err *err)
{
    if (max == 0.0 || (max >= LIMITS_DIMMEST && max <= LIMITS_BRIGHTEST))
        return true;
    return err_set(err, ERR_VALUE, NULL,
                   "%s: the brightest light emits %.3g; pictures in floats hold %.1g to "
                   "%.1g: scale all emission",
                   scene->desc->path, max, LIMITS_DIMMEST, LIMITS_BRIGHTEST);
}

/* --- shapes upon each other ------------------------------------------------------- */

struct box {
    float side[6]; /* lower, upper */
    const struct place *place;
};

static int compare_boxes(const void *a, const void *b)
{
    float x = ((const struct box *)a)->side[0], y = ((const struct box *)b)->side[0];
    return x < y ? -1 : x > y;
}

static bool same_box(const struct box *a, const struct box *b, double distance)
{
    for (int k = 0; k < 6; k++)
        if (!(fabs((double)a->side[k] - (double)b->side[k]) <= distance))
            return false;
    return true;
}

/* How far a ray may come from: as far as the shapes reach, and the camera. */
static double resolution(const struct scene *scene, const struct box *boxes, size_t count)
{
    struct vec3 eye = scene->camera.origin;
    double reach = (double)vec3_max_abs(eye);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 6; k++)
            reach = fmax(reach, fabs((double)boxes[i].side[k]));
    return LIMITS_RESOLUTION * reach;
}

static struct anchor surface_point(const struct shape *shape, const double u[2])
{
    if (shape->quadric)
        return quadric_sample(shape->quadric, u);
    double place = u[0] * shape->triangle_count, first = place - floor(place);
    float b1 = (float)(0.5 * first), b2 = (float)(0.5 * u[1]);
    return shape_triangle_point(shape, (uint32_t)place, b1, b2);
}

/* Whether a ray from `distance` above the point finds another shape that is parallel to
 * this one, near the point but not as near as an offset. */
static bool shadowed(const struct scene *scene, int id, const struct anchor *point,
                     struct vec3 away, double distance)
{
    struct anchor from = {.p = vec3_mad(point->p, (float)distance, away)};
    struct hit hit;
    if (!accel_intersect(scene, &from, vec3_neg(away), &hit) || hit.shape == id ||
        fabs((double)vec3_dot(hit.at.ng, away)) < 0.999)
        return false;
    double apart = fabs((double)vec3_dot(vec3_sub(hit.at.p, point->p), away));
    return apart > (double)(point->offset + hit.at.offset) && apart < distance;
}

/* Rays from afar meet either of two such surfaces, and from the one behind no ray gets
 * out. */
static bool too_near(const struct scene *scene, int id, double distance)
{
    for (int i = 0; i < LIMITS_PROBES; i++) {
        double u[2] = {fmod(0.5 + i * LIMITS_GOLDEN_U, 1.0),
                       fmod(0.5 + i * LIMITS_GOLDEN_V, 1.0)};
        struct anchor point = surface_point(&scene->shapes[id], u);
        if (shadowed(scene, id, &point, point.ng, distance) ||
            shadowed(scene, id, &point, vec3_neg(point.ng), distance))
            return true;
    }
    return false;
}

static void note_near(const struct scene *scene, double distance)
{
    size_t count = scene->desc->shape_count;
    for (size_t i = 0; i < count && i < LIMITS_LAMPS; i++) {
        const struct shape *shape = &scene->shapes[i];
        if ((shape->quadric || shape->triangle_count > 0) &&
            too_near(scene, (int)i, distance))
            log_note(&scene->desc->log, &scene->desc->shapes[i].place,
                     "a surface lies within %.1g of another, less than rays can tell "
                     "apart: where the one behind is seen, it is too dark; move them "
                     "apart, or to the same place",
                     distance);
    }
}

void limits_note_shapes(const struct scene *scene)
{
    struct scene_desc *desc = scene->desc;
    size_t count = desc->shape_count;
    struct box *boxes = mem_alloc(count + 1, sizeof *boxes);
    for (size_t i = 0; i < count; i++) {
        shape_bounds(&scene->shapes[i], desc->shapes[i].mesh, boxes[i].side,
                     boxes[i].side + 3);
        boxes[i].place = &desc->shapes[i].place;
    }
    qsort(boxes, count, sizeof *boxes, compare_boxes);
    double distance = resolution(scene, boxes, count);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count && j <= i + LIMITS_NEIGHBOURS; j++) {
            if (!same_box(&boxes[i], &boxes[j], distance))
                continue;
            log_note(&desc->log, boxes[j].place,
                     "two shapes fill the same box but for %.1g, less than rays can tell "
                     "apart: which of them is met is a matter of rounding",
                     distance);
            break;
        }
    }
    mem_free(boxes);
    note_near(scene, distance);
}

/* --- lamps ------------------------------------------------------------------------ */

/* Whether a ray from `distance` off the point, on the side that `away` points to, finds
 * something else than the lamp at the point's place. */
static bool covered(const struct scene *scene, const struct light *light,
                    const struct anchor *point, struct vec3 away, double distance)
{
    struct anchor from = {.p = vec3_mad(point->p, (float)distance, away)};
    struct hit hit;
    if (!accel_intersect(scene, &from, vec3_neg(away), &hit) || hit.shape == light->shape)
        return false;
    return sqrt(hit_square_distance(hit.at.p, from.p)) <= 2.0 * distance;
}

static bool lamp_in_plane(const struct scene *scene, const struct light *light)
{
    double size = 4.0 * LIMITS_RESOLUTION * sqrt(light->area);
    for (int i = 0; i < LIMITS_PROBES; i++) {
        double u[2] = {fmod(0.5 + i * LIMITS_GOLDEN_U, 1.0),
                       fmod(0.5 + i * LIMITS_GOLDEN_V, 1.0)};
        struct anchor point;
        light->type->sample_point(scene, light, u, &point);
        double distance =
            4.0 * LIMITS_RESOLUTION * (double)anchor_reach(point.ng, point.p) + size;
        if (covered(scene, light, &point, point.ng, distance) ||
            covered(scene, light, &point, vec3_neg(point.ng), distance))
            return true;
    }
    return false;
}

void limits_note_lamps(const struct scene *scene)
{
    struct scene_desc *desc = scene->desc;
    for (int i = 0; i < scene->light_count && i < LIMITS_LAMPS; i++) {
        const struct light *light = &scene->lights[i];
        if (light->shape >= 0 && lamp_in_plane(scene, light))
            log_note(&desc->log, &desc->shapes[light->shape].place,
                     "a lamp lies upon another surface: which of them is seen is a "
                     "matter of rounding; move the lamp off it");
    }
}
