#include "scene/light.h"

#include "scene/scene.h"

const struct light *light_sample(const struct scene *scene, double u_pick,
                                 const double u[2], struct anchor *point)
{
    int index = 0;
    if (scene->light_count > 1) {
        double probability;
        index = dist_sample(&scene->light_choice, u_pick, &probability, NULL);
    }
    const struct light *light = &scene->lights[index];
    light->type->sample_point(scene, light, u, point);
    return light;
}
