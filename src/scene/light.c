#include "scene/light.h"

#include "math/warp.h"
#include "scene/scene.h"

bool light_enter(const struct light *light, struct ray_endpoint *point, const double u[2],
                 struct vec3 *w, double *pdf)
{
    /* A point of the disk across the light's direction [Pharr16, section 16.1.2]. */
    struct frame frame = frame_from_normal(point->ng);
    struct vec2 disk = warp_disk(u);
    float r = (float)light->sphere.radius;
    struct vec3 local = {(float)disk.x * r, (float)disk.y * r, -r};
    point->p = vec3_add(light->sphere.centre, frame_to_world(&frame, local));
    *w = point->ng;
    *pdf = light_enter_pdf(light);
    return true;
}

const struct light *light_sample(const struct scene *scene, double u_pick,
                                 const double u[2], struct hit *point)
{
    int index = 0;
    if (scene->light_count > 1) {
        double probability;
        /* By power [Pharr16, section 16.1.2]. */
        index = dist_sample(&scene->light_choice, u_pick, &probability, NULL);
    }
    const struct light *light = &scene->lights[index];
    point->triangle = light->type->sample_point(scene, light, u, &point->at);
    return light;
}

bool light_invert(const struct scene *scene, const struct light *light,
                  const struct hit *point, double *u_pick, double u[2])
{
    int index = (int)(light - scene->lights);
    bool picked = scene->light_count == 1 ||
                  dist_invert(&scene->light_choice, index, *u_pick, u_pick);
    return picked && light->type->invert_point(scene, light, point, u);
}

bool light_enter_invert(const struct light *light, const struct ray_endpoint *point,
                        struct vec3 w, struct vec3 through, double u[2])
{
    struct frame frame = frame_from_normal(point->ng);
    struct vec3 d = vec3_sub(through, light->sphere.centre);
    struct vec3 local = frame_to_local(&frame, d);
    double r = light->sphere.radius;
    (void)w;
    warp_disk_inverse((struct vec2){(double)local.x / r, (double)local.y / r}, u);
    return warp_in_square(u);
}

bool light_invert_no_point(const struct scene *scene, const struct light *light,
                           const struct hit *point, double u[2])
{
    (void)scene, (void)light, (void)point, (void)u;
    return true;
}
