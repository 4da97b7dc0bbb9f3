#ifndef ETALON_TESTS_SUPPORT_TEST_SCENE_H
#define ETALON_TESTS_SUPPORT_TEST_SCENE_H

/* Small scenes made in code, for tests of paths and integrators. */

#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>

static inline void test_scene_die(const struct err *err)
{
    char text[1200];
    err_format(err, text, sizeof text);
    fprintf(stderr, "test scene: %s\n", text);
    abort();
}

/* A material by kind and up to two parameters of one or three numbers (name NULL: none).
 */
static inline int test_material(struct scene_desc *desc, const char *kind, const char *a,
                                struct rgb va, const char *b, double vb)
{
    struct bsdf bsdf;
    struct err err = {0};
    bsdf_init(&bsdf, bsdf_find(kind));
    double rgb_values[3] = {va.r, va.g, va.b};
    if (a) {
        int count = bsdf_param_find(bsdf.type, a)->count;
        if (!bsdf_set(&bsdf, a, rgb_values, count, NULL, &err))
            test_scene_die(&err);
    }
    if (b && !bsdf_set(&bsdf, b, &vb, 1, NULL, &err))
        test_scene_die(&err);
    if (!bsdf_prepare(&bsdf, NULL, &err))
        test_scene_die(&err);
    return scene_desc_add_material(desc, &bsdf);
}

static inline int test_diffuse(struct scene_desc *desc, double r, double g, double b)
{
    return test_material(desc, "diffuse", "reflectance", rgb(r, g, b), NULL, 0.0);
}

/* Parallelogram centre +- u +- v, normal u x v. */
static inline void test_quad(struct scene_desc *desc, struct vec3 centre, struct vec3 u,
                             struct vec3 v, int material, struct rgb radiance)
{
    struct mesh *mesh = mesh_rectangle();
    struct vec3 n = vec3_normalize(vec3_cross(u, v));
    double m[16] = {(double)u.x, (double)v.x, (double)n.x, (double)centre.x,
                    (double)u.y, (double)v.y, (double)n.y, (double)centre.y,
                    (double)u.z, (double)v.z, (double)n.z, (double)centre.z,
                    0.0,         0.0,         0.0,         1.0};
    struct xform xform;
    if (!xform_from_matrix(m, &xform))
        abort();
    mesh_transform(mesh, &xform);
    struct shape_desc shape = {
        .kind = SHAPE_MESH,
        .mesh = mesh,
        .to_world = xform_identity(),
        .material = material,
        .emits = !rgb_is_black(radiance),
        .radiance = radiance,
    };
    scene_desc_add_shape(desc, &shape);
}

static inline void test_sphere(struct scene_desc *desc, struct vec3 centre, double radius,
                               int material, struct rgb radiance, bool reverse)
{
    struct shape_desc shape = {
        .kind = SHAPE_SPHERE,
        .to_world = xform_translate((double)centre.x, (double)centre.y, (double)centre.z),
        .radius = radius,
        .reverse_orientation = reverse,
        .material = material,
        .emits = !rgb_is_black(radiance),
        .radiance = radiance,
    };
    scene_desc_add_shape(desc, &shape);
}

static inline void test_point_light(struct scene_desc *desc, struct vec3 p,
                                    struct rgb intensity)
{
    struct light_desc light = {
        .to_world = xform_translate((double)p.x, (double)p.y, (double)p.z),
        .intensity = intensity,
    };
    scene_desc_add_light(desc, &light);
}

/* A sky of 16 x 8 texels: a gradient, a warm patch and dark ground, turned so that its
 * axis lies nowhere special. */
static inline void test_sky(struct scene_desc *desc, double scale)
{
    struct texture_image *map = texture_image_create(&desc->textures, 16, 8);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++) {
            float *texel = map->floats + 3 * (16 * y + x);
            float up = y < 5 ? 0.3f + 0.1f * (float)(5 - y) : 0.0f;
            bool patch = y == 3 && x == 5;
            texel[0] = patch ? 9.0f : 0.6f * up + 0.02f * (float)x;
            texel[1] = patch ? 7.0f : up;
            texel[2] = patch ? 3.0f : 1.4f * up;
        }
    struct light_desc light = {.type = &light_environment,
                               .intensity = rgb_grey(scale),
                               .to_world = xform_rotate(70.0, 1.0, 0.4, 0.3),
                               .map = map};
    scene_desc_add_light(desc, &light);
}

/* A light that shines from `from` towards `to`. */
static inline struct light_desc test_beam(const struct light_type *type, struct vec3 from,
                                          struct vec3 to, struct rgb intensity)
{
    double e[3] = {(double)from.x, (double)from.y, (double)from.z};
    double t[3] = {(double)to.x, (double)to.y, (double)to.z};
    double up[3] = {0.0, 0.6, 0.8};
    struct light_desc light = {
        .type = type, .intensity = intensity, .inner = 20.0, .outer = 35.0};
    if (!xform_look_at(e, t, up, &light.to_world))
        abort();
    return light;
}

static inline struct scene_desc *test_desc(struct vec3 eye, struct vec3 target,
                                           double fov, int size)
{
    struct scene_desc *desc = scene_desc_create("test");
    double e[3] = {(double)eye.x, (double)eye.y, (double)eye.z};
    double t[3] = {(double)target.x, (double)target.y, (double)target.z};
    double up[3] = {0.0, 1.0, 0.0};
    desc->camera = (struct camera_desc){
        .fov = fov, .fov_axis = FOV_SMALLER, .crop = {0.0, 1.0, 0.0, 1.0}};
    if (!xform_look_at(e, t, up, &desc->camera.to_world))
        abort();
    desc->width = desc->height = size;
    return desc;
}

static inline struct scene *test_build(struct scene_desc *desc, bool keep_all)
{
    struct err err = {0};
    struct scene_options options = {.keep_all = keep_all, .threads = 1};
    struct scene *scene = scene_build(desc, &options, &err);
    if (scene == NULL)
        test_scene_die(&err);
    return scene;
}

/* The unit-free room [-1,1] x [0,2] x [-1,1], open to +z, floor to ceiling diffuse. */
static inline void test_room(struct scene_desc *desc)
{
    int white = test_diffuse(desc, 0.7, 0.7, 0.65);
    int red = test_diffuse(desc, 0.6, 0.1, 0.1),
        green = test_diffuse(desc, 0.1, 0.5, 0.1);
    struct rgb dark = {0.0, 0.0, 0.0};
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 1), vec3(1, 0, 0), white, dark);
    test_quad(desc, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1), white, dark);
    test_quad(desc, vec3(0, 1, -1), vec3(1, 0, 0), vec3(0, 1, 0), white, dark);
    test_quad(desc, vec3(-1, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), red, dark);
    test_quad(desc, vec3(1, 1, 0), vec3(0, 0, 1), vec3(0, 1, 0), green, dark);
}

static inline void test_lamp(struct scene_desc *desc, double half, struct rgb radiance)
{
    int black = test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
    float h = (float)half;
    test_quad(desc, vec3(0, 1.98f, 0), vec3(h, 0, 0), vec3(0, 0, h), black, radiance);
}

/* Seven flat segments a turn that pretend to be round. */
static inline void test_vase(struct scene_desc *desc, int material)
{
    const double profile[] = {0.35, 0.05, 0.55, 0.5, 0.45, 0.9, 0.2, 1.2};
    struct shape_desc shape = {
        .kind = SHAPE_MESH,
        .mesh = mesh_lathe(profile, 4, 7, true, 60.0),
        .to_world = xform_identity(),
        .material = material,
    };
    scene_desc_add_shape(desc, &shape);
}

/* A checkered mask half over a plastic sphere, an uber pane that lets light through, and
 * a textured floor plate. */
static inline void test_mixed(struct scene_desc *desc, struct vec3 left,
                              struct vec3 right)
{
    struct rgb dark = {0.0, 0.0, 0.0};
    struct texture_set *set = &desc->textures;
    struct texture *a = texture_constant(set, rgb(0.8, 0.7, 0.2));
    struct texture *b = texture_constant(set, rgb(0.1, 0.3, 0.6));
    struct texture *checks = texture_checkerboard(set, a, b);
    checks->uv[0][0] = checks->uv[1][1] = 6.0;
    struct bsdf plastic, through, mask, floor;
    struct err err = {0};
    bsdf_init(&plastic, bsdf_find("plastic"));
    bsdf_init(&through, bsdf_find("null"));
    bsdf_init(&mask, bsdf_find("blend"));
    bsdf_init(&floor, bsdf_find("roughplastic"));
    double alpha = 0.2;
    if (!bsdf_bind(&plastic, "reflectance", checks, NULL, &err) ||
        !bsdf_prepare(&plastic, NULL, &err) || !bsdf_prepare(&through, NULL, &err) ||
        !bsdf_set(&floor, "alpha", &alpha, 1, NULL, &err) ||
        !bsdf_bind(&floor, "reflectance", checks, NULL, &err) ||
        !bsdf_prepare(&floor, NULL, &err))
        test_scene_die(&err);
    mask.child[0] = scene_desc_add_part(desc, &through);
    mask.child[1] = scene_desc_add_part(desc, &plastic);
    if (!bsdf_bind(&mask, "weight", checks, NULL, &err) ||
        !bsdf_prepare(&mask, NULL, &err))
        test_scene_die(&err);
    test_sphere(desc, left, 0.4, scene_desc_add_material(desc, &mask), dark, false);
    int uber = test_material(desc, "uber", "opacity", rgb(0.4, 0.5, 0.6), "kr", 0.4);
    test_sphere(desc, right, 0.35, uber, dark, false);
    test_quad(desc, vec3(0, 0.02f, 0.3f), vec3(0, 0, 0.5f), vec3(0.8f, 0, 0),
              scene_desc_add_material(desc, &floor), dark);
}

/* A material whose shading normals a bump map turns by up to 60 degrees on test_quad. */
static inline int test_bumped(struct scene_desc *desc, int material)
{
    struct texture_image *map = texture_image_create(&desc->textures, 8, 8);
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++)
            map->floats[3 * i + c] = 0.04f * (float)(i * 37 % 11);
    desc->materials[material].relief.texture = texture_picture(&desc->textures, map,
                                                               TEXTURE_REPEAT);
    return material;
}

/* A vase whose shading normals are interpolated and bumped, a floor plate of metal and a
 * pane of frosted glass before the back wall, both bumped: on all of them light is to be
 * kept from leaking where shading and geometric normal disagree about the side. */
static inline void test_bumps(struct scene_desc *desc)
{
    struct rgb dark = {0.0, 0.0, 0.0};
    int vase = test_diffuse(desc, 0.5, 0.6, 0.8);
    int metal = test_material(desc, "roughconductor", NULL, dark, "alpha", 0.4);
    int frosted = test_material(desc, "roughdielectric", NULL, dark, "alpha", 0.4);
    test_vase(desc, test_bumped(desc, vase));
    test_quad(desc, vec3(0, 0.02f, 0.3f), vec3(0, 0, 0.5f), vec3(0.8f, 0, 0),
              test_bumped(desc, metal), dark);
    test_quad(desc, vec3(0, 1.4f, -0.8f), vec3(0.8f, 0, 0), vec3(0, 0.5f, 0),
              test_bumped(desc, frosted), dark);
}

/* What light goes straight through: a tinted pane under the lamp, a second one before the
 * camera, a coloured filter, and a card that is partly there, checkered; a sky shines
 * through them too. */
static inline void test_panes(struct scene_desc *desc)
{
    struct rgb dark = {0.0, 0.0, 0.0};
    struct texture_set *set = &desc->textures;
    struct texture *checks = texture_checkerboard(
        set, texture_constant(set, rgb_grey(0.9)), texture_constant(set, rgb_grey(0.2)));
    struct bsdf card;
    struct err err = {0};
    checks->uv[0][0] = checks->uv[1][1] = 4.0;
    int pane = test_material(desc, "thindielectric", "transmittance", rgb(0.9, 0.8, 0.7),
                             "eta", 1.8);
    int filter = test_material(desc, "null", "transmittance", rgb(0.3, 0.6, 0.9), NULL,
                               0.0);
    bsdf_init(&card, bsdf_find("blend"));
    int paper = test_diffuse(desc, 0.6, 0.5, 0.4);
    card.child[0] = scene_desc_add_part(desc, &desc->materials[filter]);
    card.child[1] = scene_desc_add_part(desc, &desc->materials[paper]);
    if (!bsdf_bind(&card, "weight", checks, NULL, &err) ||
        !bsdf_prepare(&card, NULL, &err))
        test_scene_die(&err);
    test_quad(desc, vec3(0, 1.6f, 0), vec3(0.9f, 0, 0.1f), vec3(0, 0.05f, 0.9f), pane,
              dark);
    test_quad(desc, vec3(0.2f, 1, 1.5f), vec3(0.9f, 0, 0.2f), vec3(0, 0.9f, 0), pane,
              dark);
    test_quad(desc, vec3(-0.5f, 0.7f, 0.3f), vec3(0.3f, 0, 0.3f), vec3(0, 0.5f, 0),
              filter, dark);
    test_quad(desc, vec3(0.35f, 0.7f, 0.1f), vec3(0.5f, 0, -0.2f), vec3(0, 0.6f, 0.1f),
              scene_desc_add_material(desc, &card), dark);
    test_sky(desc, 1.0);
}

/* A pane of paper that light falls through, a rough diffuse sphere, two principled ones,
 * opaque and translucent, a floor plate of metal with a normal map, under a lamp of four
 * squares. */
static inline void test_surfaces(struct scene_desc *desc, struct vec3 left,
                                 struct vec3 right)
{
    struct rgb dark = {0.0, 0.0, 0.0};
    int paper = test_material(desc, "translucent", "transmittance", rgb(0.6, 0.4, 0.2),
                              NULL, 0.0);
    int plaster = test_material(desc, "orennayar", "reflectance", rgb(0.8, 0.7, 0.7),
                                "sigma", 0.6);
    int metal = test_bumped(
        desc, test_material(desc, "roughconductor", NULL, dark, "alpha", 0.4));
    desc->materials[metal].relief.normals = true;
    struct texture_set *set = &desc->textures;
    struct texture *squares = texture_checkerboard(
        set, texture_constant(set, rgb(2.0, 1.0, 0.3)),
        texture_constant(set, rgb(0.1, 0.2, 0.4)));
    squares->uv[0][0] = squares->uv[1][1] = 2.0;
    desc->shapes[desc->shape_count - 1].emission = squares; /* of the lamp */
    int sweet = test_material(desc, "principled", "base_color", rgb(0.8, 0.5, 0.3),
                              "spec_trans", 0.6);
    int paint = test_material(desc, "principled", "base_color", rgb(0.3, 0.5, 0.8),
                              "clearcoat", 1.0);
    test_sphere(desc, left, 0.4, plaster, dark, false);
    test_sphere(desc, right, 0.35, sweet, dark, false);
    test_sphere(desc, vec3(-0.6f, 1.3f, -0.5f), 0.3, paint, dark, false);
    test_quad(desc, vec3(0, 0.02f, 0.3f), vec3(0, 0, 0.5f), vec3(0.8f, 0, 0), metal,
              dark);
    test_quad(desc, vec3(0.3f, 1.4f, 0), vec3(0.5f, 0, 0), vec3(0, 0, 0.4f), paper, dark);
}

enum test_contents {
    TEST_DIFFUSE,  /* a diffuse sphere, area light */
    TEST_GLASS,    /* smooth glass and mirror, area light */
    TEST_ROUGH,    /* rough conductor, rough glass, substrate, area light */
    TEST_POINT,    /* point light and area light, glass, thin lens */
    TEST_SMOOTH,   /* a coarse mesh whose shading normals are not its own, diffuse */
    TEST_SKY,      /* an environment beside the lamp, diffuse and rough things */
    TEST_SUN,      /* a distant light, a spot and a constant environment, no lamp */
    TEST_SKYGLASS, /* an environment, glass, a mirror; no lamp */
    TEST_MIXED,    /* delta lobes beside others: plastic, uber, masks; textures */
    TEST_BUMP,     /* bump maps over interpolated and flat normals, opaque and glass */
    TEST_PANES,    /* panes, a mask and a filter before lamp, sky and camera */
    TEST_SURFACES, /* diffuse transmission, rough diffuse, principled, a normal map, a
                      textured lamp */
    TEST_PARALLEL, /* an orthographic camera, stretched; an environment, rough things */
    TEST_PARALLEL_LENS, /* one with a lens, diffuse and rough things */
    TEST_CONTENTS
};

static const char *const test_contents_name[] = {
    "diffuse",   "glass", "rough", "point+lens", "smooth",   "sky",      "sun",
    "sky+glass", "mixed", "bump",  "panes",      "surfaces", "parallel", "parallel+lens"};

static inline struct scene *test_scene(enum test_contents contents, bool keep_all)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 16);
    struct rgb dark = {0.0, 0.0, 0.0};
    const struct rgb lamp = {12.0, 10.0, 8.0};
    const struct vec3 left = {-0.45f, 0.45f, -0.3f}, right = {0.45f, 0.4f, 0.25f};
    test_room(desc);
    if (contents != TEST_SUN && contents != TEST_SKYGLASS)
        test_lamp(desc, 0.35, lamp);
    int glass = test_material(desc, "dielectric", NULL, dark, "eta", 1.5);
    switch (contents) {
    case TEST_DIFFUSE:
        test_sphere(desc, left, 0.4, test_diffuse(desc, 0.3, 0.4, 0.7), dark, false);
        break;
    case TEST_GLASS: {
        int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0);
        test_sphere(desc, left, 0.4, mirror, dark, false);
        test_sphere(desc, right, 0.35, glass, dark, false);
        break;
    }
    case TEST_ROUGH: {
        int metal = test_material(desc, "roughconductor", NULL, dark, "alpha", 0.25);
        int frosted = test_material(desc, "roughdielectric", NULL, dark, "alpha", 0.3);
        int coat = test_material(desc, "substrate", NULL, dark, "alpha", 0.2);
        test_sphere(desc, left, 0.4, metal, dark, false);
        test_sphere(desc, right, 0.35, frosted, dark, false);
        test_sphere(desc, vec3(0.1f, 1.3f, -0.5f), 0.3, coat, dark, false);
        break;
    }
    case TEST_SMOOTH:
        test_vase(desc, test_diffuse(desc, 0.5, 0.6, 0.8));
        break;
    case TEST_MIXED:
        test_mixed(desc, left, right);
        break;
    case TEST_BUMP:
        test_bumps(desc);
        break;
    case TEST_PANES:
        test_panes(desc);
        break;
    case TEST_SURFACES:
        test_surfaces(desc, left, right);
        break;
    case TEST_SKY:
        test_sky(desc, 4.0);
        test_vase(desc, test_material(desc, "substrate", NULL, dark, "alpha", 0.3));
        break;
    case TEST_SUN: {
        struct light_desc sun = test_beam(&light_distant, vec3(0.5f, 2.5f, 3.0f),
                                          vec3(0, 0.6f, -0.4f), rgb(3.0, 2.6, 2.0));
        struct light_desc spot = test_beam(&light_spot, vec3(-0.3f, 1.7f, 0.6f),
                                           vec3(0.5f, 0.2f, -0.2f), rgb(1.0, 1.5, 2.0));
        struct light_desc sky = {.type = &light_environment,
                                 .intensity = rgb(0.2, 0.3, 0.5),
                                 .to_world = xform_identity()};
        scene_desc_add_light(desc, &sun);
        scene_desc_add_light(desc, &spot);
        scene_desc_add_light(desc, &sky);
        test_sphere(desc, left, 0.4, test_diffuse(desc, 0.3, 0.4, 0.7), dark, false);
        break;
    }
    case TEST_SKYGLASS: {
        int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0);
        test_sky(desc, 4.0);
        test_sphere(desc, left, 0.4, mirror, dark, false);
        test_sphere(desc, right, 0.35, glass, dark, false);
        break;
    }
    case TEST_PARALLEL: {
        struct xform stretch = xform_scale(-1.2, 0.8, 2.0);
        desc->camera.to_world = xform_mul(&desc->camera.to_world, &stretch);
        desc->camera.extent = 2.4;
        test_sky(desc, 4.0);
        test_vase(desc, test_material(desc, "substrate", NULL, dark, "alpha", 0.3));
        break;
    }
    case TEST_PARALLEL_LENS:
        desc->camera.extent = 2.2;
        desc->camera.lens_radius = 1.5;
        desc->camera.focus_distance = 4.5;
        test_sphere(desc, left, 0.4, test_diffuse(desc, 0.3, 0.4, 0.7), dark, false);
        test_sphere(desc, right, 0.35,
                    test_material(desc, "roughconductor", NULL, dark, "alpha", 0.25),
                    dark, false);
        break;
    default:
        desc->camera.lens_radius = 0.1;
        desc->camera.focus_distance = 4.5;
        test_point_light(desc, vec3(-0.6f, 1.6f, 0.6f), rgb(0.5, 0.6, 0.9));
        test_sphere(desc, right, 0.35, glass, dark, false);
        test_sphere(desc, left, 0.3, test_diffuse(desc, 0.6, 0.6, 0.6), rgb(2, 1, 0.5),
                    false);
    }
    return test_build(desc, keep_all);
}

#endif
