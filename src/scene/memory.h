#ifndef ETALON_SCENE_MEMORY_H
#define ETALON_SCENE_MEMORY_H

/* Memory of a scene, in bytes. */

#include <stddef.h>

struct scene;

struct memory {
    size_t geometry; /* meshes, faces, quadrics, instances */
    size_t lights;   /* tables that choose a point or a direction */
    size_t textures; /* pictures and nodes */
    size_t bvh;      /* what Embree has asked for */
    double resident; /* and what the process grew by for it */
};

struct memory memory_of_scene(const struct scene *scene);

#endif
