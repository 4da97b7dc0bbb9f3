#include "math/frame.h"
#include "math/warp.h"
#include "scene/emission.h"
#include "scene/scene.h"
#include "scene/triangle.h"

/* Radiance from every point of a shape, the same or by a texture, into the hemisphere of
 * its normal or into both. Points are uniform in area, directions follow the cosine. */

static int light_area_triangle(const struct light *light, double u, double *rest)
{
    const struct dist *dist = &light->triangles;
    if (dist->count == 1) {
        *rest = u;
        return 0;
    }
    double probability;
    return dist_sample(dist, u, &probability, rest);
}

static uint32_t light_area_sample_point(const struct scene *scene,
                                        const struct light *light, const double u[2],
                                        struct ray_endpoint *point)
{
    const struct shape *shape = &scene->shapes[light->shape];
    if (shape->quadric) {
        *point = quadric_sample(shape->quadric, u);
        return 0;
    }
    double v[2] = {0.0, u[1]};
    uint32_t triangle = (uint32_t)light_area_triangle(light, u[0], &v[0]);
    struct vec2 b = warp_triangle(v);
    /* Loaded in place: copying what was just written float by float would stall. */
    struct triangle t = triangle_load(&shape->triangles, triangle);
    struct vec3 normal;
    *point = triangle_place(&shape->triangles, triangle, &t, (float)b.x, (float)b.y,
                            &normal);
    return triangle;
}

static bool light_area_invert_point(const struct scene *scene, const struct light *light,
                                    const struct hit *point, double u[2])
{
    const struct shape *shape = &scene->shapes[light->shape];
    if (shape->quadric)
        return quadric_invert(shape->quadric, point->at.p, u);
    struct vec2 b = triangle_weights(&shape->triangles, point->triangle, point->at.p);
    warp_triangle_inverse(b, u);
    const struct dist *dist = &light->triangles;
    bool chosen = dist->count == 1 ||
                  dist_invert(dist, (int)point->triangle, u[0], &u[0]);
    return chosen && warp_in_square(u);
}

static double light_area_cos(const struct light *light, const struct ray_endpoint *point,
                             struct vec3 w)
{
    double cos = (double)vec3_dot(point->ng, w);
    return light->two_sided ? fabs(cos) : cos;
}

static bool light_area_sample_direction(const struct light *light,
                                        struct ray_endpoint *point, const double u[2],
                                        struct vec3 *w, double *pdf, struct rgb *weight)
{
    double v[2] = {u[0], u[1]};
    struct vec3 n = point->ng;
    double sides = 1.0;
    if (light->two_sided) {
        sides = 2.0;
        bool back = v[0] >= 0.5;
        v[0] = 2.0 * v[0] - (back ? 1.0 : 0.0);
        n = back ? vec3_neg(n) : n;
    }
    struct vec3 local = warp_cosine(v);
    if (!(local.z > 0.0f))
        return false;
    struct frame frame = frame_from_normal(n);
    *w = frame_to_world(&frame, local);
    *pdf = warp_cosine_pdf(local.z) /
           sides; /* L cos / pdf = pi L [Pharr16, section 16.1.2] */
    *weight = rgb_scale(light->radiance, MATH_PI * sides);
    return true;
}

static bool light_area_invert_direction(const struct light *light,
                                        const struct ray_endpoint *point, struct vec3 w,
                                        struct vec3 through, double u[2])
{
    struct vec3 n = point->ng;
    bool back = vec3_dot(n, w) < 0.0f;
    (void)through;
    if (back)
        n = vec3_neg(n);
    struct frame frame = frame_from_normal(n);
    warp_cosine_inverse(frame_to_local(&frame, w), u);
    if (light->two_sided)
        u[0] = back ? warp_within(0.5, 1.0, u[0]) : warp_within(0.0, 0.5, u[0]);
    return (!back || light->two_sided) && warp_in_square(u);
}

static double light_area_pdf_direction(const struct light *light,
                                       const struct ray_endpoint *point, struct vec3 w)
{
    double cos = light_area_cos(light, point, w);
    if (!(cos > 0.0))
        return 0.0;
    /* cos / pi, over the number of sides [Pharr16, section 13.6.3]. */
    return cos / (light->two_sided ? 2.0 * MATH_PI : MATH_PI);
}

/* With a texture: a factor at each point. */
static struct rgb light_textured_emission(const struct light *light,
                                          const struct ray_endpoint *point, struct vec3 w)
{
    if (!(light_area_cos(light, point, w) > 0.0))
        return rgb_grey(0.0);
    return rgb_mul(light->radiance, emission_value(light, point));
}

static bool light_textured_sample_direction(const struct light *light,
                                            struct ray_endpoint *point, const double u[2],
                                            struct vec3 *w, double *pdf,
                                            struct rgb *weight)
{
    if (!light_area_sample_direction(light, point, u, w, pdf, weight))
        return false;
    *weight = rgb_mul(*weight, emission_value(light, point));
    return !rgb_is_black(*weight);
}

const struct light_type light_area_textured = {
    .name = "area (textured)",
    .sample_point = light_area_sample_point,
    .emission = light_textured_emission,
    .sample_direction = light_textured_sample_direction,
    .pdf_direction = light_area_pdf_direction,
    .invert_point = light_area_invert_point,
    .invert_direction = light_area_invert_direction,
};

const struct light_type light_area = {
    .name = "area",
    .sample_point = light_area_sample_point,
    .sample_direction = light_area_sample_direction,
    .pdf_direction = light_area_pdf_direction,
    .invert_point = light_area_invert_point,
    .invert_direction = light_area_invert_direction,
};
