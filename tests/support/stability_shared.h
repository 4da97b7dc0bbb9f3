#ifndef ETALON_TESTS_SUPPORT_STABILITY_SHARED_H
#define ETALON_TESTS_SUPPORT_STABILITY_SHARED_H

/* Scenes for support/stability.h in which what is extreme is shared by several
 * techniques of like density: only there does a wrong density show. Where one technique
 * has all the weight, any density will do. */

#include "support/stability_mesh.h"
#include "support/stability_view.h"

/* --- grazing ---------------------------------------------------------------------- */

/* A floor seen at x rad from where a spot lights it: light paths and camera paths meet it
 * with the same density, at the same angle. */
static inline struct scene_desc *make_headlight(double x)
{
    const double degree = 180.0 / MATH_PI;
    struct vec3 eye = {0, (float)sin(x), 0}, target = {0, 0, (float)-cos(x)};
    struct scene_desc *desc = test_desc(eye, target, x * degree, 4);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 8), vec3(8, 0, 0),
              test_diffuse(desc, STABILITY_FLOOR, STABILITY_FLOOR, STABILITY_FLOOR),
              rgb_grey(0.0));
    struct light_desc spot = test_beam(&light_spot, eye, target, rgb_grey(1.0 / x));
    spot.inner = 0.75 * x * degree; /* the film's corners are at .71 */
    spot.outer = 0.8 * x * degree;
    scene_desc_add_light(desc, &spot);
    return desc;
}

/* sin(e)^3 / h^2 of elevation e, over the film. */
static inline void exact_headlight(double x, double cells[STABILITY_CELLS])
{
    double half = tan(0.5 * x), h = (double)(float)sin(x);
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    double sum = 0.0;
    for (size_t i = 0; i < 256; i++) {
        double a, b, wa, wb;
        gsl_integration_glfixed_point(-half, half, i / 16, &a, &wa, table);
        gsl_integration_glfixed_point(-half, half, i % 16, &b, &wb, table);
        double sine = (sin(x) + b * cos(x)) / sqrt(1.0 + a * a + b * b);
        sum += wa * wb * sine * sine * sine;
    }
    gsl_integration_glfixed_table_free(table);
    stability_same(STABILITY_FLOOR / MATH_PI * sum / (4.0 * half * half * h * h * x),
                   cells);
}

#define STABILITY_FIN_END 1.5 /* fins reach so far from 1 */

/* How many fins there are about the horizon; they are seen at about x rad. */
static inline int stability_fins(double x)
{
    return (int)(2.0 * MATH_PI / (0.4 * x));
}

/* A patch at the origin in a ring of upright lamps of height 1, one behind the other like
 * the slats of a blind, each seen nearly edge-on. Of so large an area a point is chosen
 * about as often as by the floor's cosine. They overlap by a tenth, so that no rounding
 * lets see between them. */
static inline struct scene_desc *make_fins(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.4f, 0.8f, 0.5f), vec3(0, 0, 0), 0.001, 4);
    int fins = stability_fins(x);
    struct mesh *mesh = mesh_create(4u * (uint32_t)fins, 2u * (uint32_t)fins, false,
                                    false);
    for (int i = 0; i < fins; i++) {
        double from = 2.0 * MATH_PI * i / fins, to = from + 2.2 * MATH_PI / fins;
        float ax = (float)cos(from), az = (float)sin(from);
        float bx = (float)(STABILITY_FIN_END * cos(to)),
              bz = (float)(STABILITY_FIN_END * sin(to));
        const float corners[4][3] = {{ax, 0, az}, {bx, 0, bz}, {bx, 1, bz}, {ax, 1, az}};
        stability_put_strip(mesh, (uint32_t)i, corners);
    }
    struct shape_desc lamp = {.kind = SHAPE_MESH,
                              .mesh = mesh,
                              .to_world = xform_identity(),
                              .material = stability_black(desc),
                              .emits = true,
                              .radiance = rgb_grey(1.0)};
    scene_desc_add_shape(desc, &lamp);
    stability_floor(desc, 2.0f);
    return desc;
}

/* Up to the upper edge of the fin in front, by azimuth. */
static inline void exact_fins(double x, double cells[STABILITY_CELLS])
{
    int fins = stability_fins(x);
    double width = 2.0 * MATH_PI / fins, over = 1.1 * width, end = STABILITY_FIN_END;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    double sum = 0.0;
    for (size_t i = 0; i < 16; i++) {
        double a, w;
        gsl_integration_glfixed_point(0.0, width, i, &a, &w, table);
        double d = end * sin(over) / (sin(a) + end * sin(over - a));
        sum += w * fins * 0.5 / (1.0 + d * d);
    }
    gsl_integration_glfixed_table_free(table);
    stability_same(STABILITY_FLOOR / MATH_PI * sum, cells);
}

/* The low ball's own place is known to far better than a segment of length 1. */
static inline struct scene_desc *make_low_ball_at_origin(double x)
{
    struct scene_desc *desc = make_low_ball(x);
    struct xform move = xform_translate(0.0, 0.0, 1.0);
    stability_transform(desc, &move);
    return desc;
}

/* --- skies ------------------------------------------------------------------------ */

/* A sky of |x| rows, 1 but for a bright pole as large as a row is high, straight above:
 * row 0's, or if x < 0 the last one's. */
static inline struct scene_desc *make_bright_pole(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.3f, 0.8f, 0.2f), vec3(0, 0, 0), 10.0, 4);
    int rows = (int)fabs(x), pole = x > 0.0 ? 0 : rows - 1;
    struct texture_image *map = texture_image_create(&desc->textures, 4, rows);
    for (int i = 0; i < 3 * 4 * rows; i++)
        map->floats[i] = i / 12 == pole ? (float)(x * x) : 1.0f;
    stability_under(map, desc);
    desc->lights[0].to_world = xform_rotate(x > 0.0 ? -90.0 : 90.0, 1.0, 0.0, 0.0);
    return desc;
}

/* All of half a row about the pole, from there linear over a row; both in theta. */
static inline void exact_bright_pole(double x, double cells[STABILITY_CELLS])
{
    double half = 0.5 * MATH_PI / fabs(x), sum = 0.5;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    for (size_t i = 0; i < 16; i++) {
        double t, w;
        gsl_integration_glfixed_point(half, 3.0 * half, i, &t, &w, table);
        sum += w * (x * x - 1.0) * (1.5 - 0.5 * t / half) * sin(t) * cos(t);
    }
    gsl_integration_glfixed_table_free(table);
    sum += (x * x - 1.0) * 0.5 * sin(half) * sin(half);
    stability_same(STABILITY_FLOOR * 2.0 * sum, cells);
}

/* --- long paths ------------------------------------------------------------------- */

/* The white ball as a small mirror shows it that emits as all else does. No light path
 * can be joined to the lens or to what it sees, and all other techniques have one
 * density: each path brings the same, and one that is missing is missed at once. */
static inline struct scene_desc *make_mirrored_ball(double x)
{
    struct scene_desc *desc = make_white_ball(x);
    struct vec3 eye = {0.25f, 0.125f, -0.375f}, at = {0.25f, 0.125f, -0.365f};
    double e[3] = {(double)eye.x, (double)eye.y, (double)eye.z};
    double t[3] = {(double)at.x, (double)at.y, (double)at.z}, up[3] = {0, 1, 0};
    if (!xform_look_at(e, t, up, &desc->camera.to_world))
        abort();
    desc->camera.fov = 20.0;
    int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(1.0), NULL, 0.0);
    test_quad(desc, at, vec3(0.004f, 0, 0.004f), vec3(0, 0.004f, 0), mirror,
              rgb_grey(1.0 / x));
    desc->shapes[desc->shape_count - 1].two_sided = true;
    return desc;
}

#endif
