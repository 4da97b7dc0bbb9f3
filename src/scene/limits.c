#include "scene/limits.h"

#define LIMITS_DIRECTION 0x1p-24 /* how far components of one are off */

static bool check_place(const char *what, double reach, const struct place *at,
                        struct err *err)
{
    if (reach <= LIMITS_LARGEST)
        return true;
    return err_set(err, ERR_VALUE, at,
                   "%s lies %.3g units from the origin; rays in floats work up to %.1g: "
                   "scale the scene",
                   what, reach, LIMITS_LARGEST);
}

static double reach(const struct xform *to_world)
{
    return fmax(fabs(to_world->m[0][3]),
                fmax(fabs(to_world->m[1][3]), fabs(to_world->m[2][3])));
}

bool limits_check_places(const struct scene *scene, struct err *err)
{
    const struct scene_desc *desc = scene->desc;
    const struct camera_desc *camera = &desc->camera;
    if (!check_place("the camera", reach(&camera->to_world) + camera->lens_radius,
                     &camera->place, err))
        return false;
    for (size_t i = 0; i < desc->light_count; i++)
        if (!check_place("a light", reach(&desc->lights[i].to_world),
                         &desc->lights[i].place, err))
            return false;
    return true;
}

/* The rays of an orthographic camera start on its film, at places in floats. */
static bool limits_check_film(const struct scene *scene, double pixel, struct err *err)
{
    const struct camera *camera = &scene->camera;
    double far = reach(&scene->desc->camera.to_world) + fabs(camera->x0) +
                 fabs(camera->y0) + camera->dx - camera->dy;
    double off = LIMITS_DIRECTION * far / pixel;
    if (off > 0.25)
        log_note(&scene->desc->log, &scene->desc->camera.place,
                 "the camera's rays, which start at places in floats, are off by up to "
                 "%.2g of a pixel",
                 off);
    return off <= 1.0 ||
           err_set(
               err, ERR_VALUE, &scene->desc->camera.place,
               "the camera's rays, which start at places in floats, miss their pixels "
               "by up to %.3g of their width: take a larger extent or fewer pixels",
               off);
}

/* Each component of a direction is off by up to 2^-24: on a plane at distance 1 a ray
 * ends that far off; from the edge of a lens as wide as a, which sees the plane of focus
 * at an angle, 1 + a^2 times as far. */
bool limits_check_camera(const struct scene *scene, struct err *err)
{
    const struct camera *camera = &scene->camera;
    const struct place *at = &scene->desc->camera.place;
    double pixel = fmin(camera->dx / camera->width, -camera->dy / camera->height);
    if (camera->orthographic)
        return limits_check_film(scene, pixel, err);
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

struct extent {
    double reach, size;
};

static void add_box(struct extent *extent, const float lower[3], const float upper[3],
                    bool in_world)
{
    for (int k = 0; k < 3 && lower[0] <= upper[0]; k++) {
        double low = (double)lower[k], high = (double)upper[k];
        extent->reach = fmax(extent->reach, fmax(fabs(low), fabs(high)));
        if (in_world)
            extent->size = fmax(extent->size, high - low);
    }
}

/* In an object's space rays must work too. */
bool limits_check_size(const struct scene *scene, struct err *err)
{
    float lower[3], upper[3];
    struct extent extent = {0};
    if (scene->desc->shape_count == 0)
        return true;
    for (size_t i = 0; i < scene->desc->shape_count; i++) {
        shape_bounds(&scene->shapes[i], scene->desc->shapes[i].mesh, lower, upper);
        add_box(&extent, lower, upper, i < scene->objects[0].shape_count);
    }
    for (size_t i = 0; i < scene->instance_count; i++)
        add_box(&extent, scene->instances[i].lower, scene->instances[i].upper, true);
    double size = extent.size, reach = extent.reach;
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
