#include "math/warp.h"
#include "scene/light.h"
#include "scene/scene_desc.h"

/* A point light behind a round mask: full intensity near the axis, nothing beyond the
 * outer angle, and a smooth edge: pbrt v3's (the fourth power of a line in the cosine),
 * v4's (a cubic of that line) or Mitsuba's (a line in the angle). Directions are uniform
 * in the cone. */

/* 1 - cos of the angle between w and the axis. In floats the cosine itself could not
 * resolve angles below 2e-4 rad; this has an error of 2^-24 rad, as w has. */
static double light_spot_versine(const struct light *light, struct vec3 w)
{
    return 0.5 * hit_square_distance(w, light->axis);
}

static struct rgb light_spot_emission(const struct light *light,
                                      const struct ray_endpoint *point, struct vec3 w)
{
    (void)point;
    double versine = light_spot_versine(light, w), t;
    if (!(versine < light->versine_outer))
        return rgb_grey(0.0);
    if (versine <= light->versine_inner)
        return light->radiance;
    if (light->linear)
        t = (light->outer - 2.0 * asin(sqrt(0.5 * versine))) /
            (light->outer - light->inner);
    else
        t = (light->versine_outer - versine) / /* [Pharr16, section 12.3.1] */
            (light->versine_outer - light->versine_inner);
    t = fmax(t, 0.0);
    double falls = light->linear   ? t
                   : light->smooth ? t * t * (3.0 - 2.0 * t)
                                   : t * t * t * t;
    return rgb_scale(light->radiance, falls);
}

static double light_spot_pdf(const struct light *light)
{
    /* Uniform cone [Pharr16, section 13.6.4]. */
    return 1.0 / (2.0 * MATH_PI * light->versine_outer);
}

static bool light_spot_build(const struct light_desc *desc, struct light *light,
                             struct err *err)
{
    const double(*m)[4] = desc->to_world.m;
    struct vec3 axis = xform_vector(&desc->to_world, vec3(0.0f, 0.0f, 1.0f));
    if (!(vec3_dot(axis, axis) > 0.0f) || !isfinite(vec3_dot(axis, axis)))
        return err_set(err, ERR_VALUE, &desc->place, "a spot of no direction");
    if (!(desc->outer >= 0.001 && desc->outer <= 180.0 && desc->inner >= 0.0 &&
          desc->inner <= desc->outer))
        return err_set(err, ERR_VALUE, &desc->place,
                       "a spot from %g to %g degrees: 0 <= inner <= outer <= 180 and "
                       "outer >= 0.001 are wanted",
                       desc->inner, desc->outer);
    light->delta_position = true;
    light->position = vec3((float)m[0][3], (float)m[1][3], (float)m[2][3]);
    light->axis = vec3_normalize(axis);
    light->inner = desc->inner * MATH_PI / 180.0;
    light->outer = desc->outer * MATH_PI / 180.0;
    light->versine_inner = 2.0 * sin(0.5 * light->inner) * sin(0.5 * light->inner);
    light->versine_outer = 2.0 * sin(0.5 * light->outer) * sin(0.5 * light->outer);
    light->linear = desc->linear;
    light->smooth = desc->smooth;
    /* Mean of the solid angles of both cones [Pharr16, section 12.3.1]. */
    light->power = rgb_luminance(light->radiance) * MATH_PI *
                   (light->versine_inner + light->versine_outer);
    return true;
}

static uint32_t light_spot_sample_point(const struct scene *scene,
                                        const struct light *light, const double u[2],
                                        struct ray_endpoint *point)
{
    (void)scene, (void)u;
    *point = (struct ray_endpoint){.p = light->position};
    return 0;
}

static bool light_spot_sample_direction(const struct light *light,
                                        struct ray_endpoint *point, const double u[2],
                                        struct vec3 *w, double *pdf, struct rgb *weight)
{
    /* Uniform cone [Pharr16, section 13.6.4]. */
    double versine = u[0] * light->versine_outer, phi = 2.0 * MATH_PI * u[1];
    double sine = sqrt(versine * (2.0 - versine)), cosine = 1.0 - versine;
    struct frame frame = frame_from_normal(light->axis);
    *w = frame_to_world(
        &frame, vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine));
    *pdf = light_spot_pdf(light);
    *weight = rgb_scale(light_spot_emission(light, point, *w), 1.0 / *pdf);
    return !rgb_is_black(*weight);
}

static bool light_spot_invert_direction(const struct light *light,
                                        const struct ray_endpoint *point, struct vec3 w,
                                        struct vec3 through, double u[2])
{
    struct frame frame = frame_from_normal(light->axis);
    struct vec3 local = frame_to_local(&frame, w);
    double turn = atan2((double)local.y, (double)local.x) / (2.0 * MATH_PI);
    (void)point, (void)through;
    u[0] = light_spot_versine(light, w) / light->versine_outer;
    u[1] = turn < 0.0 ? turn + 1.0 : turn;
    return warp_in_square(u);
}

static double light_spot_pdf_direction(const struct light *light,
                                       const struct ray_endpoint *point, struct vec3 w)
{
    (void)point;
    bool inside = light_spot_versine(light, w) < light->versine_outer;
    return inside ? light_spot_pdf(light) : 0.0;
}

const struct light_type light_spot = {
    .name = "spot",
    .build = light_spot_build,
    .sample_point = light_spot_sample_point,
    .emission = light_spot_emission,
    .sample_direction = light_spot_sample_direction,
    .pdf_direction = light_spot_pdf_direction,
    .invert_point = light_invert_no_point,
    .invert_direction = light_spot_invert_direction,
};
