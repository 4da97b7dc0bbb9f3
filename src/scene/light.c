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
                                 const double u[2], struct ray_endpoint *point)
{
    int index = 0;
    if (scene->light_count > 1) {
        double probability;
        /* By power [Pharr16, section 16.1.2]. */
        index = dist_sample(&scene->light_choice, u_pick, &probability, NULL);
    }
    const struct light *light = &scene->lights[index];
    light->type->sample_point(scene, light, u, point);
    return light;
}
