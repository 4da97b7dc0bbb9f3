#ifndef ETALON_SCENE_SCENE_H
#define ETALON_SCENE_SCENE_H

/* The scene as integrators see it: flat arrays by id, built once, then read-only. */

#include "scene/accel.h"
#include "scene/camera.h"
#include "scene/instance.h"
#include "scene/light.h"
#include "scene/needs.h"
#include "scene/scene_desc.h"
#include "scene/shape.h"

/* The ids of its shapes. */
struct object {
    size_t first_shape, shape_count;
};

struct scene {
    struct scene_desc *desc; /* owned; meshes and materials live here */
    struct shape *shapes;    /* [desc->shape_count], by shape id */
    float *records;          /* of all triangles, or NULL; scene/triangle.h */
    size_t records_bytes;
    struct object *objects; /* objects[0]: what lies in the world's space */
    int object_count;
    struct instance *instances; /* of the others, by object; scene/placement.h */
    size_t instance_count;
    struct camera camera;
    struct light *lights;
    int light_count;
    struct dist light_choice; /* by power */
    const struct light
        *environment; /* the light that rays see when they leave the scene; or NULL */
    struct accel *accel;
    struct needs needs;
    int max_depth;      /* edges; 0 = not stated by the file */
    bool hide_emitters; /* scene/scene_desc.h */
    /* Power of two by which all emission was divided; pictures and b are multiplied by it
     * on output. */
    double emission_scale;
    /* Edges that were given up in this run, or since the scene was built, as they pass
     * too many surfaces (path/passage.h); owned, atomic: the one thing that rendering
     * changes.
     */
    long *edges_cut;
    struct vec3 bounds_min, bounds_max;
    double load_seconds;
    double load_peak; /* peak memory of the process before the BVH was built, bytes */
};

/* What becomes of objects that are put down more than once: AUTO copies them where all
 * copies together are small, for rays find copies sooner. */
enum scene_instances { INSTANCES_AUTO, INSTANCES_SHARED, INSTANCES_COPIED };

struct scene_options {
    int width, height; /* 0: the file's own */
    bool keep_all;     /* leave nothing out (tests) */
    int threads;       /* for building; 0: all */
    enum accel_compact compact;
    enum scene_instances instances;
};

/* Takes the desc over (also on failure). Errors: no camera, no emitter, a non-finite
 * value, a size that is not positive. */
struct scene *scene_build(struct scene_desc *desc, const struct scene_options *options,
                          struct err *err);
void scene_destroy(struct scene *scene);

#endif
