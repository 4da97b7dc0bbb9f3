#include "scene/memory.h"

#include "scene/scene.h"

static size_t bytes_of_mesh(const struct mesh *mesh)
{
    size_t floats = 3u + (mesh->n ? 3u : 0u) + (mesh->uv ? 2u : 0u);
    return sizeof *mesh + floats * sizeof(float) * mesh->vertex_count +
           3 * sizeof(uint32_t) * mesh->triangle_count;
}

static size_t bytes_of_shape(const struct shape *shape, const struct mesh *mesh)
{
    if (shape->quadric)
        return sizeof *shape + sizeof *shape->quadric;
    return sizeof *shape + bytes_of_mesh(mesh) +
           (shape->triangles.edge_offset ? sizeof(float) * mesh->triangle_count : 0);
}

struct memory memory_of_scene(const struct scene *scene)
{
    struct memory memory = {.textures = texture_set_bytes(&scene->desc->textures),
                            .lights = dist_bytes(&scene->light_choice),
                            .bvh = accel_bytes(scene->accel),
                            .resident = accel_resident(scene->accel)};
    for (size_t i = 0; i < scene->desc->shape_count; i++)
        memory.geometry += bytes_of_shape(&scene->shapes[i], scene->desc->shapes[i].mesh);
    memory.geometry += scene->records_bytes;
    memory.geometry += scene->instance_count * sizeof *scene->instances;
    for (int i = 0; i < scene->light_count; i++)
        memory.lights += sizeof *scene->lights + dist_bytes(&scene->lights[i].triangles) +
                         environment_bytes(&scene->lights[i].environment);
    return memory;
}
