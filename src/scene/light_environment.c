#include "base/mem.h"
#include "math/warp.h"
#include "scene/light.h"
#include "scene/scene_desc.h"

/* Radiance from infinity, from all sides: one constant, or a picture over longitude and
 * latitude or over the unfolded octahedron (pbrt v4's), interpolated between texel
 * centres. Directions follow its luminance, constant within each texel's cell: the exact
 * mean there of the interpolated picture, so that wherever it shines there is a density.
 *
 * MIS compensation [Karlik19]: the mean over the sphere is subtracted from the density,
 * as directions of about that brightness are sampled well by camera paths that leave the
 * scene (s = 0), and MIS leaves these directions to them. As no direction is a delta,
 * every such path can be sampled with s = 0, so even a density of 0 where the map is
 * dimmer than its mean would be unbiased. But a share of the luminance is kept as the
 * least density, so that light paths start in all directions, and a direction that is
 * rounded into a neighbouring cell is not divided by 0. */

#define LEAST_SHARE 0.05

static double lat_sine(const double d[3])
{
    return sqrt(d[0] * d[0] + d[1] * d[1]);
}

/* The direction from which the light of point w comes, in the map's space. */
static void to_local(const struct environment *e, struct vec3 w, double d[3])
{
    double v[3] = {-(double)w.x, -(double)w.y, -(double)w.z};
    for (int i = 0; i < 3; i++)
        d[i] = e->to_local[i][0] * v[0] + e->to_local[i][1] * v[1] +
               e->to_local[i][2] * v[2];
}

static void to_map(const struct environment *e, const double d[3], double point[2])
{
    if (e->octahedral) {
        warp_octahedron_inverse(d, point);
        return;
    }
    /* Longitude and latitude [Pharr16, section 14.2.4]. */
    double u = atan2(d[1], d[0]) / (2.0 * MATH_PI);
    point[0] = fmin(u < 0.0 ? u + 1.0 : u, WARP_BELOW_ONE);
    point[1] = fmin(atan2(lat_sine(d), d[2]) / MATH_PI, WARP_BELOW_ONE);
}

/* Beyond an edge of the octahedron's square lies the same edge, the other way round. */
static void wrap_octahedral(const struct texture_image *map, int *x, int *y)
{
    if (*x < 0 || *x >= map->width) {
        *x = *x < 0 ? -1 - *x : 2 * map->width - 1 - *x;
        *y = map->height - 1 - *y;
    }
    if (*y < 0 || *y >= map->height) {
        *y = *y < 0 ? -1 - *y : 2 * map->height - 1 - *y;
        *x = map->width - 1 - *x;
    }
}

/* Column wraps round, row stops at the poles. */
static struct rgb map_texel(const struct environment *e, int x, int y)
{
    const struct texture_image *map = e->map;
    if (e->octahedral)
        wrap_octahedral(map, &x, &y);
    x = x < 0 ? x + map->width : x >= map->width ? x - map->width : x;
    y = y < 0 ? 0 : y >= map->height ? map->height - 1 : y;
    return texture_image_texel(map, x, y);
}

static struct rgb map_lookup(const struct environment *e, const double point[2])
{
    const struct texture_image *map = e->map;
    double x = point[0] * map->width - 0.5, y = point[1] * map->height - 0.5;
    int i = (int)floor(x), j = (int)floor(y);
    double a = x - i, b = y - j;
    struct rgb top = rgb_add(rgb_scale(map_texel(e, i, j), 1.0 - a),
                             rgb_scale(map_texel(e, i + 1, j), a));
    struct rgb low = rgb_add(rgb_scale(map_texel(e, i, j + 1), 1.0 - a),
                             rgb_scale(map_texel(e, i + 1, j + 1), a));
    return rgb_add(rgb_scale(top, 1.0 - b), rgb_scale(low, b));
}

static struct rgb light_environment_emission(const struct light *light,
                                             const struct ray_endpoint *point,
                                             struct vec3 w)
{
    (void)point;
    const struct environment *e = &light->environment;
    double d[3], at[2];
    if (!e->map)
        return light->radiance;
    to_local(e, w, d);
    to_map(e, d, at);
    return rgb_mul(map_lookup(e, at), light->radiance);
}

/* Mean luminance over a texel's cell: with bilinear interpolation between centres the
 * weights are 3/4 for the texel and 1/8 for each neighbour, in both axes. */
static double cell_mean(const struct environment *e, struct rgb tint, int x, int y)
{
    static const double share[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum += share[i + 1] * share[j + 1] *
                   rgb_luminance(rgb_mul(map_texel(e, x + i, y + j), tint));
    return sum;
}

/* Solid angle of a texel's cell. */
static double cell_solid(const struct environment *e, size_t y)
{
    const struct texture_image *map = e->map;
    if (e->octahedral)
        return 4.0 * MATH_PI / ((double)map->width * map->height);
    return 2.0 * MATH_PI / map->width *
           (cos(MATH_PI * (double)y / map->height) -
            cos(MATH_PI * (double)(y + 1) / map->height));
}

/* Subtracts the mean over the sphere; `sum` is the integral. */
static void compensate(const struct environment *e, double sum, double *weights)
{
    size_t width = (size_t)e->map->width, height = (size_t)e->map->height;
    for (size_t y = 0; y < height; y++) {
        double mean = sum / (4.0 * MATH_PI) * cell_solid(e, y);
        for (size_t x = 0; x < width; x++) {
            double *weight = &weights[y * width + x];
            /* MIS compensation [Karlik19]. */
            *weight = fmax(*weight - mean, LEAST_SHARE * *weight);
        }
    }
}

/* Fills the density; returns the integral of luminance over the sphere. */
static double build_density(struct environment *e, struct rgb tint)
{
    const struct texture_image *map = e->map;
    size_t width = (size_t)map->width, height = (size_t)map->height;
    double *weights = mem_alloc(width * height, sizeof *weights), sum = 0.0;
    for (size_t y = 0; y < height; y++) {
        double solid = cell_solid(e, y);
        for (size_t x = 0; x < width; x++) {
            double *weight = &weights[y * width + x];
            *weight = cell_mean(e, tint, (int)x, (int)y) * solid;
            sum += *weight;
        }
    }
    compensate(e, sum, weights);
    if (!dist2_build(&e->density, weights, map->width, map->height))
        sum = 0.0;
    mem_free(weights);
    return sum;
}

/* The inverse of to_world's linear part without its scale; false unless it is a rotation,
 * with or without a reflection. The scale by squares, exact for powers of two. */
static bool build_rotation(const struct xform *to_world, double to_local[3][3])
{
    const double(*m)[4] = to_world->m;
    double squares = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            squares += m[i][j] * m[i][j];
    double scale = sqrt(squares / 3.0);
    if (!(scale > 0.0) || !isfinite(scale))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to_local[i][j] = m[j][i] / scale;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++)
                dot += to_local[i][k] * to_local[j][k];
            if (fabs(dot - (i == j ? 1.0 : 0.0)) > 1e-3)
                return false;
        }
    return true;
}

static bool light_environment_build(const struct light_desc *desc, struct light *light,
                                    struct err *err)
{
    struct environment *e = &light->environment;
    e->map = desc->map;
    e->octahedral = desc->octahedral;
    light->infinite = true;
    if (!build_rotation(&desc->to_world, e->to_local))
        return err_set(err, ERR_VALUE, &desc->place,
                       "the transform of an environment must be a rotation");
    double integral = e->map ? build_density(e, light->radiance)
                             : 4.0 * MATH_PI * rgb_luminance(light->radiance);
    light->power = integral / light_enter_pdf(light);
    return true;
}

static void from_map(const struct environment *e, const double at[2], double d[3])
{
    if (e->octahedral) {
        warp_octahedron(at, d);
        return;
    }
    double phi = 2.0 * MATH_PI * at[0], theta = MATH_PI * at[1], sine = sin(theta);
    d[0] = sine * cos(phi);
    d[1] = sine * sin(phi);
    d[2] = cos(theta);
}

static void light_environment_sample_point(const struct scene *scene,
                                           const struct light *light, const double u[2],
                                           struct ray_endpoint *point)
{
    (void)scene;
    const struct environment *e = &light->environment;
    double at[2], pdf;
    if (!e->map) {
        *point = (struct ray_endpoint){.ng = vec3_neg(warp_sphere(u))};
        return;
    }
    dist2_sample(&e->density, u, at, &pdf);
    double d[3], w[3];
    from_map(e, at, d);
    for (int i = 0; i < 3; i++)
        w[i] = e->to_local[0][i] * d[0] + e->to_local[1][i] * d[1] +
               e->to_local[2][i] * d[2];
    *point = (struct ray_endpoint){.ng = {(float)-w[0], (float)-w[1], (float)-w[2]}};
}

static bool light_environment_invert_point(const struct scene *scene,
                                           const struct light *light,
                                           const struct hit *point, double u[2])
{
    const struct environment *e = &light->environment;
    double d[3], at[2];
    (void)scene;
    if (!e->map) {
        warp_sphere_inverse(vec3_neg(point->at.ng), u);
        return warp_in_square(u);
    }
    to_local(e, point->at.ng, d);
    to_map(e, d, at);
    return dist2_invert(&e->density, at, u);
}

static double light_environment_pdf_point(const struct light *light,
                                          const struct ray_endpoint *point)
{
    const struct environment *e = &light->environment;
    double d[3], at[2];
    if (!e->map)
        return 1.0 / (4.0 * MATH_PI);
    to_local(e, point->ng, d);
    to_map(e, d, at);
    if (e->octahedral)
        return dist2_pdf(&e->density, at) / (4.0 * MATH_PI);
    /* p(u,v) / (2 pi^2 sin theta) [Pharr16, section 14.2.4].
     * No sample falls on a pole itself; the bound keeps a rounded one finite. */
    return dist2_pdf(&e->density, at) /
           (2.0 * MATH_PI * MATH_PI * fmax(lat_sine(d), 1e-9));
}

static bool light_environment_sample_direction(const struct light *light,
                                               struct ray_endpoint *point,
                                               const double u[2], struct vec3 *w,
                                               double *pdf, struct rgb *weight)
{
    light_enter(light, point, u, w, pdf);
    *weight = rgb_scale(light_environment_emission(light, point, *w), 1.0 / *pdf);
    return !rgb_is_black(*weight);
}

static double light_environment_pdf_direction(const struct light *light,
                                              const struct ray_endpoint *point,
                                              struct vec3 w)
{
    (void)point, (void)w;
    return light_enter_pdf(light);
}

const struct light_type light_environment = {
    .name = "environment",
    .build = light_environment_build,
    .sample_point = light_environment_sample_point,
    .emission = light_environment_emission,
    .pdf_point = light_environment_pdf_point,
    .sample_direction = light_environment_sample_direction,
    .pdf_direction = light_environment_pdf_direction,
    .invert_point = light_environment_invert_point,
    .invert_direction = light_enter_invert,
};
