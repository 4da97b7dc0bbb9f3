#include "convergence/missed_light.h"

#include "math/student.h"

#include <math.h>

#define MISSED_TILES 64 /* tiles of a small film at most; a tile may be one pixel */

/* A place is dim if VERDICT_DIM_SHARE of the film at this brightness would hold fewer
 * chain states than this; the relative error there is at least 1 / sqrt(10). */
#define DIM_STATES 10.0
/* Where plain samples contribute more than this many times the light of the chains, the
 * error of the chains does not matter. */
#define DIM_PLAIN 2.0

struct missed_grid missed_grid_plan(int width, int height, double chains, double bytes)
{
    double most = bytes / (chains * (double)sizeof(double));
    int tiles = (int)fmax(fmin(most, TILES_MOST), 1.0);
    int fine = time_spans_tile(width, height, 1,
                               tiles < MISSED_TILES ? tiles : MISSED_TILES);
    int coarse = time_spans_tile(width, height, TILE_LEAST, tiles);
    int size = fine < coarse ? fine : coarse;
    int columns = time_spans_across(width, size), rows = time_spans_across(height, size);
    return (struct missed_grid){width, height, size, columns, rows, columns * rows};
}

int missed_grid_tile(const struct missed_grid *grid, long pixel)
{
    int x = (int)(pixel % grid->width) / grid->size;
    int y = (int)(pixel / grid->width) / grid->size;
    return y * grid->columns + x;
}

/* Neighbouring tiles, tested together. */
struct block {
    int left, top, right,
        bottom; /* range of tile columns and rows; right and bottom are exclusive */
};

/* Light of a block: what the picture shows, and the mean of large steps with its
 * variance. */
struct block_light {
    double plain, path_hits, chains, deviations[REPLICAS_MOST];
    double large, variance, freedom; /* freedom: sum of variance^2 / degrees of freedom,
                                        for [Satterthwaite46] */
};

static double block_large(const struct missed_light *in, long chain,
                          const struct block *block)
{
    const double *large = in->large + chain * in->grid.tiles;
    double sum = 0.0;
    for (int y = block->top; y < block->bottom; y++)
        for (int x = block->left; x < block->right; x++)
            sum += large[y * in->grid.columns + x];
    return sum;
}

/* Adds the mean of a stratum's large steps in this block: a ratio estimate, with each
 * chain as one sample. */
static void add_large(const struct missed_light *in, const struct missed_stratum *stratum,
                      const struct block *block, struct block_light *light)
{
    double sum = 0.0, count = 0.0, squares = 0.0;
    long first = stratum->first, n = stratum->count;
    for (long i = first; i < first + n; i++) {
        sum += block_large(in, i, block);
        count += in->large_steps[i];
    }
    if (!(count > 0.0) || n < 2)
        return;
    double mean = sum / count;
    for (long i = first; i < first + n; i++) {
        double d = block_large(in, i, block) - mean * in->large_steps[i];
        squares += d * d;
    }
    double variance = squares / (count * count) * (double)n / ((double)n - 1.0);
    light->large += mean;
    light->variance += variance;
    light->freedom += variance * variance / ((double)n - 1.0);
}

static struct block_light block_light(const struct missed_light *in,
                                      const struct block *block)
{
    struct block_light light = {0};
    double scale = in->scale;
    for (int y = block->top; y < block->bottom; y++)
        for (int x = block->left; x < block->right; x++) {
            int at = y * in->grid.columns + x;
            const struct tile_shown *tile = &in->shown[at];
            light.plain += tile->plain;
            light.path_hits += in->path_hits[at];
            light.chains += tile->chains;
            for (int j = 0; j < in->replicas; j++)
                light.deviations[j] += tile->deviations[j];
        }
    for (int i = 0; i < in->strata_count; i++)
        add_large(in, &in->strata[i], block, &light);
    light.large *= scale;
    light.variance *= scale * scale;
    light.freedom *= scale * scale * scale * scale;
    return light;
}

/* P-value of the test that large steps find more light than the picture shows: Welch's t
 * [Welch47] with the degrees of freedom of [Satterthwaite46]. */
static double surplus_p(const struct block_light *light, int replicas)
{
    double variance = light->variance, freedom = light->freedom, shown = 0.0;
    for (int r = 0; r < replicas; r++)
        shown += light->deviations[r] * light->deviations[r] /
                 (replicas * (replicas - 1.0));
    variance += shown;
    freedom += shown * shown / (replicas - 1.0);
    double surplus = light->large - light->chains;
    if (!(surplus > 0.0 && variance > 0.0))
        return 1.0;
    return student_tail(surplus / sqrt(variance),
                        student_freedom(variance, 2.0 * freedom)); /* [Welch47] */
}

/* Light of a pixel below which it is dim: see DIM_STATES. */
static double dim_level(const struct missed_light *in)
{
    double light = 0.0, pixels = (double)in->grid.width * in->grid.height;
    for (int i = 0; i < in->grid.tiles; i++)
        light += in->shown[i].chains;
    double part = VERDICT_DIM_SHARE * pixels;
    return in->states > 0.0 ? DIM_STATES / part * light / in->states : 0.0;
}

/* Uses the larger of what the chains and the large steps show, as either may have missed
 * the light. A block that no path has reached is black, not dim. */
static bool is_dim(const struct block_light *light, double pixels, double level)
{
    double bright = fmax(light->chains, light->large);
    bool lit = bright > 0.0 || light->path_hits > 0.0;
    return lit && bright < level * pixels && light->plain <= DIM_PLAIN * bright;
}

/* Number of blocks of side x side tiles. */
static int count_blocks(const struct missed_grid *grid, int side)
{
    return time_spans_across(grid->columns, side) * time_spans_across(grid->rows, side);
}

/* The search over blocks of all sizes; dim, brightest, dim_x and dim_y are of the size
 * being tested. */
struct block_search {
    const struct missed_light *in;
    struct evidence *out;
    double tests, least; /* number of tests; least p-value times it (Bonferroni) */
    double level, dim, brightest;
    int dim_x, dim_y; /* middle of the brightest dim block */
};

static double block_pixels(const struct missed_grid *grid, const struct block *block)
{
    int right = block->right * grid->size, bottom = block->bottom * grid->size;
    right = right < grid->width ? right : grid->width;
    bottom = bottom < grid->height ? bottom : grid->height;
    return (double)(right - block->left * grid->size) *
           (bottom - block->top * grid->size);
}

static void test_block(struct block_search *search, const struct block *block, int side)
{
    const struct missed_grid *grid = &search->in->grid;
    struct evidence *out = search->out;
    struct block_light light = block_light(search->in, block);
    double pixels = block_pixels(grid, block);
    int x = (block->left + block->right) * grid->size / 2;
    int y = (block->top + block->bottom) * grid->size / 2;
    double p = search->tests * surplus_p(&light, search->in->replicas);
    out->missed_places += p < VERDICT_FALSE_ALARM;
    if (p < search->least) {
        search->least = p;
        out->missed_x = x;
        out->missed_y = y;
        out->missed_side = side * grid->size;
    }
    if (!is_dim(&light, pixels, search->level))
        return;
    double bright = fmax(light.chains, light.large) / pixels;
    if (search->dim == 0.0 || bright > search->brightest) {
        search->brightest = bright;
        search->dim_x = x;
        search->dim_y = y;
    }
    search->dim += pixels / ((double)grid->width * grid->height);
}

static void test_blocks_of_size(struct block_search *search, int side)
{
    const struct missed_grid *grid = &search->in->grid;
    search->dim = search->brightest = 0.0;
    for (int top = 0; top < grid->rows; top += side)
        for (int left = 0; left < grid->columns; left += side) {
            struct block block = {
                .left = left,
                .top = top,
                .right = left + side < grid->columns ? left + side : grid->columns,
                .bottom = top + side < grid->rows ? top + side : grid->rows,
            };
            test_block(search, &block, side);
        }
    if (search->dim > search->out->dim_share) {
        search->out->dim_share = search->dim;
        search->out->dim_x = search->dim_x;
        search->out->dim_y = search->dim_y;
    }
}

void missed_light_find(const struct missed_light *in, struct evidence *out)
{
    const struct missed_grid *grid = &in->grid;
    struct block_search search = {
        .in = in, .out = out, .level = dim_level(in), .least = VERDICT_FALSE_ALARM};
    for (int side = 1; side == 1 || count_blocks(grid, side) > 1; side *= 2)
        search.tests += count_blocks(grid, side);
    for (int side = 1; side == 1 || count_blocks(grid, side) > 1; side *= 2)
        test_blocks_of_size(&search, side);
}
