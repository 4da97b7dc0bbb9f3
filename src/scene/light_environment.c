#include "math/warp.h"
#include "scene/light.h"
#include "scene/scene_desc.h"

/* Radiance from infinity, from all sides: one constant, or a picture (scene/sky_map.h)
 * with a density of its own (scene/sky_density.h). */

/* The direction from which the light of point w comes, in the map's space. */
static void to_local(const struct environment *e, struct vec3 w, double d[3])
{
    double v[3] = {-(double)w.x, -(double)w.y, -(double)w.z};
    for (int i = 0; i < 3; i++)
        d[i] = e->to_local[i][0] * v[0] + e->to_local[i][1] * v[1] +
               e->to_local[i][2] * v[2];
}

static struct rgb light_environment_emission(const struct light *light,
                                             const struct ray_endpoint *point,
                                             struct vec3 w)
{
    (void)point;
    const struct environment *e = &light->environment;
    double d[3];
    if (!e->has_map)
        return light->radiance;
    to_local(e, w, d);
    return rgb_mul(sky_map_at(&e->map, d), light->radiance);
}

/* The inverse of to_world's linear part without its scale; false unless it is a rotation,
 * with or without a reflection. The scale by squares, exact for powers of two. */
static bool build_rotation(const struct xform *to_world, double to_local[3][3])
{
    const double(*m)[4] = to_world->m;
    double squares = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            squares += m[i][j] * m[i][j];
    double scale = sqrt(squares / 3.0);
    if (!(scale > 0.0) || !isfinite(scale))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to_local[i][j] = m[j][i] / scale;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++)
                dot += to_local[i][k] * to_local[j][k];
            if (fabs(dot - (i == j ? 1.0 : 0.0)) > 1e-3)
                return false;
        }
    return true;
}

static bool light_environment_build(const struct light_desc *desc, struct light *light,
                                    struct err *err)
{
    struct environment *e = &light->environment;
    light->infinite = true;
    if (!build_rotation(&desc->to_world, e->to_local))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the transform of an environment must be a rotation");
    double integral = 4.0 * MATH_PI * rgb_luminance(light->radiance);
    e->has_map = desc->map != NULL;
    if (e->has_map) {
        sky_map_build(&e->map, desc->map, desc->octahedral);
        integral = sky_density_build(&e->density, &e->map, light->radiance);
    }
    light->power = integral / light_enter_pdf(light);
    return true;
}

void environment_deinit(struct environment *e)
{
    sky_map_deinit(&e->map);
    dist_tree_deinit(&e->density);
}

size_t environment_bytes(const struct environment *e)
{
    return e->has_map ? sky_map_bytes(&e->map) + dist_tree_bytes(&e->density) : 0;
}

static uint32_t light_environment_sample_point(const struct scene *scene,
                                               const struct light *light,
                                               const double u[2],
                                               struct ray_endpoint *point)
{
    (void)scene;
    const struct environment *e = &light->environment;
    double d[3], w[3];
    if (!e->has_map) {
        *point = (struct ray_endpoint){.ng = vec3_neg(warp_sphere(u))};
        return 0;
    }
    sky_density_sample(&e->density, u, d);
    for (int i = 0; i < 3; i++)
        w[i] = e->to_local[0][i] * d[0] + e->to_local[1][i] * d[1] +
               e->to_local[2][i] * d[2];
    *point = (struct ray_endpoint){.ng = {(float)-w[0], (float)-w[1], (float)-w[2]}};
    return 0;
}

static bool light_environment_invert_point(const struct scene *scene,
                                           const struct light *light,
                                           const struct hit *point, double u[2])
{
    const struct environment *e = &light->environment;
    double d[3];
    (void)scene;
    if (!e->has_map) {
        warp_sphere_inverse(vec3_neg(point->at.ng), u);
        return warp_in_square(u);
    }
    to_local(e, point->at.ng, d);
    return sky_density_invert(&e->density, d, u);
}

static double light_environment_pdf_point(const struct light *light,
                                          const struct ray_endpoint *point)
{
    const struct environment *e = &light->environment;
    double d[3];
    if (!e->has_map)
        return 1.0 / (4.0 * MATH_PI);
    to_local(e, point->ng, d);
    return sky_density_pdf(&e->density, d);
}

static bool light_environment_sample_direction(const struct light *light,
                                               struct ray_endpoint *point,
                                               const double u[2], struct vec3 *w,
                                               double *pdf, struct rgb *weight)
{
    light_enter(light, point, u, w, pdf);
    *weight = rgb_scale(light_environment_emission(light, point, *w), 1.0 / *pdf);
    return !rgb_is_black(*weight);
}

static double light_environment_pdf_direction(const struct light *light,
                                              const struct ray_endpoint *point,
                                              struct vec3 w)
{
    (void)point, (void)w;
    return light_enter_pdf(light);
}

const struct light_type light_environment = {
    .name = "environment",
    .build = light_environment_build,
    .sample_point = light_environment_sample_point,
    .emission = light_environment_emission,
    .pdf_point = light_environment_pdf_point,
    .sample_direction = light_environment_sample_direction,
    .pdf_direction = light_environment_pdf_direction,
    .invert_point = light_environment_invert_point,
    .invert_direction = light_enter_invert,
};
