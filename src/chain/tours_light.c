/* A pixel without samples is not black: by relMSE its weight would be that of black, up
 * to I^2 / e times too great, and most pixels have no sample on the tapes. So the picture
 * is smoothed by a pyramid of tiles, each level half as wide as the one before. From the
 * coarsest on, each tile's brightness is the mean of its own, with its number of samples
 * as weight, and of the next coarser tile's, with PRIOR as weight. The finest tiles are
 * so large that there are TILES_MOST at most: the tapes have not many more samples, and
 * the work does not grow with the picture. */

#include "chain/tours_light.h"

#include "base/mem.h"

#include <math.h>

#define SHIFT_LEAST 1 /* tiles of 2x2 pixels */
#define TILES_MOST  16384
#define PRIOR       16.0 /* samples */
#define LEVELS_MOST 32

/* Sums over a tile's pixels; and its brightness after smoothing. */
struct tile {
    double luminance, samples, pixels, smooth;
};

struct level {
    int width, height;  /* tiles */
    struct tile *tiles; /* [height][width] */
};

struct tours_light {
    int width, height, shift;
    int count; /* levels, the finest first */
    struct level levels[LEVELS_MOST];
    float *scale, *mean; /* of the finest tiles */
    double square;
};

static int tiles_along(int pixels, int shift)
{
    return (int)(((long)pixels + (1L << shift) - 1) >> shift);
}

static size_t tile_count(const struct level *level)
{
    return (size_t)level->width * (size_t)level->height;
}

static void arrays(struct tours_light *light, struct mem_plan *plan)
{
    struct level *fine = light->levels;
    for (light->shift = SHIFT_LEAST;; light->shift++) {
        fine->width = tiles_along(light->width, light->shift);
        fine->height = tiles_along(light->height, light->shift);
        if (tile_count(fine) <= TILES_MOST)
            break;
    }
    for (light->count = 1; tile_count(&light->levels[light->count - 1]) > 1;
         light->count++) {
        const struct level *l = &light->levels[light->count - 1];
        light->levels[light->count] = (struct level){(l->width + 1) / 2,
                                                     (l->height + 1) / 2, NULL};
    }
    for (int l = 0; l < light->count; l++)
        light->levels[l].tiles = mem_take(plan, 0, tile_count(&light->levels[l]),
                                          sizeof(struct tile));
    light->scale = mem_take(plan, 0, tile_count(fine), sizeof *light->scale);
    light->mean = mem_take(plan, 0, tile_count(fine), sizeof *light->mean);
}

struct tours_light *tours_light_create(int width, int height)
{
    struct tours_light *light = mem_alloc(1, sizeof *light);
    light->width = width;
    light->height = height;
    arrays(light, &(struct mem_plan){.take = true});
    const struct level *fine = light->levels;
    int size = 1 << light->shift;
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            double across = fmin(size, width - x * size);
            fine->tiles[y * fine->width + x].pixels = across *
                                                      fmin(size, height - y * size);
        }
    return light;
}

void tours_light_destroy(struct tours_light *light)
{
    if (!light)
        return;
    for (int l = 0; l < light->count; l++)
        mem_free(light->levels[l].tiles);
    mem_free(light->scale);
    mem_free(light->mean);
    mem_free(light);
}

double tours_light_bytes(int width, int height)
{
    struct tours_light light = {.width = width, .height = height};
    struct mem_plan plan = {.take = false};
    arrays(&light, &plan);
    return plan.bytes + (double)sizeof light;
}

struct tours_pixels tours_light_pixels(const struct tours_light *light)
{
    return (struct tours_pixels){light->width, light->shift, light->levels[0].width,
                                 light->scale, light->mean};
}

double tours_light_square(const struct tours_light *light)
{
    return light->square;
}

/* --- the picture ------------------------------------------------------------------- */

void tours_light_add_pixel(struct tours_light *light, int32_t pixel, double luminance)
{
    struct tours_pixels pixels = tours_light_pixels(light);
    struct tile *tile = &light->levels[0].tiles[tours_tile_of(&pixels, pixel)];
    tile->luminance += luminance;
    tile->samples += 1.0;
}

static double weight_of(const struct tours_target *t, double f)
{
    return 1.0 / (f + (t->estimator == ESTIMATOR_KELEMEN ? t->p0 * t->b : 0.0));
}

static void add(struct tours_light *light, const struct tape_splat *splats, int count,
                double weight)
{
    for (int i = 0; i < count; i++)
        tours_light_add_pixel(light, splats[i].pixel,
                              weight * (double)splats[i].luminance);
}

void tours_light_add(struct tours_light *light, const struct tape *tape,
                     const struct tours_target *target, double factor)
{
    const struct tape_splat *next = tape->splats, *current = next;
    int current_count = 0;
    double current_target = 0.0;
    for (long i = 0; i < tape->count; i++) {
        const struct tape_record *r = &tape->records[i];
        bool independent = r->event == TAPE_LARGE &&
                           target->estimator == ESTIMATOR_KELEMEN;
        double a = (double)r->acceptance;
        if (i > 0 && current_target > 0.0)
            add(light, current, current_count,
                factor * (1.0 - a) * weight_of(target, current_target));
        if (i > 0 && r->target > 0.0)
            add(light, next, r->splats,
                factor * (independent ? 1.0 + a : a) * weight_of(target, r->target));
        if (r->accepted) {
            current = next;
            current_count = r->splats;
            current_target = r->target;
        }
        next += r->splats;
    }
}

/* --- the weights ------------------------------------------------------------------- */

static void sum_levels(struct tours_light *light)
{
    for (int l = 1; l < light->count; l++) {
        const struct level *fine = &light->levels[l - 1], *coarse = &light->levels[l];
        for (int y = 0; y < fine->height; y++)
            for (int x = 0; x < fine->width; x++) {
                const struct tile *t = &fine->tiles[y * fine->width + x];
                struct tile *to = &coarse->tiles[y / 2 * coarse->width + x / 2];
                to->luminance += t->luminance;
                to->samples += t->samples;
                to->pixels += t->pixels;
            }
    }
}

static void smooth_levels(struct tours_light *light)
{
    struct tile *top = light->levels[light->count - 1].tiles;
    top->smooth = top->luminance / top->pixels;
    for (int l = light->count - 2; l >= 0; l--) {
        const struct level *fine = &light->levels[l], *coarse = &light->levels[l + 1];
        for (int y = 0; y < fine->height; y++)
            for (int x = 0; x < fine->width; x++) {
                struct tile *t = &fine->tiles[y * fine->width + x];
                double prior = coarse->tiles[y / 2 * coarse->width + x / 2].smooth;
                t->smooth = (t->samples * t->luminance / t->pixels + PRIOR * prior) /
                            (t->samples + PRIOR);
            }
    }
}

double tours_light_weigh(struct tours_light *light, double floor)
{
    double n = (double)light->width * light->height;
    sum_levels(light);
    smooth_levels(light);
    for (size_t k = 0; k < tile_count(light->levels); k++) {
        const struct tile *tile = &light->levels[0].tiles[k];
        double v = tile->smooth, w = 1.0 / (v * v + floor);
        light->scale[k] = (float)sqrt(n * w);
        light->mean[k] = (float)(v * sqrt(w / n));
        light->square += tile->pixels * v * v * w / n;
    }
    return light->levels[light->count - 1].tiles->smooth;
}
