/* Light that chains miss. A chain that cannot move between places of very different
 * radiance leaves the dim one too dark for as long as it runs, and its parts agree on
 * that. Large steps are independent samples: by length and tile their mean is unbiased.
 * The kelemen estimator has them in its picture; for others they are held against it.
 *
 * One-sided: where the light is rare, a mean of few samples is mostly too small, whereas
 * chains that show less than these samples have missed something.
 *
 * Where few large steps have met the light that test is blind. But a plain chain spends
 * its states in proportion to brightness: places so dim that it has hardly any there are
 * not resolved, whatever they look like. They are told by their brightness alone. */

#include "base/mem.h"
#include "integrator/markov_state.h"
#include "math/law.h"

#define MISSED_BYTES 0x1p30 /* what the sums may take */
#define MISSED_TILES 64     /* a small film has so many, down to a pixel */

/* Places are dim where so large a part of the film, were all of it as dim, held fewer
 * states than this: relative error at least 1 / sqrt(10). */
#define DIM_STATES 10.0
/* Where plain samples show more than this many times the chains' light, the chains' error
 * does not matter. */
#define DIM_DIRECT 2.0

/* Of a tile: means of luminance and their variances, sums over pixels. */
struct tile_light {
    double direct; /* of plain samples, which no chain adds to */
    double met;    /* bootstrap paths */
    double chains, parts[REPLICAS_MOST];
    double large, variance, freedom; /* freedom: sum of variance^2 / degrees */
};

/* A sum for each chain and tile: of many chains on a large film the tiles are larger than
 * those of the verdict. On a small one they are smaller: what is dim beside what is
 * bright does not show in a tile that holds both. */
static struct markov_missed plan_tiles(const struct markov *m)
{
    int width = m->scene->camera.width, height = m->scene->camera.height;
    double limit = m->settings->memory_limit > 0.0 ? m->settings->memory_limit
                                                   : MISSED_BYTES;
    double most = limit / ((double)m->chain_count * (double)sizeof(double));
    int tiles = (int)fmax(fmin(most, TILES_MOST), 1.0);
    int fine = batches_tile(width, height, 1,
                            tiles < MISSED_TILES ? tiles : MISSED_TILES);
    int coarse = batches_tile(width, height, TILE_LEAST, tiles);
    int size = fine < coarse ? fine : coarse;
    int columns = (width + size - 1) / size, rows = (height + size - 1) / size;
    return (struct markov_missed){
        .size = size,
        .columns = columns,
        .rows = rows,
        .tiles = columns * rows,
    };
}

static bool is_wanted(const struct markov *m)
{
    return markov_replicas_count(m) > 0 &&
           settings_estimator(m->settings) != ESTIMATOR_KELEMEN;
}

void markov_missed_memory(const struct markov *m, struct run_memory *out)
{
    if (is_wanted(m))
        out->states += (m->chain_count + 1.0) * plan_tiles(m).tiles * sizeof(double) +
                       markov_pixels(m) * sizeof(uint16_t);
}

void markov_missed_create(struct markov *m)
{
    struct markov_missed *missed = &m->missed;
    int width = m->scene->camera.width;
    size_t pixels = (size_t)markov_pixels(m);
    if (!is_wanted(m))
        return;
    *missed = plan_tiles(m);
    missed->large = mem_alloc((size_t)m->chain_count * (size_t)missed->tiles,
                              sizeof *missed->large);
    missed->met = mem_alloc((size_t)missed->tiles, sizeof *missed->met);
    missed->tile_of = mem_alloc(pixels, sizeof *missed->tile_of);
    for (size_t i = 0; i < pixels; i++) {
        int x = (int)i % width / missed->size, y = (int)i / width / missed->size;
        missed->tile_of[i] = (uint16_t)(y * missed->columns + x);
    }
}

void markov_missed_meet(struct markov *m)
{
    for (int g = 0; m->missed.met && g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        for (long i = 0; i < paths->count; i++)
            if (paths->targets[i] > 0.0 && paths->pixels[i] >= 0)
                m->missed.met[m->missed.tile_of[paths->pixels[i]]] += 1.0;
    }
}

void markov_missed_pack(struct markov *m, struct pack *pack)
{
    size_t tiles = (size_t)m->missed.tiles;
    if (!m->missed.large)
        return;
    pack_doubles(pack, "large_tiles", m->missed.large, (size_t)m->chain_count * tiles);
    pack_doubles(pack, "met_tiles", m->missed.met, tiles);
}

void markov_missed_destroy(struct markov *m)
{
    mem_free(m->missed.large);
    mem_free(m->missed.met);
    mem_free(m->missed.tile_of);
}

/* Some neighbouring tiles as one. */
struct block {
    int left, top, right, bottom; /* columns and rows of tiles, without the last */
};

static double block_large(const struct markov_missed *missed, long chain,
                          const struct block *block)
{
    const double *large = missed->large + chain * missed->tiles;
    double sum = 0.0;
    for (int y = block->top; y < block->bottom; y++)
        for (int x = block->left; x < block->right; x++)
            sum += large[y * missed->columns + x];
    return sum;
}

/* Mean over the large steps of a length's chains, each chain a sample of its own. */
static void add_large(const struct markov *m, const struct group *group,
                      const struct block *block, struct tile_light *light)
{
    double sum = 0.0, count = 0.0, squares = 0.0;
    long first = group->first_chain, n = group->chain_count;
    for (long i = first; i < first + n; i++) {
        sum += block_large(&m->missed, i, block);
        count += (double)m->chains[i].tally.proposed[MOVE_LARGE];
    }
    if (!(count > 0.0) || n < MARKOV_CHAINS_LEAST)
        return;
    double mean = sum / count;
    for (long i = first; i < first + n; i++) {
        double d = block_large(&m->missed, i, block) -
                   mean * (double)m->chains[i].tally.proposed[MOVE_LARGE];
        squares += d * d;
    }
    double variance = squares / (count * count) * (double)n / ((double)n - 1.0);
    light->large += mean;
    light->variance += variance;
    light->freedom += variance * variance / ((double)n - 1.0);
}

/* P-value of as much more light in the large steps [Satterthwaite46]. */
static double surplus_p(const struct tile_light *light, int replicas)
{
    double variance = light->variance, freedom = light->freedom, parts = 0.0;
    for (int r = 0; r < replicas; r++)
        parts += light->parts[r] * light->parts[r] / (replicas * (replicas - 1.0));
    variance += parts;
    freedom += parts * parts / (replicas - 1.0);
    double surplus = light->large - light->chains;
    if (!(surplus > 0.0 && variance > 0.0))
        return 1.0;
    return 0.5 *
           law_f_upper(surplus * surplus / variance, 1.0, variance * variance / freedom);
}

static void add_direct(const struct markov *m, struct tile_light *lights)
{
    int width = m->scene->camera.width, height = m->scene->camera.height;
    if (!m->direct)
        return;
    struct image *image = image_create(width, height);
    passes_picture(m->direct, image);
    for (long i = 0; i < (long)width * height; i++) {
        const float *v = image->pixels + 3 * i;
        lights[m->missed.tile_of[i]].direct += rgb_luminance(
            rgb((double)v[0], (double)v[1], (double)v[2]));
    }
    image_destroy(image);
}

/* What the picture shows, of every tile. */
static struct tile_light *find_lights(const struct markov *m, const struct evidence *e)
{
    struct tile_light *lights = mem_alloc((size_t)m->missed.tiles, sizeof *lights);
    for (long i = 0; i < (long)markov_pixels(m); i++) {
        double deviations[REPLICAS_MOST];
        struct tile_light *light = &lights[m->missed.tile_of[i]];
        e->deviations(e->self, i, deviations);
        light->chains += markov_errors_value(m->errors, i);
        for (int j = 0; j < e->replicas; j++)
            light->parts[j] += deviations[j];
    }
    add_direct(m, lights);
    return lights;
}

static struct tile_light block_light(const struct markov *m,
                                     const struct tile_light *lights,
                                     const struct block *block, int replicas)
{
    struct tile_light light = {0};
    double scale = m->scene->emission_scale * markov_pixels(m);
    for (int y = block->top; y < block->bottom; y++)
        for (int x = block->left; x < block->right; x++) {
            const struct tile_light *tile = &lights[y * m->missed.columns + x];
            light.direct += tile->direct;
            light.met += m->missed.met[y * m->missed.columns + x];
            light.chains += tile->chains;
            for (int j = 0; j < replicas; j++)
                light.parts[j] += tile->parts[j];
        }
    for (int g = 0; g < m->group_count; g++)
        add_large(m, &m->groups[g], block, &light);
    light.large *= scale;
    light.variance *= scale * scale;
    light.freedom *= scale * scale * scale * scale;
    return light;
}

/* Light of a pixel below which it is dim: that of chain states so sparse. */
static double dim_level(const struct markov *m, const struct tile_light *lights)
{
    double light = 0.0, states = 0.0;
    for (int i = 0; i < m->missed.tiles; i++)
        light += lights[i].chains;
    for (int g = 0; g < m->group_count; g++)
        states += markov_states(m, &m->groups[g]);
    double part = VERDICT_DIM_SHARE * markov_pixels(m);
    return states > 0.0 ? DIM_STATES / part * light / states : 0.0;
}

/* By the larger of what the chains and the large steps show: neither has to know. Where
 * no path at all has met light it is black, not dim. */
static bool is_dim(const struct tile_light *light, double pixels, double level)
{
    double bright = fmax(light->chains, light->large);
    bool lit = bright > 0.0 || light->met > 0.0;
    return lit && bright < level * pixels && light->direct <= DIM_DIRECT * bright;
}

/* Blocks of so many tiles each way. */
static int count_blocks(const struct markov_missed *missed, int side)
{
    return ((missed->columns + side - 1) / side) * ((missed->rows + side - 1) / side);
}

/* The look at all blocks: level is of dim_level, the rest of those of one size. */
struct look {
    const struct markov *m;
    const struct tile_light *lights;
    struct evidence *out;
    double tests, least; /* p-values, times how many there are */
    double level, dim, brightest;
    int dim_x, dim_y; /* the brightest of what is dim */
};

static double block_pixels(const struct markov *m, const struct block *block)
{
    int size = m->missed.size;
    int right = block->right * size, bottom = block->bottom * size;
    right = right < m->scene->camera.width ? right : m->scene->camera.width;
    bottom = bottom < m->scene->camera.height ? bottom : m->scene->camera.height;
    return (double)(right - block->left * size) * (bottom - block->top * size);
}

static void look_at_block(struct look *look, const struct block *block, int side)
{
    const struct markov *m = look->m;
    struct evidence *out = look->out;
    struct tile_light light = block_light(m, look->lights, block, out->replicas);
    double pixels = block_pixels(m, block);
    int x = (block->left + block->right) * m->missed.size / 2;
    int y = (block->top + block->bottom) * m->missed.size / 2;
    double p = look->tests * surplus_p(&light, out->replicas);
    out->missed_places += p < VERDICT_FALSE_ALARM;
    if (p < look->least) {
        look->least = p;
        out->missed_x = x;
        out->missed_y = y;
        out->missed_side = side * m->missed.size;
    }
    if (!is_dim(&light, pixels, look->level))
        return;
    double bright = fmax(light.chains, light.large) / pixels;
    if (look->dim == 0.0 || bright > look->brightest) {
        look->brightest = bright;
        look->dim_x = x;
        look->dim_y = y;
    }
    look->dim += pixels / markov_pixels(m);
}

static void look_at_size(struct look *look, int side)
{
    const struct markov_missed *grid = &look->m->missed;
    look->dim = look->brightest = 0.0;
    for (int top = 0; top < grid->rows; top += side)
        for (int left = 0; left < grid->columns; left += side) {
            struct block block = {
                .left = left,
                .top = top,
                .right = left + side < grid->columns ? left + side : grid->columns,
                .bottom = top + side < grid->rows ? top + side : grid->rows,
            };
            look_at_block(look, &block, side);
        }
    if (look->dim > look->out->dim_share) {
        look->out->dim_share = look->dim;
        look->out->dim_x = look->dim_x;
        look->out->dim_y = look->dim_y;
    }
}

/* Single tiles first, then two, four, ... each way: a small dim place does not show in a
 * large block, and a large one has too few samples in each of its tiles. */
void markov_missed_find(const struct markov *m, struct evidence *out)
{
    const struct markov_missed *grid = &m->missed;
    if (!grid->large)
        return;
    struct tile_light *lights = find_lights(m, out);
    struct look look = {.m = m,
                        .lights = lights,
                        .out = out,
                        .level = dim_level(m, lights),
                        .least = VERDICT_FALSE_ALARM};
    for (int side = 1; side == 1 || count_blocks(grid, side) > 1; side *= 2)
        look.tests += count_blocks(grid, side);
    for (int side = 1; side == 1 || count_blocks(grid, side) > 1; side *= 2)
        look_at_size(&look, side);
    mem_free(lights);
}
