#include "math/warp.h"
#include "scene/light.h"
#include "scene/scene_desc.h"

/* Parallel light from infinity: radiance is irradiance across the beam (W/m^2), and its
 * direction is a delta, so that no path can meet it by chance. */

static bool light_distant_build(const struct light_desc *desc, struct light *light,
                                struct err *err)
{
    struct vec3 axis = xform_vector(&desc->to_world, vec3(0.0f, 0.0f, 1.0f));
    if (!(vec3_dot(axis, axis) > 0.0f) || !isfinite(vec3_dot(axis, axis)))
        return err_set(err, ERR_VALUE, &desc->place, "a distant light of no direction");
    light->infinite = light->delta_position = true;
    light->axis = vec3_normalize(axis);
    /* Irradiance times the area of the disk [Pharr16, section 12.4]. */
    light->power = rgb_luminance(light->radiance) / light_enter_pdf(light);
    return true;
}

static uint32_t light_distant_sample_point(const struct scene *scene,
                                           const struct light *light, const double u[2],
                                           struct ray_endpoint *point)
{
    (void)scene, (void)u;
    *point = (struct ray_endpoint){.ng = light->axis};
    return 0;
}

static bool light_distant_sample_direction(const struct light *light,
                                           struct ray_endpoint *point, const double u[2],
                                           struct vec3 *w, double *pdf,
                                           struct rgb *weight)
{
    light_enter(light, point, u, w, pdf);
    /* [Pharr16, section 16.1.2] */
    *weight = rgb_scale(light->radiance, 1.0 / *pdf);
    return true;
}

static double light_distant_pdf_direction(const struct light *light,
                                          const struct ray_endpoint *point, struct vec3 w)
{
    (void)point, (void)w;
    return light_enter_pdf(light);
}

const struct light_type light_distant = {
    .name = "distant",
    .build = light_distant_build,
    .sample_point = light_distant_sample_point,
    .sample_direction = light_distant_sample_direction,
    .pdf_direction = light_distant_pdf_direction,
    .invert_point = light_invert_no_point,
    .invert_direction = light_enter_invert,
};
