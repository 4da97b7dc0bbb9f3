#ifndef ETALON_TESTS_SUPPORT_STABILITY_VIEW_H
#define ETALON_TESTS_SUPPORT_STABILITY_VIEW_H

/* Scenes for support/stability.h with extremes of film, lens and field of view, of lights
 * that are nearly all in one place, and of views along a surface. */

#include "support/stability_room.h"

#include <complex.h>

/* --- camera and film -------------------------------------------------------------- */

#define STABILITY_LEFT  0.75 /* reflectance of the half that +x is in */
#define STABILITY_RIGHT 0.25

/* A floor of two halves in the sun, seen from straight above at height 1, and all turned:
 * their common edge lies in the middle of the film. */
static inline struct scene_desc *stability_halves(double fov)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 0), vec3(0, 0, 0.1f), fov, 4);
    double eye[3] = {0, 1, 0}, target[3] = {0, 0, 0}, up[3] = {0, 0, -1};
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    const double reflectance[2] = {STABILITY_RIGHT, STABILITY_LEFT};
    for (int i = 0; i < 2; i++) {
        double r = reflectance[i];
        test_quad(desc, vec3((float)i - 0.5f, 0, 0), vec3(0, 0, 1), vec3(0.5f, 0, 0),
                  test_diffuse(desc, r, r, r), rgb_grey(0.0));
    }
    struct light_desc sun = test_beam(&light_distant, vec3(0, 1, 0), vec3(0, 0, 0),
                                      rgb_grey(MATH_PI));
    scene_desc_add_light(desc, &sun);
    stability_turn(desc);
    return desc;
}

static inline void exact_halves(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    cells[0] = STABILITY_LEFT;
    cells[1] = STABILITY_RIGHT;
}

/* In focus whatever the lens' radius x. */
static inline struct scene_desc *make_lens(double x)
{
    struct scene_desc *desc = stability_halves(10.0);
    desc->camera.lens_radius = x;
    desc->camera.focus_distance = 1.0;
    return desc;
}

/* A film x degrees wide. Directions in floats are off by up to 2^-24, which moves the
 * edge between the halves by as much: see the case's precision. */
static inline struct scene_desc *make_narrow(double x)
{
    return stability_halves(x);
}

static inline struct scene_desc *make_wide(double x)
{
    struct scene_desc *desc = make_glowing_box(1.0);
    desc->camera.fov = x;
    return desc;
}

/* A film of one row, x pixels wide. */
static inline struct scene_desc *make_row(double x)
{
    struct scene_desc *desc = make_glowing_box(1.0);
    desc->width = (int)x;
    desc->height = 1;
    return desc;
}

static inline void exact_row(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    exact_depth(2.0, cells);
}

/* --- lights in one place ---------------------------------------------------------- */

/* A spot of outer angle x degrees at height 1 that fills a fifth of what is seen. */
static inline struct scene_desc *stability_spot(double x, bool linear)
{
    double half = 2.0 * tan(x * MATH_PI / 180.0), eye[3] = {0, 0.5, 0};
    double fov = 2.0 * atan(half / 0.5) * 180.0 / MATH_PI;
    struct scene_desc *desc = test_desc(vec3(0, 1, 0), vec3(0, 0, 0.1f), fov, 4);
    double target[3] = {0, 0, 0}, up[3] = {0, 0, -1};
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    stability_floor(desc, 8.0f);
    struct light_desc spot = test_beam(&light_spot, vec3(0, 1, 0), vec3(0, 0, 0),
                                       rgb_grey(1.0));
    spot.inner = 0.5 * x;
    spot.outer = x;
    spot.linear = linear;
    scene_desc_add_light(desc, &spot);
    stability_turn(desc);
    return desc;
}

static inline struct scene_desc *make_spot(double x)
{
    return stability_spot(x, false);
}

static inline struct scene_desc *make_linear_spot(double x)
{
    return stability_spot(x, true);
}

/* All of its flux falls on the film's (4 tan)^2. */
static inline void stability_flux(double x, bool linear, double cells[STABILITY_CELLS])
{
    double outer = x * MATH_PI / 180.0, inner = 0.5 * outer, side = 4.0 * tan(outer);
    double si = sin(0.5 * inner), so = sin(0.5 * outer), edge = 0.0;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    for (size_t i = 0; i < 16; i++) {
        double a, w;
        gsl_integration_glfixed_point(inner, outer, i, &a, &w, table);
        double sa = sin(0.5 * a), t = (so * so - sa * sa) / (so * so - si * si);
        edge += w * sin(a) * (linear ? (outer - a) / (outer - inner) : t * t * t * t);
    }
    gsl_integration_glfixed_table_free(table);
    double flux = 2.0 * MATH_PI * (2.0 * si * si + edge);
    stability_same(STABILITY_FLOOR / MATH_PI * flux / (side * side), cells);
}

static inline void exact_spot(double x, double cells[STABILITY_CELLS])
{
    stability_flux(x, false, cells);
}

static inline void exact_linear_spot(double x, double cells[STABILITY_CELLS])
{
    stability_flux(x, true, cells);
}

/* Skies: texel (4, 3) of 16 x 8 is x, all others are 1; and one row of x texels, of which
 * every second is black. */
static inline float stability_sky_texel(int i, int j, double x)
{
    return i == 4 && j == 3 ? (float)x : 1.0f;
}

static inline struct scene_desc *stability_under(const struct texture_image *map,
                                                 struct scene_desc *desc)
{
    stability_floor(desc, 1.0f);
    stability_sky(desc, map);
    return desc;
}

static inline struct scene_desc *make_bright_texel(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.3f, 0.8f, 0.2f), vec3(0, 0, 0), 10.0, 4);
    struct texture_image *map = texture_image_create(&desc->textures, 16, 8);
    for (int i = 0; i < 3 * 16 * 8; i++)
        map->floats[i] = stability_sky_texel(i / 3 % 16, i / 3 / 16, x);
    return stability_under(map, desc);
}

/* Of the floor at y = 0 under the bilinear picture, whose cells lie between the centres
 * of texels; the pole is +z, and longitudes 0 to pi are above. */
static inline void exact_bright_texel(double x, double cells[STABILITY_CELLS])
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    double sum = 0.0, cell = MATH_PI / 16.0; /* half a texel, both ways */
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 16; i++)
            for (size_t k = 0; k < 256; k++) {
                double a, b, wa, wb;
                gsl_integration_glfixed_point(i * cell, (i + 1) * cell, k / 16, &a, &wa,
                                              table);
                gsl_integration_glfixed_point(j * cell, (j + 1) * cell, k % 16, &b, &wb,
                                              table);
                double u = fabs(0.5 * a / cell - 4.5), v = fabs(0.5 * b / cell - 3.5);
                double more = fmax(0.0, 1.0 - u) * fmax(0.0, 1.0 - v) * (x - 1.0);
                sum += wa * wb * (1.0 + more) * sin(a) * sin(b) * sin(b);
            }
    gsl_integration_glfixed_table_free(table);
    stability_same(STABILITY_FLOOR / MATH_PI * sum, cells);
}

static inline struct scene_desc *make_sky_row(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.3f, 0.8f, 0.2f), vec3(0, 0, 0), 10.0, 4);
    struct texture_image *map = texture_image_create(&desc->textures, (int)x, 1);
    for (int i = 0; i < 3 * (int)x; i++)
        map->floats[i] = i / 3 % 2 ? 0.0f : 2.0f;
    return stability_under(map, desc);
}

/* Stripes much finer than the cosine; of one texel all is 2. */
static inline void exact_sky_row(double x, double cells[STABILITY_CELLS])
{
    stability_same(STABILITY_FLOOR * (x == 1.0 ? 2.0 : 1.0), cells);
}

/* A wall with a picture of one row: its left half 1/4, its right half 1/2. */
static inline struct scene_desc *make_wall_row(double x)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 1), vec3(0, 0, 0), 40.0, 4);
    struct texture_image *map = texture_image_create(&desc->textures, (int)x, 1);
    for (int i = 0; i < 3 * (int)x; i++)
        map->floats[i] = i / 3 < (int)x / 2 ? 0.25f : 0.5f;
    stability_wall(desc, map);
    return desc;
}

static inline void exact_wall_row(double x, double cells[STABILITY_CELLS])
{
    double shift = 0.25 / x / tan(20.0 * MATH_PI / 180.0) * 0.25;
    cells[0] = x == 1.0 ? 0.5 : 0.5 - shift;
    cells[1] = x == 1.0 ? 0.5 : 0.25 + shift;
}

/* --- along a surface -------------------------------------------------------------- */

/* A plate that is seen at x rad to its plane, with a white sky on either side. */
static inline struct scene_desc *stability_plate(double x, const char *kind)
{
    double fov = fmin(10.0, x * 180.0 / MATH_PI);
    struct scene_desc *desc = test_desc(vec3(0, (float)sin(x), (float)cos(x)),
                                        vec3(0, 0, 0), fov, 4);
    test_quad(desc, vec3(0, 0, 0), vec3(0, 0, 2), vec3(2, 0, 0),
              test_material(desc, kind, NULL, rgb_grey(0.0), NULL, 0.0), rgb_grey(0.0));
    stability_sky(desc, NULL);
    return desc;
}

static inline struct scene_desc *make_glass_plate(double x)
{
    return stability_plate(x, "dielectric");
}

static inline struct scene_desc *make_metal_plate(double x)
{
    return stability_plate(x, "conductor");
}

/* Of what light from below brings [radiance over eta^2] and from above, eta 1.5. */
static inline double stability_glass_seen(double c)
{
    double eta = 1.5, t = sqrt(1.0 - (1.0 - c * c) / (eta * eta));
    double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    double r = 0.5 * (s * s + p * p);
    return r + (1.0 - r) / (eta * eta);
}

/* Copper, by complex numbers; luminance. */
static inline double stability_copper_seen(double c)
{
    const double eta[3] = {0.200438, 0.924033, 1.102212},
                 k[3] = {3.912949, 2.452848, 2.142188};
    double r[3];
    for (int i = 0; i < 3; i++) {
        double complex n = eta[i] + k[i] * csqrt(-1.0),
                       t = csqrt(1.0 - (1.0 - c * c) / (n * n));
        double s = cabs((c - n * t) / (c + n * t)), p = cabs((n * c - t) / (n * c + t));
        r[i] = 0.5 * (s * s + p * p);
    }
    return rgb_luminance(rgb(r[0], r[1], r[2]));
}

/* Mean over the film. */
static inline void stability_plate_seen(double x, double (*seen)(double cosine),
                                        double cells[STABILITY_CELLS])
{
    double half = tan(0.5 * fmin(10.0, x * 180.0 / MATH_PI) * MATH_PI / 180.0);
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(16);
    double sum = 0.0;
    for (size_t i = 0; i < 256; i++) {
        double a, b, wa, wb;
        gsl_integration_glfixed_point(-half, half, i / 16, &a, &wa, table);
        gsl_integration_glfixed_point(-half, half, i % 16, &b, &wb, table);
        double cosine = (sin(x) + b * cos(x)) / sqrt(1.0 + a * a + b * b);
        sum += wa * wb * seen(cosine);
    }
    gsl_integration_glfixed_table_free(table);
    stability_same(sum / (4.0 * half * half), cells);
}

static inline void exact_glass_plate(double x, double cells[STABILITY_CELLS])
{
    stability_plate_seen(x, stability_glass_seen, cells);
}

static inline void exact_metal_plate(double x, double cells[STABILITY_CELLS])
{
    stability_plate_seen(x, stability_copper_seen, cells);
}

#endif
