#include "scene/emission.h"

#include "math/warp.h"
#include "scene/scene.h"
#include "scene/triangle.h"

#include <string.h>

#define GRID 64 /* points along each side of a grid */

/* A triangle's corners and their parameters. */
struct patch {
    double p[3][3], uv[3][2];
};

/* Meshes without parameters take the corners (0,0), (1,0), (1,1), as at hits. */
static struct patch patch_of(const float *p, const float *uv, const uint32_t corner[3])
{
    static const double defaults[3][2] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
    struct patch patch;
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++)
            patch.p[k][c] = (double)p[3 * (size_t)corner[k] + (size_t)c];
        for (int c = 0; c < 2; c++)
            patch.uv[k][c] = uv ? (double)uv[2 * (size_t)corner[k] + (size_t)c]
                                : defaults[k][c];
    }
    return patch;
}

/* The affine map of places to one parameter that is right at the three corners and has
 * its gradient in their plane; false where they span none. */
static bool map_of(const struct patch *patch, int which, double map[4])
{
    double e[2][3], rise[2], g[3];
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3; c++)
            e[k][c] = patch->p[k + 1][c] - patch->p[0][c];
        rise[k] = patch->uv[k + 1][which] - patch->uv[0][which];
    }
    double aa = 0.0, ab = 0.0, bb = 0.0;
    for (int c = 0; c < 3; c++) {
        aa += e[0][c] * e[0][c];
        ab += e[0][c] * e[1][c];
        bb += e[1][c] * e[1][c];
    }
    /* The gradient is the sum of both edges that rises by `rise` along them. */
    double determinant = aa * bb - ab * ab;
    map[3] = patch->uv[0][which];
    if (!(determinant > 1e-12 * aa * bb))
        return false;
    double x = (rise[0] * bb - rise[1] * ab) / determinant;
    double y = (rise[1] * aa - rise[0] * ab) / determinant;
    for (int c = 0; c < 3; c++) {
        g[c] = x * e[0][c] + y * e[1][c];
        map[c] = g[c];
        map[3] -= g[c] * patch->p[0][c];
    }
    return true;
}

static double map_at(const double map[4], const double p[3])
{
    return map[0] * p[0] + map[1] * p[1] + map[2] * p[2] + map[3];
}

/* Whether one affine map gives the parameters of all corners, within 1e-4. */
static bool is_affine(const struct mesh *mesh)
{
    double map[2][4];
    bool found = false;
    for (uint32_t i = 0; i < mesh->triangle_count && !found; i++) {
        struct patch patch = patch_of(mesh->p, mesh->uv, mesh->index + 3 * (size_t)i);
        found = map_of(&patch, 0, map[0]) && map_of(&patch, 1, map[1]);
    }
    for (uint32_t i = 0; i < mesh->triangle_count && found; i++) {
        struct patch patch = patch_of(mesh->p, mesh->uv, mesh->index + 3 * (size_t)i);
        for (int k = 0; k < 6; k++)
            if (fabs(map_at(map[k % 2], patch.p[k / 2]) - patch.uv[k / 2][k % 2]) > 1e-4)
                return false;
    }
    return true;
}

static struct mesh *one_triangle(const struct mesh *mesh, uint32_t triangle)
{
    struct mesh *one = mesh_create(3, 1, mesh->n != NULL, true);
    const uint32_t *corner = mesh->index + 3 * (size_t)triangle;
    struct patch patch = patch_of(mesh->p, mesh->uv, corner);
    for (size_t k = 0; k < 3; k++) {
        memcpy(one->p + 3 * k, mesh->p + 3 * (size_t)corner[k], 3 * sizeof *one->p);
        if (mesh->n)
            memcpy(one->n + 3 * k, mesh->n + 3 * (size_t)corner[k], 3 * sizeof *one->n);
        one->uv[2 * k] = (float)patch.uv[k][0];
        one->uv[2 * k + 1] = (float)patch.uv[k][1];
        one->index[k] = (uint32_t)k;
    }
    return one;
}

static struct rgb square_mean(const struct texture *texture)
{
    struct rgb sum = rgb_grey(0.0);
    for (int i = 0; i < GRID * GRID; i++)
        sum = rgb_add(sum, texture_eval_uv(texture, (i % GRID + 0.5) / GRID,
                                           ((double)(i / GRID) + 0.5) / GRID));
    return rgb_scale(sum, 1.0 / (GRID * GRID));
}

static void split(struct scene_desc *desc, size_t id)
{
    struct shape_desc whole = desc->shapes[id];
    struct mesh *mesh = whole.mesh;
    if (mesh->triangle_count > EMISSION_TRIANGLES) {
        log_note(&desc->log, &whole.place,
                 "a textured lamp of more than %d triangles shines by the texture's mean",
                 EMISSION_TRIANGLES);
        desc->shapes[id].radiance = rgb_mul(whole.radiance, square_mean(whole.emission));
        desc->shapes[id].emission = NULL;
        return;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct shape_desc part = whole;
        part.mesh = one_triangle(mesh, i);
        if (i == 0)
            desc->shapes[id] = part;
        else
            scene_desc_add_shape(desc, &part);
    }
    mesh_destroy(mesh);
}

void emission_split(struct scene_desc *desc)
{
    size_t count = desc->shape_count; /* parts follow behind */
    for (size_t i = 0; i < count; i++) {
        const struct shape_desc *shape = &desc->shapes[i];
        if (shape->emits && shape->emission && shape->mesh &&
            shape->mesh->triangle_count > 1 && !is_affine(shape->mesh))
            split(desc, i);
    }
}

double emission_max(const struct texture *texture)
{
    double max = 0.0;
    for (int i = 0; i < GRID * GRID; i++)
        max = fmax(max, rgb_max(texture_eval_uv(texture, (i % GRID + 0.5) / GRID,
                                                ((double)(i / GRID) + 0.5) / GRID)));
    return max;
}

static void set_map(const struct triangles *mesh, struct emission_map *map)
{
    for (uint32_t i = 0; i < mesh->count; i++) {
        struct patch patch = patch_of(mesh->p, mesh->uv, mesh->index + 3 * (size_t)i);
        if (map_of(&patch, 0, map->u) && map_of(&patch, 1, map->v))
            return;
        for (int c = 0; c < 3; c++)
            map->u[c] = map->v[c] = 0.0;
    }
}

/* A point of the shape; u: a cell of the grid, uniform in area over a triangle. */
static struct ray_endpoint grid_point(const struct shape *shape, uint32_t triangle,
                                      const double u[2])
{
    if (shape->quadric)
        return quadric_sample(shape->quadric, u);
    struct vec2 b = warp_triangle(u);
    return triangle_point(&shape->triangles, triangle, (float)b.x, (float)b.y);
}

struct rgb emission_build(const struct scene *scene, struct light *light,
                          const struct texture *texture)
{
    const struct shape *shape = &scene->shapes[light->shape];
    light->map = (struct emission_map){.texture = texture, .quadric = shape->quadric};
    if (!shape->quadric)
        set_map(&shape->triangles, &light->map);
    struct rgb sum = rgb_grey(0.0);
    double area = 0.0;
    uint32_t count = shape->quadric ? 1 : shape->triangles.count;
    for (uint32_t t = 0; t < count; t++) {
        double share = shape->quadric ? 1.0 : triangle_area(&shape->triangles, t);
        struct rgb part = rgb_grey(0.0);
        for (int i = 0; i < GRID * GRID; i++) {
            const double u[2] = {(i % GRID + 0.5) / GRID,
                                 ((double)(i / GRID) + 0.5) / GRID};
            struct ray_endpoint point = grid_point(shape, t, u);
            part = rgb_add(part, emission_value(light, &point));
        }
        sum = rgb_add(sum, rgb_scale(part, share / (GRID * GRID)));
        area += share;
    }
    return area > 0.0 ? rgb_scale(sum, 1.0 / area) : sum;
}

struct rgb emission_value(const struct light *light, const struct ray_endpoint *point)
{
    const struct emission_map *map = &light->map;
    struct texture_point at = {
        .p = {(double)point->p.x, (double)point->p.y, (double)point->p.z}};
    if (map->quadric) {
        float uv[2];
        struct vec3 dpdu;
        quadric_parameters(map->quadric, at.p, uv, &dpdu);
        at.u = (double)uv[0];
        at.v = (double)uv[1];
    } else {
        at.u = map_at(map->u, at.p);
        at.v = map_at(map->v, at.p);
    }
    return texture_eval(map->texture, &at);
}
