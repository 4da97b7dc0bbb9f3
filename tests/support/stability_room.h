#ifndef ETALON_TESTS_SUPPORT_STABILITY_ROOM_H
#define ETALON_TESTS_SUPPORT_STABILITY_ROOM_H

/* Scenes for support/stability.h that are furnaces: closed rooms that glow, and glass,
 * white and rough things under a white sky. */

#include "image/exr.h"
#include "support/albedo.h"
#include "support/stability_light.h"

#include <unistd.h>

#define STABILITY_GLOW_DEPTH 8

/* --- closed rooms ----------------------------------------------------------------- */

/* Walls of reflectance 1/2 that emit 1/2: 1 - 2^-edges. */
static inline double stability_glow(int edges)
{
    return 1.0 - pow(2.0, -edges);
}

static inline struct shape_desc stability_walls(struct scene_desc *desc)
{
    return (struct shape_desc){.material = test_diffuse(desc, 0.5, 0.5, 0.5),
                               .to_world = xform_identity(),
                               .reverse_orientation = true,
                               .emits = true,
                               .radiance = rgb_grey(0.5)};
}

static inline struct scene_desc *stability_inside(void)
{
    return test_desc(vec3(0.25f, 0.125f, -0.375f), vec3(1, 0.25f, 1), 90.0, 4);
}

static inline struct scene_desc *make_glowing_ball(double x)
{
    (void)x;
    struct scene_desc *desc = stability_inside();
    struct shape_desc walls = stability_walls(desc);
    walls.kind = SHAPE_SPHERE;
    walls.radius = 1.0;
    scene_desc_add_shape(desc, &walls);
    return desc;
}

/* The depth is the case's x. */
static inline void exact_depth(double x, double cells[STABILITY_CELLS])
{
    stability_same(stability_glow((int)x), cells);
}

static inline void exact_glow(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    stability_same(stability_glow(STABILITY_GLOW_DEPTH), cells);
}

static inline struct scene_desc *stability_glowing(struct mesh *mesh)
{
    struct scene_desc *desc = stability_inside();
    struct shape_desc walls = stability_walls(desc);
    walls.kind = SHAPE_MESH;
    walls.mesh = mesh;
    scene_desc_add_shape(desc, &walls);
    return desc;
}

static inline struct scene_desc *make_glowing_box(double x)
{
    struct scene_desc *desc = stability_glowing(mesh_box());
    stability_scale(desc, x);
    return desc;
}

/* The same with no wall across an axis: places on those are exact, and need no offset. */
static inline struct scene_desc *make_turned_box(double x)
{
    struct scene_desc *desc = make_glowing_box(x);
    stability_turn(desc);
    return desc;
}

/* x sizes away from the world's origin. */
static inline struct scene_desc *make_shifted_box(double x)
{
    struct scene_desc *desc = make_turned_box(1.0);
    struct xform move = xform_translate(x, -x, 0.5 * x);
    stability_transform(desc, &move);
    return desc;
}

/* Two triangles of corners a, b, c, d. */
static inline void stability_put_strip(struct mesh *mesh, uint32_t quad,
                                       const float corners[4][3])
{
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    memcpy(mesh->p + 12 * (size_t)quad, corners, 12 * sizeof(float));
    for (size_t i = 0; i < 6; i++)
        mesh->index[6 * (size_t)quad + i] = 4 * quad + order[i];
}

/* A box whose sides are cut into strips at these places; every second wall the other way
 * round, so that edges meet in T-junctions. Faces outward. */
static inline struct mesh *stability_strips(const double *cuts, int strips)
{
    struct mesh *mesh = mesh_create(24u * (uint32_t)strips, 12u * (uint32_t)strips, false,
                                    false);
    for (int side = 0; side < 6; side++)
        for (int i = 0; i < strips; i++) {
            int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
            float at = side % 2 ? 1.0f : -1.0f, corners[4][3];
            for (int k = 0; k < 4; k++) {
                bool across = k == 1 || k == 2;
                corners[k][axis] = at;
                corners[k][u] = (float)cuts[i + (side % 2 ? across : k > 1)];
                corners[k][v] = (side % 2 ? k > 1 : across) ? 1.0f : -1.0f;
            }
            stability_put_strip(mesh, (uint32_t)(side * strips + i),
                                (const float(*)[3])corners);
        }
    return mesh;
}

/* 1/x strips of width 2x a wall. */
static inline struct scene_desc *make_needle_walls(double x)
{
    int strips = (int)(1.0 / x + 0.5);
    double *cuts = calloc((size_t)strips + 1, sizeof *cuts);
    for (int i = 0; i <= strips; i++)
        cuts[i] = -1.0 + 2.0 * i / strips;
    struct scene_desc *desc = stability_glowing(stability_strips(cuts, strips));
    desc->shapes[0].two_sided = true;
    free(cuts);
    return desc;
}

/* Each wall with one strip of width x in its middle. */
static inline struct scene_desc *make_sliver_walls(double x)
{
    const double cuts[4] = {-1.0, 0.125, 0.125 + x, 1.0};
    struct scene_desc *desc = stability_glowing(stability_strips(cuts, 3));
    desc->shapes[0].two_sided = true;
    return desc;
}

/* Every triangle three times, the third without area. */
static inline struct scene_desc *make_degenerate_walls(double x)
{
    (void)x;
    struct mesh *box = mesh_box(), *mesh = mesh_create(24, 36, false, false);
    memcpy(mesh->p, box->p, 72 * sizeof *mesh->p);
    for (size_t i = 0; i < 36; i++) {
        uint32_t corner = box->index[i];
        mesh->index[3 * (i - i % 3) + i % 3] = corner;
        mesh->index[3 * (i - i % 3) + 3 + i % 3] = corner;
        mesh->index[3 * (i - i % 3) + 6 + i % 3] = box->index[i - i % 3];
    }
    mesh_destroy(box);
    return stability_glowing(mesh);
}

/* A lamp exactly in the ceiling's plane: what is seen of it is anybody's guess. */
static inline struct scene_desc *make_coplanar_lamp(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.9f, 0.3f, 1.1f), vec3(0, 1, 0), 10.0, 4);
    stability_floor(desc, 2.0f);
    test_quad(desc, vec3(0, 1, 0), vec3(2, 0, 0), vec3(0, 0, 2), stability_black(desc),
              rgb_grey(0.0));
    test_quad(desc, vec3(0, 1.0f - (float)x, 0), vec3(0.9f, 0, 0), vec3(0, 0, 0.9f),
              stability_black(desc), rgb_grey(1.0));
    return desc;
}

/* --- glass under a white sky ------------------------------------------------------ */

static inline int stability_glass(struct scene_desc *desc, const char *kind, double eta)
{
    return test_material(desc, kind, "eta", rgb_grey(eta), NULL, 0.0);
}

static inline struct scene_desc *stability_white(double fov)
{
    struct scene_desc *desc = test_desc(vec3(0.25f, 0.5f, 4), vec3(0, 0, 0), fov, 4);
    stability_sky(desc, NULL);
    return desc;
}

static inline struct scene_desc *make_glass_ball(double x)
{
    struct scene_desc *desc = stability_white(10.0);
    test_sphere(desc, vec3(0, 0, 0), 1.0, stability_glass(desc, "dielectric", x),
                rgb_grey(0.0), false);
    return desc;
}

static inline struct scene_desc *make_frosted_ball(double x)
{
    struct scene_desc *desc = stability_white(10.0);
    int glass = test_material(desc, "roughdielectric", "eta", rgb_grey(x), "alpha", 0.05);
    test_sphere(desc, vec3(0, 0, 0), 1.0, glass, rgb_grey(0.0), false);
    return desc;
}

/* Shells of glass about each other, all walls and the air between them x thick. */
static inline struct scene_desc *stability_shells(double x, double away)
{
    struct scene_desc *desc = stability_white(10.0);
    int glass = stability_glass(desc, "dielectric", 1.5);
    struct vec3 centre = {(float)away, 0, 0};
    for (int i = 0; i < 4; i++)
        test_sphere(desc, centre, 1.0 - i * x, glass, rgb_grey(0.0), i % 2 == 1);
    struct xform move = xform_translate(away, 0.0, 0.0);
    desc->camera.to_world = xform_mul(&move, &desc->camera.to_world);
    return desc;
}

static inline struct scene_desc *make_shells(double x)
{
    return stability_shells(x, 0.0);
}

static inline struct scene_desc *make_far_shells(double x)
{
    return stability_shells(x, 64.0);
}

/* Panes of triangles, as thick and as far apart. */
static inline struct scene_desc *make_panes(double x)
{
    struct scene_desc *desc = stability_white(10.0);
    int glass = stability_glass(desc, "dielectric", 1.5);
    for (int i = 0; i < 4; i++)
        test_quad(desc, vec3(0, 0, (float)(-i * x)), vec3(i % 2 ? -2 : 2, 0, 0),
                  vec3(0, 2, 0), glass, rgb_grey(0.0));
    return desc;
}

/* --- the camera ------------------------------------------------------------------- */

/* At the centre of a ball of glass all rays go straight out: eta^2 (1 - R^n), R the
 * reflectance of normal incidence. */
static inline struct scene_desc *make_camera_in_glass(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 0), vec3(0, 0, -1), 60.0, 4);
    stability_sky(desc, NULL);
    test_sphere(desc, vec3(0, 0, 0), 1.0, stability_glass(desc, "dielectric", x),
                rgb_grey(0.0), false);
    return desc;
}

static inline void exact_camera_in_glass(double x, double cells[STABILITY_CELLS])
{
    stability_same(x * x, cells);
}

/* A camera exactly in the plane of a white floor that looks x degrees up (or down). */
static inline struct scene_desc *make_camera_on_floor(double x)
{
    double a = x * MATH_PI / 180.0;
    struct scene_desc *desc = test_desc(
        vec3(0.25f, 0, 0.125f), vec3(0.25f, (float)sin(a), 0.125f - (float)cos(a)), 4.0,
        4);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 2), vec3(2, 0, 0),
              test_diffuse(desc, 1.0, 1.0, 1.0), rgb_grey(0.0));
    stability_sky(desc, NULL);
    return desc;
}

/* The same on a ball. */
static inline struct scene_desc *make_camera_on_ball(double x)
{
    (void)x;
    struct scene_desc *desc = test_desc(vec3(0.6f, 0, 0.8f), vec3(1.2f, 0, 1.6f), 20.0,
                                        4);
    test_sphere(desc, vec3(0, 0, 0), 1.0, test_diffuse(desc, 1.0, 1.0, 1.0),
                rgb_grey(0.0), false);
    stability_sky(desc, NULL);
    return desc;
}

/* A black sheet over the left half of a lit floor, from x above. */
static inline struct scene_desc *make_far_camera(double x)
{
    double half = 0.25, fov = 2.0 * atan(half / x) * 180.0 / MATH_PI;
    struct scene_desc *desc = test_desc(vec3(0, 1, 0), vec3(0, 0, 0.1f), fov, 4);
    double eye[3] = {0, x, 0}, target[3] = {0, 0, 0}, up[3] = {0, 0, -1};
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    stability_floor(desc, 1.0f);
    int black = stability_black(desc);
    test_quad(desc, vec3(-0.5f, 0.0625f, 0), vec3(0.5f, 0, 0), vec3(0, 0, 1), black,
              rgb_grey(0.0));
    test_sphere(desc, vec3(0.75f, 1, -1.25f), 0.1, black, rgb_grey(1.0), false);
    return desc;
}

static inline void exact_far_camera(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    cells[0] = stability_room(0.25, 1.0); /* +x is to the left of this camera */
    cells[1] = 0.0;
}

/* --- roughness -------------------------------------------------------------------- */

#define STABILITY_TILT 50.0 /* degrees from the normal */
#define STABILITY_LOW  80.0

static inline struct scene_desc *stability_tilted(const char *kind, double alpha,
                                                  double tilt)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 0.01, 4);
    struct shape_desc disk = {
        .kind = SHAPE_DISK,
        .radius = 3.0,
        .to_world = xform_rotate(tilt, 1.0, 0.0, 0.0),
        .material = test_material(desc, kind, NULL, rgb_grey(0.0), "alpha", alpha),
    };
    scene_desc_add_shape(desc, &disk);
    stability_sky(desc, NULL);
    return desc;
}

static inline struct scene_desc *make_rough_metal(double x)
{
    return stability_tilted("roughconductor", x, STABILITY_TILT);
}

static inline struct scene_desc *make_rough_glass(double x)
{
    return stability_tilted("roughdielectric", x, STABILITY_TILT);
}

static inline struct scene_desc *make_rough_plastic(double x)
{
    return stability_tilted("roughplastic", x, STABILITY_TILT);
}

static inline struct scene_desc *make_low_metal(double x)
{
    return stability_tilted("roughconductor", x, STABILITY_LOW);
}

static inline struct scene_desc *make_low_glass(double x)
{
    return stability_tilted("roughdielectric", x, STABILITY_LOW);
}

/* By the program's own eval, which is all of the plastic that is not the metal's and the
 * glass's too: its table of what passes the coat. */
static inline void exact_rough_plastic(double x, double cells[STABILITY_CELLS])
{
    struct scene_desc *desc = make_rough_plastic(x);
    double tilt = STABILITY_TILT * MATH_PI / 180.0;
    struct vec3 wo = vec3((float)sin(tilt), 0.0f, (float)cos(tilt));
    stability_same(
        rgb_luminance(albedo_quadrature(&desc->materials[0], wo, TRANSPORT_RADIANCE)),
        cells);
    scene_desc_destroy(desc);
}

/* --- bad texels ----------------------------------------------- */

/* A picture as a file holds it: count texels a row, those before `until` of value x. */
static inline const struct texture_image *
stability_picture(struct scene_desc *desc, int width, int until, double x, double rest)
{
    char path[64];
    struct err err = {0};
    struct image *image = image_create(width, width / 2);
    for (int i = 0; i < 3 * width * (width / 2); i++)
        image->pixels[i] = (float)(i / 3 % width < until ? x : rest);
    snprintf(path, sizeof path, "/tmp/etalon-stability-%ld.exr", (long)getpid());
    if (!exr_write(path, image, NULL, 0, NULL, &err))
        test_scene_die(&err);
    image_destroy(image);
    const struct texture_image *picture = texture_image_load(
        &desc->textures, path, TEXTURE_LINEAR, NULL, &desc->log, &err);
    unlink(path);
    if (!picture)
        test_scene_die(&err);
    return picture;
}

/* A sky whose texels are 1 but for a column of value x. */
static inline struct scene_desc *make_bad_sky(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 0), vec3(0.3f, 0.2f, 1), 60.0, 4);
    test_sphere(desc, vec3(0, 0, 9), 1.0, test_diffuse(desc, 0.5, 0.5, 0.5),
                rgb_grey(0.0), false);
    stability_sky(desc, stability_picture(desc, 16, 1, x, 1.0));
    return desc;
}

/* A wall with a picture on it that fills the film of 40 degrees, under a white sky. */
static inline void stability_wall(struct scene_desc *desc,
                                  const struct texture_image *map)
{
    struct bsdf wall;
    struct err err = {0};
    bsdf_init(&wall, bsdf_find("diffuse"));
    if (!bsdf_bind(&wall, "reflectance",
                   texture_picture(&desc->textures, map, TEXTURE_CLAMP), NULL, &err) ||
        !bsdf_prepare(&wall, NULL, &err))
        test_scene_die(&err);
    test_quad(desc, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0),
              scene_desc_add_material(desc, &wall), rgb_grey(0.0));
    stability_sky(desc, NULL);
}

/* Left half of the picture of value x, right half 1/2. */
static inline struct scene_desc *make_bad_wall(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 1), vec3(0, 0, 0), 40.0, 4);
    stability_wall(desc, stability_picture(desc, 256, 128, x, 0.5));
    return desc;
}

static inline void exact_bad_wall(double x, double cells[STABILITY_CELLS])
{
    /* Between texel centres the picture is linear: half a texel's width on either side
     * takes a quarter of the difference. */
    double at = isfinite(x) && x > 0.0 ? fmin(x, 1.0) : 0.0;
    double shift = 0.25 / 256.0 / tan(20.0 * MATH_PI / 180.0) * (0.5 - at);
    cells[0] = 0.5 - shift;
    cells[1] = at + shift;
}

#endif
