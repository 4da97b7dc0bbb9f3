#include "math/warp.h"
#include "scene/light.h"
#include "scene/scene_desc.h"

/* Uniform intensity (W/sr) in all directions from one place: a delta position, so that no
 * cosine enters and no path can hit it by chance. */

#define LIGHT_POINT_PDF (1.0 / (4.0 * MATH_PI))

static uint32_t light_point_sample_point(const struct scene *scene,
                                         const struct light *light, const double u[2],
                                         struct ray_endpoint *point)
{
    (void)scene;
    (void)u;
    *point = (struct ray_endpoint){.p = light->position};
    return 0;
}

static bool light_point_sample_direction(const struct light *light,
                                         struct ray_endpoint *point, const double u[2],
                                         struct vec3 *w, double *pdf, struct rgb *weight)
{
    (void)point;
    /* [Pharr16, section 16.1.2] */
    *w = warp_sphere(u);
    *pdf = LIGHT_POINT_PDF;
    *weight = rgb_scale(light->radiance, 4.0 * MATH_PI);
    return true;
}

static bool light_point_invert_direction(const struct light *light,
                                         const struct ray_endpoint *point, struct vec3 w,
                                         struct vec3 through, double u[2])
{
    (void)light, (void)point, (void)through;
    warp_sphere_inverse(w, u);
    return warp_in_square(u);
}

static double light_point_pdf_direction(const struct light *light,
                                        const struct ray_endpoint *point, struct vec3 w)
{
    (void)light;
    (void)point;
    (void)w;
    return LIGHT_POINT_PDF;
}

static bool light_point_build(const struct light_desc *desc, struct light *light,
                              struct err *err)
{
    (void)err;
    const double(*m)[4] = desc->to_world.m;
    light->delta_position = true;
    light->position = vec3((float)m[0][3], (float)m[1][3], (float)m[2][3]);
    /* [Pharr16, section 12.3] */
    light->power = 4.0 * MATH_PI * rgb_luminance(light->radiance);
    return true;
}

const struct light_type light_point = {
    .name = "point",
    .build = light_point_build,
    .sample_point = light_point_sample_point,
    .sample_direction = light_point_sample_direction,
    .pdf_direction = light_point_pdf_direction,
    .invert_point = light_invert_no_point,
    .invert_direction = light_point_invert_direction,
};
