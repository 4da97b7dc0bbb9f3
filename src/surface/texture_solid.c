/* Textures of the place, and dots, which take noise too [Pharr16, section 10.6]. */

#include "surface/perlin.h"
#include "surface/texture_kind.h"

#include <math.h>

/* The texture's own place times a scale; one outside the range of integers becomes 0. */
static void place_solid(const struct texture *t, const struct texture_point *at,
                        double scale, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = scale * (t->space[i][0] * at->p[0] + t->space[i][1] * at->p[1] +
                          t->space[i][2] * at->p[2] + t->space[i][3]);
    if (!(fabs(out[0]) < 1e9 && fabs(out[1]) < 1e9 && fabs(out[2]) < 1e9))
        out[0] = out[1] = out[2] = 0.0;
}

/* Weights above 1 can make a sum too large for a double. */
static double finite_or_0(double value)
{
    return isfinite(value) ? value : 0.0;
}

static struct rgb eval_checkerboard_3d(const struct texture *t,
                                       const struct texture_point *at)
{
    double p[3];
    place_solid(t, at, 1.0, p);
    bool odd = ((long)floor(p[0]) + (long)floor(p[1]) + (long)floor(p[2])) % 2 != 0;
    return texture_eval(t->of[odd], at);
}

#define DOT_RADIUS 0.35
#define DOT_SHIFT  (0.5 - DOT_RADIUS)

/* Noise decides whether a square has a dot, and where in it. */
static bool in_dot(double s, double r)
{
    double i = floor(s + 0.5), j = floor(r + 0.5);
    if (!(perlin_noise(i + 0.5, j + 0.5, 0.5) > 0.0))
        return false;
    double x = s - i - DOT_SHIFT * perlin_noise(i + 1.5, j + 2.8, 0.5);
    double y = r - j - DOT_SHIFT * perlin_noise(i + 4.5, j + 9.8, 0.5);
    return x * x + y * y < DOT_RADIUS * DOT_RADIUS;
}

static struct rgb eval_dots(const struct texture *t, const struct texture_point *at)
{
    double s, r;
    texture_place_uv(t, at, &s, &r);
    return texture_eval(t->of[in_dot(s, r) ? 0 : 1], at);
}

static struct rgb eval_fbm(const struct texture *t, const struct texture_point *at)
{
    double p[3];
    place_solid(t, at, 1.0, p);
    return rgb_grey(finite_or_0(perlin_fbm(p, t->noise.roughness, t->noise.octaves)));
}

static struct rgb eval_wrinkled(const struct texture *t, const struct texture_point *at)
{
    double p[3];
    place_solid(t, at, 1.0, p);
    return rgb_grey(
        finite_or_0(perlin_turbulence(p, t->noise.roughness, t->noise.octaves)));
}

/* The strength of the wind, of low frequency, scales the waves. */
static struct rgb eval_windy(const struct texture *t, const struct texture_point *at)
{
    double p[3];
    place_solid(t, at, 1.0, p);
    const double slow[3] = {0.1 * p[0], 0.1 * p[1], 0.1 * p[2]};
    return rgb_grey(fabs(perlin_fbm(slow, 0.5, 3)) * perlin_fbm(p, 0.5, 6));
}

static struct rgb mix(struct rgb a, struct rgb b, double share)
{
    return rgb_add(rgb_scale(a, 1.0 - share), rgb_scale(b, share));
}

/* Cubic Bezier pieces through four of nine colours each, by de Casteljau, t in [0,1]. */
static struct rgb marble_colour(double t)
{
    static const struct rgb colours[] = {
        {0.58, 0.58, 0.6}, {0.58, 0.58, 0.6}, {0.58, 0.58, 0.6},
        {0.5, 0.5, 0.5},   {0.6, 0.59, 0.58}, {0.58, 0.58, 0.6},
        {0.58, 0.58, 0.6}, {0.2, 0.2, 0.33},  {0.58, 0.58, 0.6},
    };
    const int pieces = sizeof colours / sizeof colours[0] - 3;
    int first = (int)fmin(floor(t * pieces), pieces - 1);
    double share = t * pieces - first;
    struct rgb c[4];
    for (int i = 0; i < 4; i++)
        c[i] = colours[first + i];
    for (int left = 3; left > 0; left--)
        for (int i = 0; i < left; i++)
            c[i] = mix(c[i], c[i + 1], share);
    return rgb_scale(c[0], 1.5);
}

static struct rgb eval_marble(const struct texture *t, const struct texture_point *at)
{
    double p[3];
    place_solid(t, at, t->noise.scale, p);
    double veins = p[1] + t->noise.variation *
                              perlin_fbm(p, t->noise.roughness, t->noise.octaves);
    return marble_colour(0.5 + 0.5 * sin(finite_or_0(veins)));
}

struct texture *texture_checkerboard_3d(struct texture_set *set, const struct texture *a,
                                        const struct texture *b)
{
    struct texture *t = texture_add(set, eval_checkerboard_3d);
    texture_set_part(t, 0, a);
    texture_set_part(t, 1, b);
    return t;
}

struct texture *texture_dots(struct texture_set *set, const struct texture *inside,
                             const struct texture *outside)
{
    struct texture *t = texture_add(set, eval_dots);
    texture_set_part(t, 0, inside);
    texture_set_part(t, 1, outside);
    return t;
}

struct texture *texture_fbm(struct texture_set *set, int octaves, double roughness)
{
    struct texture *t = texture_add(set, eval_fbm);
    t->noise = (struct texture_noise){.octaves = octaves, .roughness = roughness};
    return t;
}

struct texture *texture_wrinkled(struct texture_set *set, int octaves, double roughness)
{
    struct texture *t = texture_add(set, eval_wrinkled);
    t->noise = (struct texture_noise){.octaves = octaves, .roughness = roughness};
    return t;
}

struct texture *texture_windy(struct texture_set *set)
{
    return texture_add(set, eval_windy);
}

struct texture *texture_marble(struct texture_set *set, const struct texture_noise *noise)
{
    struct texture *t = texture_add(set, eval_marble);
    t->noise = *noise;
    return t;
}
