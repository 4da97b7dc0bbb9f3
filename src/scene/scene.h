#ifndef ETALON_SCENE_SCENE_H
#define ETALON_SCENE_SCENE_H

/* The scene as integrators see it: flat arrays by id, built once, then read-only. */

#include "scene/accel.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/needs.h"
#include "scene/scene_desc.h"
#include "scene/shape.h"

struct scene {
    struct scene_desc *desc; /* owned; meshes and materials live here */
    struct shape *shapes;    /* [desc->shape_count], by shape id */
    struct camera camera;
    struct light *lights;
    int light_count;
    struct dist light_choice; /* by power */
    const struct light
        *environment; /* the light that rays see when they leave the scene; or NULL */
    struct accel *accel;
    struct needs needs;
    int max_depth; /* edges; 0 = not stated by the file */
    /* Power of two by which all emission was divided; pictures and b are multiplied by it
     * on output. */
    double emission_scale;
    struct vec3 bounds_min, bounds_max;
    double load_seconds;
    double load_peak; /* peak memory of the process before the BVH was built, bytes */
};

struct scene_options {
    int width, height; /* 0: the file's own */
    bool keep_all;     /* leave nothing out (tests) */
    int threads;       /* for building; 0: all */
    enum accel_compact compact;
};

/* Takes the desc over (also on failure). Errors: no camera, no emitter, a non-finite
 * value, a size that is not positive. */
struct scene *scene_build(struct scene_desc *desc, const struct scene_options *options,
                          struct err *err);
void scene_destroy(struct scene *scene);

#endif
