#include "scene/emission.h"

#include "scene/scene.h"
#include "scene/triangle.h"

#include <string.h>

#define GRID      64   /* least points along each side of a grid */
#define GRID_PART 1024 /* most over a triangle or a quadric */
#define GRID_PEAK 8192 /* most over the unit square, once a lamp */
#define FLOOR     1e-3 /* least mean over the peak, where a grid is coarser than texels */

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

/* Texels along the unit square's sides, of the finest picture that the texture is of. */
static void count_texels(const struct texture *texture, double count[2])
{
    const struct texture_image *image = texture->image;
    double size[2] = {image ? image->width : 2.0, image ? image->height : 2.0};
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < 2; k++)
            count[axis] = fmax(count[axis], size[k] * fabs(texture->uv[k][axis]));
    for (int k = 0; k < 3; k++)
        if (texture->of[k])
            count_texels(texture->of[k], count);
}

/* Points for so many texels; more than `most` are not taken. */
static int grid_size(double texels, int most)
{
    return texels < most ? (int)fmax(GRID, ceil(texels - 1e-6)) : most;
}

/* Over the unit square: the mean, and the largest component. */
static struct rgb square_mean(const struct texture *texture, double *peak)
{
    double texels[2] = {0.0, 0.0};
    count_texels(texture, texels);
    int width = grid_size(texels[0], GRID_PEAK), height = grid_size(texels[1], GRID_PEAK);
    struct rgb sum = rgb_grey(0.0);
    *peak = 0.0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            struct rgb value = texture_eval_uv(texture, (x + 0.5) / width,
                                               (y + 0.5) / height);
            sum = rgb_add(sum, value);
            *peak = fmax(*peak, rgb_max(value));
        }
    return rgb_scale(sum, 1.0 / ((double)width * height));
}

/* mean: of the texture. */
static void split(struct scene_desc *desc, size_t id, struct rgb mean)
{
    struct shape_desc whole = desc->shapes[id];
    struct mesh *mesh = whole.mesh;
    if (mesh->triangle_count > EMISSION_TRIANGLES) {
        log_note(&desc->log, &whole.place,
                 "a textured lamp of more than %d triangles shines by the texture's mean",
                 EMISSION_TRIANGLES);
        desc->shapes[id].radiance = rgb_mul(whole.radiance, mean);
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
        struct shape_desc *shape = &desc->shapes[i];
        if (!shape->emits || !shape->emission)
            continue;
        struct rgb mean = square_mean(shape->emission, &shape->emission_peak);
        if (shape->mesh && shape->mesh->triangle_count > 1 && !is_affine(shape->mesh))
            split(desc, i, mean);
    }
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

/* Texels along the longer side of what a part of the shape has of the texture. */
static double part_texels(const struct shape *shape, uint32_t triangle,
                          const double texels[2])
{
    double most = 0.0;
    if (shape->quadric)
        return fmax(texels[0], texels[1]);
    const struct triangles *mesh = &shape->triangles;
    struct patch part = patch_of(mesh->p, mesh->uv, mesh->index + 3 * (size_t)triangle);
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, texels[axis] *
                                  fabs(part.uv[k][axis] - part.uv[(k + 1) % 3][axis]));
    return most;
}

/* Of n x n points that are uniform in area. A triangle's are the centroids of its n^2
 * equal parts; those of the parts that stand upside down are mirrored ones of the
 * upright.
 */
static struct ray_endpoint grid_point(const struct shape *shape, uint32_t triangle, int i,
                                      int j, int n)
{
    if (shape->quadric)
        return quadric_sample(shape->quadric,
                              (const double[2]){(i + 0.5) / n, (j + 0.5) / n});
    double x = (i + 1.0 / 3.0) / n, y = (j + 1.0 / 3.0) / n;
    bool mirrored = i + j >= n;
    return triangle_point(&shape->triangles, triangle, (float)(mirrored ? 1.0 - x : x),
                          (float)(mirrored ? 1.0 - y : y));
}

static struct rgb part_mean(const struct light *light, const struct shape *shape,
                            uint32_t triangle, int n)
{
    struct rgb sum = rgb_grey(0.0);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            struct ray_endpoint point = grid_point(shape, triangle, i, j, n);
            sum = rgb_add(sum, emission_value(light, &point));
        }
    return rgb_scale(sum, 1.0 / ((double)n * n));
}

struct rgb emission_build(const struct scene *scene, struct light *light,
                          const struct texture *texture, double peak)
{
    const struct shape *shape = &scene->shapes[light->shape];
    light->map = (struct emission_map){.texture = texture, .quadric = shape->quadric};
    if (!shape->quadric)
        set_map(&shape->triangles, &light->map);
    struct rgb sum = rgb_grey(0.0);
    double area = 0.0, texels[2] = {0.0, 0.0};
    bool coarse = false;
    count_texels(texture, texels);
    uint32_t count = shape->quadric ? 1 : shape->triangles.count;
    for (uint32_t t = 0; t < count; t++) {
        double share = shape->quadric ? 1.0 : triangle_area(&shape->triangles, t);
        double wanted = part_texels(shape, t, texels);
        struct rgb part = part_mean(light, shape, t, grid_size(wanted, GRID_PART));
        coarse = coarse || wanted > GRID_PART;
        sum = rgb_add(sum, rgb_scale(part, share));
        area += share;
    }
    if (area > 0.0)
        sum = rgb_scale(sum, 1.0 / area);
    return coarse && rgb_max(sum) < FLOOR * peak ? rgb_grey(FLOOR * peak) : sum;
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
    /* cppcheck-suppress returnDanglingLifetime; a colour holds no pointer */
    return texture_eval(map->texture, &at);
}
