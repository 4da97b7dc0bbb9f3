#ifndef ETALON_TESTS_SUPPORT_WATER_SCENE_H
#define ETALON_TESTS_SUPPORT_WATER_SCENE_H

/* The room filled with water whose surface is smooth, and a ball in it. From under water
 * all light is refracted once, so that nothing of one refraction cancels in another. From
 * above, most of it is refracted on its way in and out: E S D S L. */

#include "support/test_scene.h"

static inline struct scene *water_scene(bool above)
{
    float eye = above ? 1.9f : 0.9f, target = above ? 0.2f : 0.9f,
          half = above ? 0.7f : 0.35f;
    struct scene_desc *desc = test_desc(vec3(0, eye, above ? 1.5f : 4.5f),
                                        vec3(0, target, 0), above ? 60.0 : 34.0, 16);
    struct rgb dark = {0.0, 0.0, 0.0};
    test_room(desc);
    test_lamp(desc, (double)half, rgb(12.0, 10.0, 8.0));
    int water = test_material(desc, "dielectric", NULL, dark, "eta", 1.6);
    test_quad(desc, vec3(0, above ? 1.2f : 1.5f, 2), vec3(0, 0, 3), vec3(1.5f, 0, 0),
              water, dark);
    test_sphere(desc, vec3(-0.4f, 0.4f, 0), 0.4, test_diffuse(desc, 0.3, 0.4, 0.7), dark,
                false);
    return test_build(desc, false);
}

#endif
