#include "scene/camera.h"

#include "math/warp.h"

#include <stddef.h>

/* Half the film along fov_axis: on the plane at distance 1, or of an orthographic one. */
static double camera_half(const struct camera_desc *desc)
{
    return desc->extent > 0.0 ? 0.5 * desc->extent
                              : tan(0.5 * desc->fov * MATH_PI / 180.0);
}

static void camera_extent(const struct camera_desc *desc, double aspect, double *half_x,
                          double *half_y)
{
    double t = camera_half(desc);
    bool wide = aspect > 1.0;
    bool fixes_x = desc->fov_axis == FOV_X || (desc->fov_axis == FOV_SMALLER && !wide) ||
                   (desc->fov_axis == FOV_LARGER && wide);
    if (desc->fov_axis == FOV_DIAGONAL) {
        *half_y = t / sqrt(1.0 + aspect * aspect);
        *half_x = *half_y * aspect;
    } else if (fixes_x) {
        *half_x = t;
        *half_y = t / aspect;
    } else {
        *half_x = t * aspect;
        *half_y = t;
    }
}

/* An orthographic camera without a lens may be stretched: its film is. */
static bool camera_check_transform(const struct camera_desc *desc, double scale[3],
                                   struct err *err)
{
    double same;
    bool similar = xform_is_similarity(&desc->to_world, &same);
    scale[0] = scale[1] = scale[2] = same;
    bool stretched = desc->extent > 0.0 && !(desc->lens_radius > 0.0) &&
                     xform_is_stretch(&desc->to_world, scale);
    if ((similar || stretched) && scale[0] > 0.0 && scale[1] > 0.0 && scale[2] > 0.0)
        return true;
    return err_set(
        err, ERR_VALUE, &desc->place,
        "the camera's transform must be finite and free of shear%s",
        desc->extent > 0.0 && !(desc->lens_radius > 0.0) ? "" : " and uneven scale");
}

static bool camera_check(const struct camera_desc *desc, int width, int height,
                         struct err *err)
{
    if (desc->fov == 0.0 && desc->extent == 0.0)
        return err_set(err, ERR_VALUE, &desc->place, "the scene has no camera");
    if (width <= 0 || height <= 0)
        return err_set(err, ERR_VALUE, &desc->place,
                       "the film is %d x %d pixels; both must be positive", width,
                       height);
    if ((int64_t)width * height > INT32_MAX / 4)
        return err_set(err, ERR_VALUE, &desc->place,
                       "the film of %d x %d pixels is too large", width, height);
    if (!(desc->extent >= 0.0 && isfinite(desc->extent)))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the orthographic camera's extent is %g; it must be positive",
                       desc->extent);
    if (desc->extent == 0.0 && !(desc->fov > 0.0 && desc->fov < 180.0))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the camera's field of view is %g degrees; it must lie strictly "
                       "between 0 and 180",
                       desc->fov);
    if (!(desc->lens_radius >= 0.0) || !isfinite(desc->lens_radius))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the lens radius is %g; it must be finite and not negative",
                       desc->lens_radius);
    if (desc->lens_radius > 0.0 &&
        !(desc->focus_distance > 0.0 && isfinite(desc->focus_distance)))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the focus distance is %g; it must be finite and positive",
                       desc->focus_distance);
    return true;
}

static struct vec3 camera_axis(const struct xform *to_world, int column)
{
    double x = to_world->m[0][column], y = to_world->m[1][column],
           z = to_world->m[2][column];
    double k = 1.0 / sqrt(x * x + y * y + z * z);
    return vec3((float)(x * k), (float)(y * k), (float)(z * k));
}

/* First pixel at or after a crop fraction, as pbrt rounds. */
static int camera_crop_pixel(double fraction, int count)
{
    return (int)ceil(fraction * count);
}

static bool camera_crop(const struct camera_desc *desc, int width, int height,
                        struct camera *camera, struct err *err)
{
    const double whole[4] = {0.0, 1.0, 0.0, 1.0};
    const double *crop = desc->crop;
    if (crop[0] == 0.0 && crop[1] == 0.0 && crop[2] == 0.0 && crop[3] == 0.0)
        crop = whole;
    if (!(crop[0] >= 0.0 && crop[1] <= 1.0 && crop[2] >= 0.0 && crop[3] <= 1.0))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the crop window %g %g %g %g must lie within 0 and 1", crop[0],
                       crop[1], crop[2], crop[3]);
    int x0 = camera_crop_pixel(crop[0], width), x1 = camera_crop_pixel(crop[1], width);
    int y0 = camera_crop_pixel(crop[2], height), y1 = camera_crop_pixel(crop[3], height);
    if (x1 <= x0 || y1 <= y0)
        return err_set(err, ERR_VALUE, &desc->place,
                       "the crop window %g %g %g %g holds no pixel", crop[0], crop[1],
                       crop[2], crop[3]);
    camera->width = x1 - x0;
    camera->height = y1 - y0;
    camera->crop_x = x0;
    camera->crop_y = y0;
    camera->whole_width = width;
    camera->whole_height = height;
    camera->x0 += camera->dx * x0 / width;
    camera->y0 += camera->dy * y0 / height;
    camera->dx *= (double)camera->width / width;
    camera->dy *= (double)camera->height / height;
    return true;
}

bool camera_build(const struct camera_desc *desc, int width, int height,
                  struct camera *camera, struct err *err)
{
    double scale[3];
    if (!camera_check(desc, width, height, err) ||
        !camera_check_transform(desc, scale, err))
        return false;
    double half_x, half_y;
    camera_extent(desc, (double)width / height, &half_x, &half_y);
    double window[4] = {-half_x, half_x, -half_y, half_y};
    if (desc->has_window)
        for (int i = 0; i < 4; i++)
            window[i] = desc->window[i] * camera_half(desc);
    for (int i = 0; i < 4 && desc->extent > 0.0; i++)
        window[i] *= scale[i / 2];
    const double(*m)[4] = desc->to_world.m;
    *camera = (struct camera){.axes = {camera_axis(&desc->to_world, 0),
                                       camera_axis(&desc->to_world, 1),
                                       camera_axis(&desc->to_world, 2)},
                              .origin = {(float)m[0][3], (float)m[1][3], (float)m[2][3]},
                              .orthographic = desc->extent > 0.0,
                              .x0 = window[0],
                              .y0 = window[3],
                              .dx = window[1] - window[0],
                              .dy = window[2] - window[3],
                              .lens_radius = desc->lens_radius,
                              .focus_distance = desc->focus_distance};
    if (!(camera->dx > 0.0 && camera->dy < 0.0) || !isfinite(camera->dx * camera->dy))
        return err_set(err, ERR_VALUE, NULL,
                       "the screen window %g %g %g %g is empty (order: x0 x1 y0 y1)",
                       desc->window[0], desc->window[1], desc->window[2],
                       desc->window[3]);
    if (!camera_crop(desc, width, height, camera, err))
        return false;
    camera->area = fabs(camera->dx * camera->dy);
    return isnormal(camera->area) ||
           (desc->extent > 0.0
                ? err_set(err, ERR_VALUE, &desc->place,
                          "an extent of %g is too narrow for numbers", desc->extent)
                : err_set(err, ERR_VALUE, &desc->place,
                          "a field of view of %g degrees is too narrow for numbers",
                          desc->fov));
}

struct ray_endpoint camera_sample_lens(const struct camera *camera, const double u[2])
{
    struct ray_endpoint lens = {.p = camera->origin};
    if (camera->lens_radius > 0.0) {
        struct vec2 d = warp_disk(u);
        lens.p = vec3_mad(lens.p, (float)(camera->lens_radius * d.x), camera->axes.s);
        lens.p = vec3_mad(lens.p, (float)(camera->lens_radius * d.y), camera->axes.t);
    }
    return lens;
}

static double camera_dot(struct vec3 a, struct vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y +
           (double)a.z * (double)b.z;
}

/* The lens point in units of the focus distance: the shift by which a film position
 * appears displaced from it. Zero for the pinhole. */
static struct vec2 camera_lens_shift(const struct camera *camera,
                                     const struct ray_endpoint *lens)
{
    if (!(camera->lens_radius > 0.0))
        return (struct vec2){0.0, 0.0};
    struct vec3 d = vec3_sub(lens->p, camera->origin);
    return (struct vec2){camera_dot(d, camera->axes.s) / camera->focus_distance,
                         camera_dot(d, camera->axes.t) / camera->focus_distance};
}

/* A film position is uniform over the film's area A on the plane at distance 1. Seen from
 * a lens point, the same holds for the focus plane (area A f^2 at distance f), so that
 * both cameras have [Pharr16, section 16.1.1] the density f^2 / (cos^3 A f^2) = 1 / (A
 * cos^3). */
static double camera_density(const struct camera *camera, double cos)
{
    /* [Pharr16, section 16.1.1] */
    return 1.0 / (camera->area * cos * cos * cos);
}

static int32_t camera_pixel(const struct camera *camera, double u, double v)
{
    int x = (int)(u * camera->width), y = (int)(v * camera->height);
    x = x < camera->width ? x : camera->width - 1;
    y = y < camera->height ? y : camera->height - 1;
    return (int32_t)y * camera->width + x;
}

struct vec3 camera_parallel(const struct camera *camera, const struct ray_endpoint *lens)
{
    struct vec2 shift = camera_lens_shift(camera, lens);
    double cos = 1.0 / sqrt(shift.x * shift.x + shift.y * shift.y + 1.0);
    struct vec3 local = {(float)(-shift.x * cos), (float)(-shift.y * cos), (float)cos};
    return frame_to_world(&camera->axes, local);
}

bool camera_meet(const struct camera *camera, struct vec3 w, struct vec3 p,
                 struct ray_endpoint *lens)
{
    double distance = camera_dot(vec3_sub(p, camera->origin), camera->axes.n) /
                      camera_dot(w, camera->axes.n);
    *lens = (struct ray_endpoint){.p = {(float)((double)p.x - distance * (double)w.x),
                                        (float)((double)p.y - distance * (double)w.y),
                                        (float)((double)p.z - distance * (double)w.z)}};
    return distance > 0.0;
}

/* The density per area across the rays of a film of which each part is as likely. */
static double camera_density_parallel(const struct camera *camera, double cos)
{
    return 1.0 / (camera->area * cos);
}

static int32_t camera_sample_parallel(const struct camera *camera,
                                      struct ray_endpoint *lens, const double u[2],
                                      struct vec3 *w, double *pdf)
{
    *w = camera_parallel(camera, lens);
    *pdf = camera_density_parallel(camera, camera_dot(*w, camera->axes.n));
    lens->p = vec3_mad(lens->p, (float)(camera->x0 + u[0] * camera->dx), camera->axes.s);
    lens->p = vec3_mad(lens->p, (float)(camera->y0 + u[1] * camera->dy), camera->axes.t);
    return camera_pixel(camera, u[0], u[1]);
}

int32_t camera_sample_direction(const struct camera *camera, struct ray_endpoint *lens,
                                const double u[2], struct vec3 *w, double *pdf)
{
    if (camera->orthographic)
        return camera_sample_parallel(camera, lens, u, w, pdf);
    struct vec2 shift = camera_lens_shift(camera, lens);
    double x = camera->x0 + u[0] * camera->dx - shift.x;
    double y = camera->y0 + u[1] * camera->dy - shift.y;
    double cos = 1.0 / sqrt(x * x + y * y + 1.0);
    struct vec3 local = {(float)(x * cos), (float)(y * cos), (float)cos};
    *w = frame_to_world(&camera->axes, local);
    *pdf = camera_density(camera, cos);
    return camera_pixel(camera, u[0], u[1]);
}

static bool camera_on_film(const struct camera *camera, double x, double y, double *u,
                           double *v)
{
    *u = (x - camera->x0) / camera->dx;
    *v = (y - camera->y0) / camera->dy;
    return *u >= 0.0 && *u < 1.0 && *v >= 0.0 && *v < 1.0;
}

/* Where a ray that starts at the lens meets the film's plane at distance 1. */
static void camera_film_plane(const struct camera *camera,
                              const struct ray_endpoint *lens, struct vec3 w, double z,
                              double *x, double *y)
{
    struct vec2 shift = camera_lens_shift(camera, lens);
    *x = camera_dot(w, camera->axes.s) / z + shift.x;
    *y = camera_dot(w, camera->axes.t) / z + shift.y;
}

/* Orthographic: a ray meets the plane of focus where it would meet the film without a
 * lens. */
static void camera_film_parallel(const struct camera *camera,
                                 const struct ray_endpoint *start, struct vec3 w,
                                 double z, double *x, double *y)
{
    struct vec3 from = vec3_sub(start->p, camera->origin);
    double focus = camera->lens_radius > 0.0 ? camera->focus_distance / z : 0.0;
    *x = camera_dot(from, camera->axes.s) + focus * camera_dot(w, camera->axes.s);
    *y = camera_dot(from, camera->axes.t) + focus * camera_dot(w, camera->axes.t);
}

int32_t camera_project(const struct camera *camera, const struct ray_endpoint *lens,
                       struct vec3 w, double *pdf, double *cos)
{
    double z = camera_dot(w, camera->axes.n), u[2];
    if (!camera_invert_direction(camera, lens, w, u))
        return -1;
    *cos = z;
    *pdf = camera->orthographic ? camera_density_parallel(camera, z)
                                : camera_density(camera, z);
    return camera_pixel(camera, u[0], u[1]);
}

bool camera_invert_direction(const struct camera *camera, const struct ray_endpoint *lens,
                             struct vec3 w, double u[2])
{
    double z = camera_dot(w, camera->axes.n), x, y;
    if (!(z > 0.0))
        return false;
    if (camera->orthographic)
        camera_film_parallel(camera, lens, w, z, &x, &y);
    else
        camera_film_plane(camera, lens, w, z, &x, &y);
    return camera_on_film(camera, x, y, &u[0], &u[1]);
}

bool camera_invert_lens(const struct camera *camera, const struct ray_endpoint *start,
                        struct vec3 w, double u[2])
{
    if (!(camera->lens_radius > 0.0))
        return true;
    double scale = camera->focus_distance / camera->lens_radius;
    struct vec2 shift = camera_lens_shift(camera, start);
    if (camera->orthographic) { /* camera_parallel */
        double z = camera_dot(w, camera->axes.n);
        shift = (struct vec2){-camera_dot(w, camera->axes.s) / z,
                              -camera_dot(w, camera->axes.t) / z};
    }
    warp_disk_inverse((struct vec2){scale * shift.x, scale * shift.y}, u);
    return warp_in_square(u);
}

/* Where the ray along w through a film position starts. */
static int32_t camera_sample_moved(const struct camera *camera, struct ray_endpoint *lens,
                                   const double film[2], struct vec3 w)
{
    double z = camera_dot(w, camera->axes.n);
    double focus = camera->lens_radius > 0.0 ? camera->focus_distance / z : 0.0;
    double x = camera->x0 + film[0] * camera->dx - focus * camera_dot(w, camera->axes.s);
    double y = camera->y0 + film[1] * camera->dy - focus * camera_dot(w, camera->axes.t);
    lens->p = vec3_mad(camera->origin, (float)x, camera->axes.s);
    lens->p = vec3_mad(lens->p, (float)y, camera->axes.t);
    return camera_pixel(camera, film[0], film[1]);
}

int32_t camera_move(const struct camera *camera, struct ray_endpoint *lens,
                    const double film[2], struct vec3 *w, double *pdf)
{
    if (!camera->orthographic)
        return camera_sample_direction(camera, lens, film, w, pdf);
    *pdf = camera_density_parallel(camera, camera_dot(*w, camera->axes.n));
    return camera_sample_moved(camera, lens, film, *w);
}
