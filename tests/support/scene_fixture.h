#ifndef ETALON_TESTS_SUPPORT_SCENE_FIXTURE_H
#define ETALON_TESTS_SUPPORT_SCENE_FIXTURE_H

/* Small scenes for tests, built through scene_desc. */

#include "scene/scene.h"
#include "surface/bsdf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline int fixture_material(struct scene_desc *desc, const char *kind)
{
    struct bsdf bsdf;
    struct err err = {0};
    bsdf_init(&bsdf, bsdf_find(kind));
    if (!bsdf_prepare(&bsdf, NULL, &err))
        abort();
    return scene_desc_add_material(desc, &bsdf);
}

/* A camera at the origin that looks along +z, 8 x 6 pixels, and one diffuse material. */
static inline struct scene_desc *fixture_desc(void)
{
    struct scene_desc *desc = scene_desc_create("fixture");
    desc->camera.fov = 60.0;
    desc->width = 8;
    desc->height = 6;
    fixture_material(desc, "diffuse");
    return desc;
}

static inline void fixture_point_light(struct scene_desc *desc)
{
    struct light_desc light = {.to_world = xform_identity(),
                               .intensity = {1.0, 1.0, 1.0}};
    scene_desc_add_light(desc, &light);
}

static inline struct shape_desc *fixture_mesh(struct scene_desc *desc, struct mesh *mesh)
{
    struct shape_desc shape = {
        .kind = SHAPE_MESH, .mesh = mesh, .to_world = xform_identity()};
    int id = scene_desc_add_shape(desc, &shape); /* moves the array */
    return &desc->shapes[id];
}

static inline struct shape_desc *
fixture_quadric(struct scene_desc *desc, enum shape_kind kind, struct xform to_world)
{
    struct shape_desc shape = {
        .kind = kind, .to_world = to_world, .radius = 1.0, .z_min = -1.0, .z_max = 1.0};
    int id = scene_desc_add_shape(desc, &shape); /* moves the array */
    return &desc->shapes[id];
}

static inline struct shape_desc *fixture_triangle(struct scene_desc *desc,
                                                  const float p[9])
{
    struct mesh *mesh = mesh_create(3, 1, false, false);
    for (int i = 0; i < 9; i++)
        mesh->p[i] = p[i];
    for (uint32_t i = 0; i < 3; i++)
        mesh->index[i] = i;
    return fixture_mesh(desc, mesh);
}

/* Objects are shared, however small. */
static inline struct scene *fixture_build(struct scene_desc *desc)
{
    struct err err = {0};
    struct scene_options options = {.threads = 1, .instances = INSTANCES_SHARED};
    struct scene *scene = scene_build(desc, &options, &err);
    if (!scene) {
        char text[1200];
        err_format(&err, text, sizeof text);
        fprintf(stderr, "%s\n", text);
        abort();
    }
    return scene;
}

#endif
