#ifndef ETALON_TESTS_SUPPORT_INSTANCE_SCENE_H
#define ETALON_TESTS_SUPPORT_INSTANCE_SCENE_H

/* The same objects put into a scene by instances, or by copies that the test makes. */

#include "support/bsdf_make.h"
#include "support/scene_fixture.h"

#include <math.h>

#define INSTANCE_PARTS 8

/* An object's shapes; parts_deinit frees the meshes. */
struct parts {
    struct shape_desc part[INSTANCE_PARTS];
    int count;
};

static inline struct shape_desc *parts_add(struct parts *parts, struct mesh *mesh,
                                           enum shape_kind kind,
                                           const struct xform *to_world, int material)
{
    struct shape_desc *part = &parts->part[parts->count++];
    *part = (struct shape_desc){.kind = kind,
                                .mesh = mesh,
                                .to_world = mesh ? xform_identity() : *to_world,
                                .radius = 1.0,
                                .z_min = -1.0,
                                .z_max = 1.0,
                                .material = material};
    if (mesh)
        mesh_transform(mesh, to_world);
    return part;
}

static inline void parts_deinit(struct parts *parts)
{
    for (int i = 0; i < parts->count; i++)
        mesh_destroy(parts->part[i].mesh);
}

static inline int parts_add_object(struct scene_desc *desc, const struct parts *parts)
{
    int object = scene_desc_add_object(desc);
    for (int i = 0; i < parts->count; i++) {
        struct shape_desc shape = parts->part[i];
        shape.object = object;
        shape.mesh = shape.mesh ? mesh_copy(shape.mesh) : NULL;
        scene_desc_add_shape(desc, &shape);
    }
    return object;
}

static inline void parts_add_instance(struct scene_desc *desc, int object, int parent,
                                      const struct xform *way)
{
    struct instance_desc instance = {
        .object = object, .parent = parent, .to_world = *way, .place = {"test", 1, 1}};
    scene_desc_add_instance(desc, &instance);
}

static inline void parts_copy(struct scene_desc *desc, const struct parts *parts,
                              const struct xform *way)
{
    for (int i = 0; i < parts->count; i++) {
        struct shape_desc shape = parts->part[i];
        shape.to_world = xform_mul(way, &shape.to_world);
        if (shape.mesh) {
            shape.mesh = mesh_copy(shape.mesh);
            mesh_transform(shape.mesh, way);
            if (xform_swaps_handedness(way) && !shape.mesh->n)
                shape.reverse_orientation = !shape.reverse_orientation;
            shape.to_world = xform_identity();
        }
        scene_desc_add_shape(desc, &shape);
    }
}

/* In each of `outer` ways a group that holds the object in each of `inner` ways; inner
 * NULL: the object itself. */
static inline void parts_put(struct scene_desc *desc, bool copied,
                             const struct parts *parts, const struct xform *inner,
                             int inner_count, const struct xform *outer, int outer_count)
{
    const struct xform one = xform_identity();
    if (copied) {
        for (int i = 0; i < outer_count; i++)
            for (int j = 0; j < (inner ? inner_count : 1); j++) {
                struct xform way = xform_mul(&outer[i], inner ? &inner[j] : &one);
                parts_copy(desc, parts, &way);
            }
        return;
    }
    int object = parts_add_object(desc, parts), group = object;
    if (inner) {
        group = scene_desc_add_object(desc);
        for (int j = 0; j < inner_count; j++)
            parts_add_instance(desc, object, group, &inner[j]);
    }
    for (int i = 0; i < outer_count; i++)
        parts_add_instance(desc, group, 0, &outer[i]);
}

/* --- transforms -------------------------------------------------------------------- */

/* scale, then turn about (1,2,3), then move. */
static inline struct xform instance_way(double sx, double sy, double sz, double degrees,
                                        double x, double y, double z)
{
    struct xform scale = xform_scale(sx, sy, sz);
    struct xform turn = xform_rotate(degrees, 1.0, 2.0, 3.0);
    struct xform move = xform_translate(x, y, z);
    struct xform both = xform_mul(&turn, &scale);
    return xform_mul(&move, &both);
}

/* --- materials --------------------------------------------------------------------- */

static inline struct rgb instance_waves(const struct texture *texture,
                                        const struct texture_point *at)
{
    (void)texture;
    return rgb_grey(0.04 * sin(9.0 * at->u) * cos(7.0 * at->v));
}

enum {
    INSTANCE_DIFFUSE, /* of the fixture */
    INSTANCE_BUMPED,  /* red and grey squares, bumped */
    INSTANCE_MASKED,  /* squares with holes */
    INSTANCE_BRUSHED, /* anisotropic */
    INSTANCE_GLASS
};

static inline void instance_materials(struct scene_desc *desc)
{
    static const struct texture waves = {.eval = instance_waves};
    struct texture_set *set = &desc->textures;
    struct bsdf bsdf;
    struct texture *red = texture_constant(set, rgb(0.7, 0.2, 0.1));
    struct texture *grey = texture_constant(set, rgb_grey(0.4));
    struct texture *none = texture_constant(set, rgb_grey(0.0));
    struct texture *all = texture_constant(set, rgb_grey(1.0));
    struct texture *squares = texture_checkerboard(set, red, grey);
    struct texture *holes = texture_checkerboard(set, none, all);
    squares->uv[0][0] = squares->uv[1][1] = holes->uv[0][0] = holes->uv[1][1] = 4.0;
    bsdf_init(&bsdf, bsdf_find("diffuse"));
    bsdf.relief.texture = &waves;
    if (!bsdf_bind(&bsdf, "reflectance", squares, NULL, NULL) ||
        !bsdf_prepare(&bsdf, NULL, NULL))
        abort();
    scene_desc_add_material(desc, &bsdf);
    struct bsdf plain = bsdf_make("diffuse", NULL), nothing = bsdf_make("null", NULL);
    bsdf_init(&bsdf, bsdf_find("blend"));
    bsdf.child[0] = scene_desc_add_part(desc, &plain);
    bsdf.child[1] = scene_desc_add_part(desc, &nothing);
    if (!bsdf_bind(&bsdf, "weight", holes, NULL, NULL) ||
        !bsdf_prepare(&bsdf, NULL, NULL))
        abort();
    scene_desc_add_material(desc, &bsdf);
    bsdf = bsdf_make("roughconductor", "alpha_u", 0.1, "alpha_v", 0.4, NULL);
    scene_desc_add_material(desc, &bsdf);
    bsdf = bsdf_make("dielectric", NULL);
    scene_desc_add_material(desc, &bsdf);
}

#endif
