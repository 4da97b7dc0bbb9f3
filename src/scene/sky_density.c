#include "scene/sky_density.h"

#include "base/mem.h"
#include "math/warp.h"

#define LEAST_SHARE  0.05
#define FRINGE_SHARE 0.001 /* of the brightest cell near, for a black one */
#define SIZE_MOST    1024
#define BRIGHT_SHARE 1e-5 /* of all light, which makes a texel bright */
#define BRIGHT_FINER 4    /* its points, along an axis */
#define REACH        2    /* cells; they are up to twice as long as wide */
#define SIDE         DIST_TREE_SIDE

/* Cells of the square, gathered from points of the texels: the mean luminance of the
 * points that lie in a cell becomes that of the cell. */
struct gathering {
    int size;
    double *sum, *area; /* [size][size]; area: the points' solid angle */
};

/* Mean luminance over a texel's cell: with bilinear interpolation between centres the
 * weights are 3/4 for the texel and 1/8 for each neighbour, in both axes. */
static double texel_mean(const struct sky_map *map, struct rgb tint, int x, int y)
{
    static const double share[3] = {0.125, 0.75, 0.125};
    struct rgb sum = {0};
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum = rgb_add(sum, rgb_scale(sky_map_texel(map, x + i, y + j),
                                         share[i + 1] * share[j + 1]));
    return rgb_luminance(rgb_mul(sum, tint));
}

/* Solid angle of a texel of row y. */
static double texel_solid(const struct sky_map *map, int y)
{
    if (map->octahedral)
        return 4.0 * MATH_PI / ((double)map->width * map->height);
    return 2.0 * MATH_PI / map->width *
           (cos(MATH_PI * (double)y / map->height) -
            cos(MATH_PI * (double)(y + 1) / map->height));
}

/* Points a texel of row y has along an axis, for a distance of a cell of the square. */
static void texel_points(const struct sky_map *map, int y, int size, int points[2])
{
    double across = sqrt(4.0 * MATH_PI) / map->width,
           down = sqrt(4.0 * MATH_PI) / map->height;
    if (!map->octahedral) {
        double sine = fmax(sin(MATH_PI * y / map->height),
                           sin(MATH_PI * (y + 1) / map->height)); /* where it is widest */
        across = 2.0 * MATH_PI / map->width * sine;
        down = MATH_PI / map->height;
    }
    double cell = sqrt(4.0 * MATH_PI) / size;
    points[0] = (int)ceil(across / cell);
    points[1] = (int)ceil(down / cell);
}

static double luminance_at(const struct sky_map *map, struct rgb tint, const double d[3])
{
    return rgb_luminance(rgb_mul(sky_map_at(map, d), tint));
}

static size_t cell_of(const double d[3], int size)
{
    double at[2];
    warp_octahedron_inverse(d, at);
    return (size_t)(at[1] * size) * (size_t)size + (size_t)(at[0] * size);
}

/* mean: of the texel, taken for all points; NULL to interpolate. */
static void gather_texel(const struct gathering *g, const struct sky_map *map,
                         struct rgb tint, int x, int y, const int points[2],
                         const double *mean)
{
    double area = texel_solid(map, y) / (points[0] * points[1]);
    for (int j = 0; j < points[1]; j++)
        for (int i = 0; i < points[0]; i++) {
            double d[3];
            sky_map_direction(map, x + (i + 0.5) / points[0], y + (j + 0.5) / points[1],
                              d);
            size_t cell = cell_of(d, g->size);
            g->sum[cell] += area * (mean ? *mean : luminance_at(map, tint, d));
            g->area[cell] += area;
        }
}

/* About the integral of luminance: without the interpolation. */
static double rough_integral(const struct sky_map *map, struct rgb tint)
{
    double integral = 0.0;
    for (int y = 0; y < map->height; y++) {
        double row = 0.0;
        for (int x = 0; x < map->width; x++)
            row += rgb_luminance(rgb_mul(sky_map_texel(map, x, y), tint));
        integral += row * texel_solid(map, y);
    }
    return integral;
}

/* Returns the integral of luminance over the sphere. Of bright texels and those beside
 * them the interpolation is followed: half of a texel beside a sun is black. The number
 * of points is even, as the interpolation has its kinks at the texel's centre. */
static double gather(const struct gathering *g, const struct sky_map *map,
                     struct rgb tint)
{
    double integral = 0.0, bright = BRIGHT_SHARE * rough_integral(map, tint);
    for (int y = 0; y < map->height; y++) {
        double solid = texel_solid(map, y);
        int points[2], finer[2];
        texel_points(map, y, g->size, points);
        texel_points(map, y, BRIGHT_FINER * g->size, finer);
        for (int k = 0; k < 2; k++)
            finer[k] += finer[k] % 2;
        for (int x = 0; x < map->width; x++) {
            double mean = texel_mean(map, tint, x, y);
            if (mean * solid > bright)
                gather_texel(g, map, tint, x, y, finer, NULL);
            else
                gather_texel(g, map, tint, x, y, points, &mean);
            integral += mean * solid;
        }
    }
    return integral;
}

/* Mean luminance of each cell, those without points from the picture at their centre;
 * into g->sum. */
static void average(const struct gathering *g, const struct sky_map *map, struct rgb tint)
{
    for (int y = 0; y < g->size; y++)
        for (int x = 0; x < g->size; x++) {
            size_t cell = (size_t)y * (size_t)g->size + (size_t)x;
            double d[3];
            if (g->area[cell] > 0.0) {
                g->sum[cell] /= g->area[cell];
                continue;
            }
            warp_octahedron((const double[2]){(x + 0.5) / g->size, (y + 0.5) / g->size},
                            d);
            g->sum[cell] = luminance_at(map, tint, d);
        }
}

/* Brightest of the cells up to REACH away, across the edges of the square too. */
static double brightest_near(const struct gathering *g, int x, int y)
{
    double most = 0.0;
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            int a = x + i, b = y + j;
            warp_octahedron_wrap(g->size, g->size, &a, &b);
            most = fmax(most, g->sum[(size_t)b * (size_t)g->size + (size_t)a]);
        }
    return most;
}

/* [Karlik19] */
static double compensated(double own, double mean)
{
    return fmax(own - mean, LEAST_SHARE * own);
}

/* The density of each cell, up to a factor, into g->area, as
 * the areas are no longer needed. A texel that shines may reach
 * into a cell that none of its points has met: points are up to a cell apart. Nearly
 * all of these cells are black, so little is spent on them. */
static void compensate(const struct gathering *g, double mean)
{
    for (int y = 0; y < g->size; y++)
        for (int x = 0; x < g->size; x++) {
            size_t cell = (size_t)y * (size_t)g->size + (size_t)x;
            double own = g->sum[cell];
            g->area[cell] = own > 0.0 ? compensated(own, mean)
                                      : FRINGE_SHARE * brightest_near(g, x, y);
        }
}

/* The parts of the bright cells, from the picture. */
struct detail {
    struct dist_tree_detail tree; /* must be first */
    const struct sky_map *map;
    struct rgb tint;
    double mean;
    int size;   /* parts of the square along an axis */
    int points; /* of a part along an axis: at most half a texel apart, two or more */
};

static double part_mean(const struct detail *detail, int x, int y)
{
    double sum = 0.0;
    int n = detail->points;
    warp_octahedron_wrap(detail->size, detail->size, &x, &y);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double d[3];
            const double at[2] = {(x + (i + 0.5) / n) / detail->size,
                                  (y + (j + 0.5) / n) / detail->size};
            warp_octahedron(at, d);
            sum += luminance_at(detail->map, detail->tint, d);
        }
    return sum / (n * n);
}

/* Black parts beside others get their share as black cells do, see compensate. */
static void fill_parts(const struct dist_tree_detail *self, int x, int y,
                       double parts[SIDE * SIDE])
{
    enum { ROW = SIDE + 2 }; /* with the neighbours of the cell */
    const struct detail *detail = (const struct detail *)self;
    double mean[ROW * ROW];
    for (int k = 0; k < ROW * ROW; k++)
        mean[k] = part_mean(detail, SIDE * x + k % ROW - 1, SIDE * y + k / ROW - 1);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double *own = &mean[(k / SIDE + 1) * ROW + k % SIDE + 1];
        double most = 0.0;
        for (int n = 0; n < 9; n++)
            most = fmax(most, own[(n / 3 - 1) * ROW + n % 3 - 1]);
        parts[k] = *own > 0.0 ? compensated(*own, detail->mean) : FRINGE_SHARE * most;
    }
}

static struct detail detail_of(const struct sky_map *map, struct rgb tint, int size,
                               double mean)
{
    double texel = map->octahedral ? 1.0 / map->height /* of the square's side */
                                   : MATH_PI / map->height / sqrt(4.0 * MATH_PI);
    return (struct detail){.tree = {fill_parts},
                           .map = map,
                           .tint = tint,
                           .mean = mean,
                           .size = SIDE * size,
                           .points = (int)fmax(2.0, ceil(2.0 / (SIDE * size * texel)))};
}

/* Two cells a row of the picture, or more. */
static int square_size(const struct sky_map *map)
{
    int size = DIST_TREE_ROOT * DIST_TREE_SIDE;
    while (size < 2 * map->height && size < SIZE_MOST)
        size *= DIST_TREE_SIDE;
    return size;
}

double sky_density_build(struct dist_tree *density, const struct sky_map *map,
                         struct rgb tint)
{
    struct gathering g = {.size = square_size(map)};
    size_t count = (size_t)g.size * (size_t)g.size;
    g.sum = mem_alloc(count, sizeof *g.sum);
    g.area = mem_alloc(count, sizeof *g.area);
    double integral = gather(&g, map, tint);
    average(&g, map, tint);
    double mean = integral / (4.0 * MATH_PI);
    compensate(&g, mean);
    struct detail detail = detail_of(map, tint, g.size, mean);
    if (!dist_tree_build(density, g.area, g.size, &detail.tree))
        integral = 0.0;
    mem_free(g.sum);
    mem_free(g.area);
    return integral;
}

void sky_density_sample(const struct dist_tree *density, const double u[2], double d[3])
{
    double at[2];
    dist_tree_sample(density, u, at);
    warp_octahedron(at, d);
}

bool sky_density_invert(const struct dist_tree *density, const double d[3], double u[2])
{
    double at[2];
    warp_octahedron_inverse(d, at);
    return dist_tree_invert(density, at, u);
}

double sky_density_pdf(const struct dist_tree *density, const double d[3])
{
    double at[2];
    warp_octahedron_inverse(d, at);
    return dist_tree_pdf(density, at) / (4.0 * MATH_PI);
}
