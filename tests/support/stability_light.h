#ifndef ETALON_TESTS_SUPPORT_STABILITY_LIGHT_H
#define ETALON_TESTS_SUPPORT_STABILITY_LIGHT_H

/* Scenes for support/stability.h whose pictures are irradiances in closed form: a floor
 * of reflectance STABILITY_FLOOR at y = 0 under a lamp. */

#include "support/stability.h"

#include <gsl/gsl_integration.h>

#define STABILITY_FLOOR 0.6

static inline int stability_black(struct scene_desc *desc)
{
    return test_material(desc, "black", NULL, rgb_grey(0.0), NULL, 0.0);
}

static inline void stability_floor(struct scene_desc *desc, float half)
{
    int floor = test_diffuse(desc, STABILITY_FLOOR, STABILITY_FLOOR, STABILITY_FLOOR);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, half), vec3(half, 0, 0), floor,
              rgb_grey(0.0));
}

/* White, or of the map. */
static inline void stability_sky(struct scene_desc *desc, const struct texture_image *map)
{
    struct light_desc sky = {.type = &light_environment,
                             .intensity = rgb_grey(1.0),
                             .to_world = xform_identity(),
                             .map = map};
    scene_desc_add_light(desc, &sky);
}

static inline void stability_same(double value, double cells[STABILITY_CELLS])
{
    for (int i = 0; i < STABILITY_CELLS; i++)
        cells[i] = value;
}

static inline void stability_transform(struct scene_desc *desc, const struct xform *by)
{
    for (size_t i = 0; i < desc->shape_count; i++) {
        struct shape_desc *s = &desc->shapes[i];
        if (s->mesh)
            mesh_transform(s->mesh, by);
        else
            s->to_world = xform_mul(by, &s->to_world);
    }
    for (size_t i = 0; i < desc->light_count; i++)
        desc->lights[i].to_world = xform_mul(by, &desc->lights[i].to_world);
    desc->camera.to_world = xform_mul(by, &desc->camera.to_world);
}

/* Everything times `scale`; intensities too, so that radiances stay. */
static inline void stability_scale(struct scene_desc *desc, double scale)
{
    struct xform grow = xform_scale(scale, scale, scale);
    stability_transform(desc, &grow);
    for (size_t i = 0; i < desc->light_count; i++) {
        struct light_desc *l = &desc->lights[i];
        if (!l->type || l->type == &light_spot)
            l->intensity = rgb_scale(l->intensity, scale * scale);
    }
}

/* Away from all axes, along which floats have it easy. */
static inline void stability_turn(struct scene_desc *desc)
{
    struct xform turn = xform_rotate(57.0, 0.48, 0.6, 0.64);
    stability_transform(desc, &turn);
}

/* --- a lamp over a point ---------------------------------------------------------- */

/* The camera sees a patch of 4e-4 about the origin, which is as good as a point. */
static inline struct scene_desc *stability_patch(void)
{
    struct scene_desc *desc = test_desc(vec3(0.9f, 0.8f, 1.1f), vec3(0, 0, 0), 0.01, 4);
    stability_floor(desc, 2.0f);
    return desc;
}

/* A ball of radius x/2 at height 1, its power that of radius 1/2. */
static inline struct scene_desc *make_ball(double x)
{
    struct scene_desc *desc = stability_patch();
    test_sphere(desc, vec3(0, 1, 0), 0.5 * x, stability_black(desc),
                rgb_grey(1.0 / (x * x)), false);
    return desc;
}

static inline void exact_ball(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    stability_same(STABILITY_FLOOR * 0.25, cells);
}

static inline struct scene_desc *make_disk(double x)
{
    struct scene_desc *desc = stability_patch();
    struct xform down = xform_rotate(90.0, 1.0, 0.0, 0.0);
    struct xform up = xform_translate(0.0, 1.0, 0.0);
    struct shape_desc disk = {.kind = SHAPE_DISK,
                              .radius = 0.5 * x,
                              .to_world = xform_mul(&up, &down),
                              .material = stability_black(desc),
                              .emits = true,
                              .radiance = rgb_grey(1.0 / (x * x))};
    scene_desc_add_shape(desc, &disk);
    return desc;
}

static inline void exact_disk(double x, double cells[STABILITY_CELLS])
{
    stability_same(STABILITY_FLOOR * 0.25 / (1.0 + 0.25 * x * x), cells);
}

/* Between the origin and a rectangle of half sides a, b at height 1, that faces it: its
 * radiance 1 makes the irradiance 4 times a corner's, from the contour. */
static inline double stability_rectangle(double a, double b)
{
    double p = hypot(1.0, a), q = hypot(1.0, b);
    return 2.0 * (a / p * atan2(b, p) + b / q * atan2(a, q));
}

static inline struct scene_desc *stability_lamp(double a, double b, double radiance)
{
    struct scene_desc *desc = stability_patch();
    test_quad(desc, vec3(0, 1, 0), vec3((float)a, 0, 0), vec3(0, 0, (float)b),
              stability_black(desc), rgb_grey(radiance));
    return desc;
}

static inline struct scene_desc *make_square(double x)
{
    return stability_lamp(0.5 * x, 0.5 * x, 1.0 / (x * x));
}

static inline void exact_square(double x, double cells[STABILITY_CELLS])
{
    double a = (double)(float)(0.5 * x);
    stability_same(STABILITY_FLOOR / MATH_PI * stability_rectangle(a, a) / (x * x),
                   cells);
}

/* As long as the scene, x wide. */
static inline struct scene_desc *make_needle(double x)
{
    return stability_lamp(1.0, x, 1.0 / x);
}

static inline void exact_needle(double x, double cells[STABILITY_CELLS])
{
    double b = (double)(float)x;
    stability_same(STABILITY_FLOOR / MATH_PI * stability_rectangle(1.0, b) / x, cells);
}

/* --- scale and radiance ----------------------------------------------------------- */

static inline struct scene_desc *make_scaled_ball(double x)
{
    struct scene_desc *desc = make_ball(0.5);
    stability_scale(desc, x);
    return desc;
}

static inline struct scene_desc *make_scaled_square(double x)
{
    struct scene_desc *desc = make_square(0.5);
    stability_scale(desc, x);
    return desc;
}

static inline void exact_half_square(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    exact_square(0.5, cells);
}

static inline struct scene_desc *make_radiance(double x)
{
    struct scene_desc *desc = stability_patch();
    test_sphere(desc, vec3(0, 1, 0), 0.5, stability_black(desc), rgb_grey(x), false);
    return desc;
}

static inline void exact_radiance(double x, double cells[STABILITY_CELLS])
{
    stability_same(STABILITY_FLOOR * 0.25 * x, cells);
}

/* Two halves of a floor, a wall between them, a ball of radius .1 at height 1 over each
 * (out of sight), of radiances 1 and x. */
static inline struct scene_desc *make_two_rooms(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 3, 0), vec3(0, 0, 0.001f), 18.0, 4);
    double eye[3] = {0, 3, 0}, target[3] = {0, 0, 0}, up[3] = {0, 0, -1};
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    stability_floor(desc, 2.0f);
    int black = stability_black(desc);
    test_quad(desc, vec3(0, 1, 0), vec3(0, 1, 0), vec3(0, 0, 2), black, rgb_grey(0.0));
    test_sphere(desc, vec3(-0.75f, 1, -1.25f), 0.1, black, rgb_grey(1.0), false);
    test_sphere(desc, vec3(0.75f, 1, -1.25f), 0.1, black, rgb_grey(x), false);
    return desc;
}

/* Mean over the floor that the right half of the film sees. */
static inline double stability_room(double half, double radiance)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    double sum = 0.0, x, z, wx, wz;
    for (size_t i = 0; i < 16; i++)
        for (size_t j = 0; j < 16; j++) {
            gsl_integration_glfixed_point(0.0, half, i, &x, &wx, table);
            gsl_integration_glfixed_point(-half, half, j, &z, &wz, table);
            double d2 = (x - 0.75) * (x - 0.75) + 1.0 + (z + 1.25) * (z + 1.25);
            sum += wx * wz / (2.0 * half * half) * 0.01 / (d2 * sqrt(d2));
        }
    gsl_integration_glfixed_table_free(table);
    return STABILITY_FLOOR * radiance * sum;
}

static inline void exact_two_rooms(double x, double cells[STABILITY_CELLS])
{
    double half = 3.0 * tan(9.0 * MATH_PI / 180.0);
    cells[0] = stability_room(half, x); /* +x is to the left of this camera */
    cells[1] = stability_room(half, 1.0);
}

/* --- grazing ---------------------------------------------------------------------- */

/* A distant light x above the horizon. */
static inline struct scene_desc *make_sunset(double x)
{
    struct scene_desc *desc = stability_patch();
    struct xform to_world = xform_identity();
    double m[16] = {0, sin(x), cos(x), 0, 0, cos(x), -sin(x), 0, -1, 0, 0, 0, 0, 0, 0, 1};
    if (!xform_from_matrix(m, &to_world))
        abort();
    struct light_desc sun = {.type = &light_distant,
                             .intensity = rgb_grey(1.0 / sin(x)),
                             .to_world = to_world};
    scene_desc_add_light(desc, &sun);
    return desc;
}

static inline void exact_sunset(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    stability_same(STABILITY_FLOOR / MATH_PI, cells);
}

/* A small ball at distance 1, x above the horizon. */
static inline struct scene_desc *make_low_ball(double x)
{
    struct scene_desc *desc = stability_patch();
    test_sphere(desc, vec3(0, (float)x, -1), 0.25 * x, stability_black(desc),
                rgb_grey(1.0 / (x * x * x)), false);
    return desc;
}

static inline void exact_low_ball(double x, double cells[STABILITY_CELLS])
{
    double y = (double)(float)x, d = hypot(1.0, y);
    stability_same(STABILITY_FLOOR * 0.0625 * y / x / (d * d * d), cells);
}

/* A camera that looks at a white floor under a white sky, x above it. */
static inline struct scene_desc *make_low_camera(double x)
{
    double fov = fmin(10.0, x * 180.0 / MATH_PI);
    struct scene_desc *desc = test_desc(vec3(0, (float)sin(x), (float)cos(x)),
                                        vec3(0, 0, 0), fov, 4);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 2), vec3(2, 0, 0),
              test_diffuse(desc, 1.0, 1.0, 1.0), rgb_grey(0.0));
    stability_sky(desc, NULL);
    return desc;
}

static inline void exact_one(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    stability_same(1.0, cells);
}

/* --- slits and near vertices ------------------------------------------------------ */

/* A black ceiling at height 1 but for a slit x wide and 1 long, under a lamp at 1.25 that
 * seen from the patch fills it. */
static inline struct scene_desc *make_slit(double x)
{
    struct scene_desc *desc = stability_patch();
    int black = stability_black(desc);
    float h = (float)(0.5 * x), side = 0.5f * (4.0f - h), end = 0.5f * (4.0f - 0.5f);
    struct rgb dark = rgb_grey(0.0);
    struct vec3 long_z = {0, 0, 4}, half_x = {side, 0, 0};
    test_quad(desc, vec3(h + side, 1, 0), half_x, long_z, black, dark);
    test_quad(desc, vec3(-h - side, 1, 0), half_x, long_z, black, dark);
    test_quad(desc, vec3(0, 1, 0.5f + end), vec3(h, 0, 0), vec3(0, 0, end), black, dark);
    test_quad(desc, vec3(0, 1, -0.5f - end), vec3(h, 0, 0), vec3(0, 0, end), black, dark);
    test_quad(desc, vec3(0, 1.25f, 0), vec3(0.75f, 0, 0), vec3(0, 0, 0.75f), black,
              rgb_grey(1.0 / x));
    return desc;
}

static inline void exact_slit(double x, double cells[STABILITY_CELLS])
{
    double b = (double)(float)(0.5 * x);
    stability_same(STABILITY_FLOOR / MATH_PI * stability_rectangle(0.5, b) / x, cells);
}

/* A disk lamp x above the floor that lets the camera's rays through from above. */
static inline struct scene_desc *make_near_lamp(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 0.001f), vec3(0, 0, 0), 0.01, 4);
    stability_floor(desc, 2.0f);
    struct xform down = xform_rotate(90.0, 1.0, 0.0, 0.0);
    struct xform up = xform_translate(0.0, x, 0.0);
    struct shape_desc disk = {
        .kind = SHAPE_DISK,
        .radius = 0.5,
        .to_world = xform_mul(&up, &down),
        .material = test_material(desc, "null", NULL, rgb_grey(0.0), NULL, 0.0),
        .emits = true,
        .radiance = rgb_grey(1.0)};
    scene_desc_add_shape(desc, &disk);
    return desc;
}

static inline void exact_near_lamp(double x, double cells[STABILITY_CELLS])
{
    stability_same(STABILITY_FLOOR * 0.25 / (0.25 + x * x), cells);
}

#endif
