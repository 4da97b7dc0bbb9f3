#include "math/warp.h"
#include "scene/light.h"

/* Uniform intensity (W/sr) in all directions from one place: a delta position, so that no
 * cosine enters and no path can hit it by chance. */

#define LIGHT_POINT_PDF (1.0 / (4.0 * MATH_PI))

static void light_point_sample_point(const struct scene *scene, const struct light *light,
                                     const double u[2], struct anchor *point)
{
    (void)scene;
    (void)u;
    *point = (struct anchor){.p = light->position};
}

static bool light_point_sample_direction(const struct light *light,
                                         const struct anchor *point, const double u[2],
                                         struct vec3 *w, double *pdf, struct rgb *weight)
{
    (void)point;
    *w = warp_sphere(u);
    *pdf = LIGHT_POINT_PDF;
    *weight = rgb_scale(light->radiance, 4.0 * MATH_PI);
    return true;
}

static double light_point_pdf_direction(const struct light *light,
                                        const struct anchor *point, struct vec3 w)
{
    (void)light;
    (void)point;
    (void)w;
    return LIGHT_POINT_PDF;
}

const struct light_type light_point = {
    .name = "point",
    .sample_point = light_point_sample_point,
    .sample_direction = light_point_sample_direction,
    .pdf_direction = light_point_pdf_direction,
};
