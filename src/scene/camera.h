#ifndef ETALON_SCENE_CAMERA_H
#define ETALON_SCENE_CAMERA_H

/* Pinhole and thin lens, and orthographic. Camera space: +z forward, +x right, +y up in
 * the image. The importance is normalised over the whole film: a film position is uniform
 * over it.
 *
 * The rays of an orthographic camera that go through one point of its lens (the centre
 * without one) are parallel, and start all over the film, which is as large as what it
 * sees and lies at the camera's place. So a path meets the camera as it meets a light at
 * infinity (path/vertex.h): the end of the path is a lens point with a direction, and the
 * density of the next vertex is 1 / (A cos) per area across that direction. */

#include "base/err.h"
#include "math/xform.h"
#include "scene/hit.h"

#include <stdint.h>

enum fov_axis { FOV_SMALLER, FOV_LARGER, FOV_X, FOV_Y, FOV_DIAGONAL };

/* A camera as files describe it; the film's size is known only when it is built. */
struct camera_desc {
    struct xform
        to_world; /* must be a similarity; an orthographic one's may scale axes */
    double fov;   /* degrees, full angle along fov_axis */
    /* > 0: orthographic, without a fov; width of the film along fov_axis in the camera's
     * own units. */
    double extent;
    enum fov_axis fov_axis;
    bool has_window;    /* pbrt's screenwindow replaces the aspect rule */
    double window[4];   /* x0 x1 y0 y1 in units of tan(fov/2), or of extent/2 */
    double lens_radius; /* world units; 0 = pinhole */
    double focus_distance;
    double crop[4];     /* x0 x1 y0 y1 in [0,1] of the film; y from the top */
    struct place place; /* for messages */
};

struct camera {
    int width, height;                             /* of the (cropped) film, pixels */
    int crop_x, crop_y, whole_width, whole_height; /* its place on the whole film */
    struct frame axes; /* s right, t up, n forward; may be left-handed */
    struct vec3 origin;
    bool orthographic;
    /* Film's left top corner on the plane at distance 1; orthographic: from the origin,
     * world units. */
    double x0, y0;
    double dx, dy;      /* its extent (dy < 0: rows go down) */
    double area;        /* |dx dy| */
    double lens_radius; /* world units, 0 = pinhole */
    double focus_distance;
};

/* Errors name desc's place. */
bool camera_build(const struct camera_desc *desc, int width, int height,
                  struct camera *camera, struct err *err);

/* Point on the lens, uniform in area; the pinhole ignores u. */
struct ray_endpoint camera_sample_lens(const struct camera *camera, const double u[2]);

/* Direction from a lens point through film position u in [0,1)^2 (u[1] from the top);
 * *pdf per solid angle with respect to the whole film; returns the pixel. An orthographic
 * camera moves *lens to where the ray starts; its pdf is per area across *w. */
int32_t camera_sample_direction(const struct camera *camera, struct ray_endpoint *lens,
                                const double u[2], struct vec3 *w, double *pdf);

/* u with which camera_sample_direction sends w from the lens point (orthographic: from
 * where the ray starts). False if none does; u then is beyond the film, or, behind the
 * camera, unchanged. */
bool camera_invert_direction(const struct camera *camera, const struct ray_endpoint *lens,
                             struct vec3 w, double u[2]);

/* As camera_sample_direction through another film position: from the same point of the
 * lens, or, orthographic, along the same direction *w from wherever that ray starts. */
int32_t camera_move(const struct camera *camera, struct ray_endpoint *lens,
                    const double film[2], struct vec3 *w, double *pdf);

/* u with which camera_sample_lens gives the lens point of the ray from `start` along w; a
 * pinhole's stay. False if none does. */
bool camera_invert_lens(const struct camera *camera, const struct ray_endpoint *start,
                        struct vec3 w, double u[2]);

/* Orthographic: the direction of all rays through a lens point that has not moved; and
 * where such a ray to p starts. False if p is behind the camera. */
struct vec3 camera_parallel(const struct camera *camera, const struct ray_endpoint *lens);
bool camera_meet(const struct camera *camera, struct vec3 w, struct vec3 p,
                 struct ray_endpoint *lens);

/* Film position seen from a lens point (orthographic: where the ray starts) into
 * direction w. Returns the pixel, or -1 if outside; *pdf is the density per solid angle
 * camera_sample_direction would have, and the importance We / (lens density) = *pdf /
 * cos, with *cos to the optical axis. */
int32_t camera_project(const struct camera *camera, const struct ray_endpoint *lens,
                       struct vec3 w, double *pdf, double *cos);

#endif
