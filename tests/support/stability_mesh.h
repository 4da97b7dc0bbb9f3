#ifndef ETALON_TESTS_SUPPORT_STABILITY_MESH_H
#define ETALON_TESTS_SUPPORT_STABILITY_MESH_H

/* Scenes for support/stability.h made of many or badly made triangles, and long paths
 * between mirrors and white walls. */

#include "support/stability_room.h"

/* --- triangles -------------------------------------------------------------------- */

/* A box of 32 x 32 squares a wall, no two triangles with a corner in common, every one
 * wound as chance has it, and with normals that say where its outside is. */
static inline struct mesh *stability_loose(bool normals)
{
    enum { CUTS = 32, TRIANGLES = 6 * CUTS * CUTS * 2 };
    struct mesh *mesh = mesh_create(3 * TRIANGLES, TRIANGLES, normals, false);
    struct rng rng;
    rng_init(&rng, 9, RNG_TEST, 0);
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        uint32_t side = i / (TRIANGLES / 6), axis = side / 2, cell = i / 2;
        bool turned = rng_double(&rng) < 0.5;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t corner = 3 * i + k;
            bool x = i % 2 ? k != 1 : k == 1, y = i % 2 ? k != 2 : k == 2;
            float *p = mesh->p + 3 * (size_t)corner;
            p[axis] = side % 2 ? 1.0f : -1.0f;
            p[(axis + 1) % 3] = (float)(cell % CUTS + x) * (2.0f / CUTS) - 1.0f;
            p[(axis + 2) % 3] = (float)(cell / CUTS % CUTS + y) * (2.0f / CUTS) - 1.0f;
            if (normals)
                mesh->n[3 * (size_t)corner + axis] = p[axis];
            mesh->index[3 * (size_t)i + k] = turned && k ? 3 * i + 3 - k : corner;
        }
    }
    return mesh;
}

static inline struct scene_desc *make_loose_walls(double x)
{
    struct scene_desc *desc = stability_glowing(stability_loose(x == 1.0));
    desc->shapes[0].two_sided = x == 0.0;
    return desc;
}

/* The square lamp of side 1 of a million triangles, the least of which is (x/.5)^2 as
 * large as the largest. */
static inline struct scene_desc *make_uneven_lamp(double x)
{
    enum { STEPS = 353, LINES = 2 * STEPS + 2 };
    struct scene_desc *desc = stability_patch();
    struct mesh *mesh = mesh_create(LINES * LINES, 2 * (LINES - 1) * (LINES - 1), false,
                                    false);
    float at[LINES];
    for (int i = 0; i <= STEPS; i++) {
        float cut = (float)(x * pow(0.5 / x, (double)i / STEPS));
        at[STEPS + 1 + i] = cut;
        at[STEPS - i] = -cut;
    }
    for (uint32_t i = 0; i < LINES * LINES; i++) {
        mesh->p[3 * i] = at[i / LINES];
        mesh->p[3 * i + 1] = 1.0f;
        mesh->p[3 * i + 2] = at[i % LINES];
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t cell = i / 2, a = cell / (LINES - 1) * LINES + cell % (LINES - 1);
        const uint32_t corners[2][3] = {{a, a + LINES, a + LINES + 1},
                                        {a, a + LINES + 1, a + 1}};
        memcpy(mesh->index + 3 * (size_t)i, corners[i % 2], sizeof corners[0]);
    }
    struct shape_desc lamp = {.kind = SHAPE_MESH,
                              .mesh = mesh,
                              .to_world = xform_identity(),
                              .material = stability_black(desc),
                              .emits = true,
                              .radiance = rgb_grey(1.0)};
    scene_desc_add_shape(desc, &lamp);
    return desc;
}

static inline void exact_uneven_lamp(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    exact_square(1.0, cells);
}

/* Two floors, the second x below the first and reaching further. */
static inline struct scene_desc *make_double_floor(double x)
{
    struct scene_desc *desc = make_square(0.5);
    int floor = test_diffuse(desc, STABILITY_FLOOR, STABILITY_FLOOR, STABILITY_FLOOR);
    test_quad(desc, vec3(0.1f, -(float)x, 0.1f), vec3(0, 0, 3), vec3(3, 0, 0), floor,
              rgb_grey(0.0));
    return desc;
}

#define STABILITY_FINE_FOV 40.0

/* A ball of x triangles and reflectance 1/2 as large as a pixel, under a white sky. */
static inline struct scene_desc *make_fine_ball(double x)
{
    struct scene_desc *desc = test_desc(vec3(0.25f, 0.5f, 4), vec3(0, 0, 0),
                                        STABILITY_FINE_FOV, 4);
    int segments = (int)sqrt(x), rows = segments / 2;
    double *profile = calloc(2 * (size_t)rows + 2, sizeof *profile);
    for (int i = 0; i <= rows; i++) {
        profile[2 * i] = i == 0 || i == rows ? 0.0 : 0.36 * sin(MATH_PI * i / rows);
        profile[2 * i + 1] = -0.36 * cos(MATH_PI * i / rows);
    }
    struct shape_desc ball = {.kind = SHAPE_MESH,
                              .mesh = mesh_lathe(profile, rows + 1, segments, false, 0.0),
                              .to_world = xform_identity(),
                              .material = test_diffuse(desc, 0.5, 0.5, 0.5)};
    free(profile);
    scene_desc_add_shape(desc, &ball);
    stability_sky(desc, NULL);
    return desc;
}

/* A polygon's area is less than the circle's by 2 pi^2 / (3 n^2); that much of the disk
 * is the precision of a ball of n segments. */
static inline void exact_fine_ball(double x, double cells[STABILITY_CELLS])
{
    (void)x;
    double sine2 = 0.36 * 0.36 / (0.25 * 0.25 + 0.5 * 0.5 + 16.0);
    double t = tan(0.5 * STABILITY_FINE_FOV * MATH_PI / 180.0);
    double disk = MATH_PI * sine2 / (1.0 - sine2) / (4.0 * t * t);
    stability_same(1.0 - 0.5 * disk, cells);
}

/* --- surfaces that touch ---------------------------------------------------------- */

/* A ball of glass in which a hole of half its size comes to within x of the surface. */
static inline struct scene_desc *make_hollow_ball(double x)
{
    struct scene_desc *desc = stability_white(20.0);
    int glass = stability_glass(desc, "dielectric", 1.5);
    test_sphere(desc, vec3(0, 0, 0), 1.0, glass, rgb_grey(0.0), false);
    test_sphere(desc, vec3(0, 0, (float)(0.5 - x)), 0.5, glass, rgb_grey(0.0), true);
    return desc;
}

/* Two balls of glass, x apart. */
static inline struct scene_desc *make_touching_balls(double x)
{
    struct scene_desc *desc = stability_white(20.0);
    int glass = stability_glass(desc, "dielectric", 1.5);
    test_sphere(desc, vec3(0, 0, 0), 0.5, glass, rgb_grey(0.0), false);
    test_sphere(desc, vec3(0, 0, (float)(1.0 + x)), 0.5, glass, rgb_grey(0.0), false);
    return desc;
}

/* --- long paths ------------------------------------------------------------------- */

/* The ball of make_glowing_ball in white, or of mirror in the shape of a box, emitting
 * 1/x: each of the x lengths of path brings as much. */
static inline struct scene_desc *stability_deep(double x, const char *kind, bool box)
{
    struct scene_desc *desc = stability_inside();
    struct shape_desc walls = {.kind = box ? SHAPE_MESH : SHAPE_SPHERE,
                               .mesh = box ? mesh_box() : NULL,
                               .radius = 1.0,
                               .to_world = xform_identity(),
                               .reverse_orientation = true,
                               .emits = true,
                               .radiance = rgb_grey(1.0 / x)};
    walls.material = test_material(desc, kind, "reflectance", rgb_grey(1.0), NULL, 0.0);
    scene_desc_add_shape(desc, &walls);
    return desc;
}

static inline struct scene_desc *make_white_ball(double x)
{
    return stability_deep(x, "diffuse", false);
}

static inline struct scene_desc *make_mirror_box(double x)
{
    return stability_deep(x, "mirror", true);
}

#define STABILITY_MIRROR 0.99

/* Between two mirrors out to the sky after x - 1 bounces. */
static inline struct scene_desc *make_corridor(double x)
{
    double slope = x - 1.0;
    struct scene_desc *desc = test_desc(vec3(0, 0, 0), vec3(0, (float)slope, 1), 0.01, 4);
    double eye[3] = {0, 0, 0}, target[3] = {0, slope, 1}, up[3] = {1, 0, 0};
    if (!xform_look_at(eye, target, up, &desc->camera.to_world))
        abort();
    int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(STABILITY_MIRROR),
                               NULL, 0.0);
    for (int side = -1; side < 2; side += 2)
        test_quad(desc, vec3(0, 0.5f * (float)side, 0), vec3(0, 0, 1), vec3(1, 0, 0),
                  mirror, rgb_grey(0.0));
    stability_sky(desc, NULL);
    return desc;
}

static inline void exact_corridor(double x, double cells[STABILITY_CELLS])
{
    stability_same(pow(STABILITY_MIRROR, x - 1.0), cells);
}

#endif
