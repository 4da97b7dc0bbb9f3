/* Light that chains miss. A chain that cannot move between places of very different
 * radiance leaves the dim one too dark for as long as it runs, and its parts agree on
 * that. Large steps are independent samples: by length and tile their mean is unbiased.
 * The kelemen estimator has them in its picture; for others they are held against it.
 *
 * One-sided: where the light is rare, a mean of few samples is mostly too small, whereas
 * chains that show less than these samples have missed something. */

#include "base/mem.h"
#include "integrator/markov_state.h"
#include "math/law.h"

/* Of a tile: means of luminance and their variances, sums over pixels. */
struct tile_light {
    double chains, parts[REPLICAS_MOST];
    double large, variance, freedom; /* freedom: sum of variance^2 / degrees */
};

/* A million chains on a large film do without: a sum for each chain and tile would take
 * more memory than all replicas may. */
void markov_missed_create(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    const struct batches *b = &r->batches;
    int width = m->scene->camera.width;
    size_t pixels = (size_t)markov_pixels(m);
    if (settings_estimator(m->settings) == ESTIMATOR_KELEMEN ||
        (double)m->chain_count * b->tiles * (double)sizeof *r->large > REPLICAS_BYTES)
        return;
    r->large = mem_alloc((size_t)m->chain_count * (size_t)b->tiles, sizeof *r->large);
    r->tile_of = mem_alloc(pixels, sizeof *r->tile_of);
    for (size_t i = 0; i < pixels; i++) {
        int x = (int)i % width / b->tile, y = (int)i / width / b->tile;
        r->tile_of[i] = (uint16_t)(y * b->columns + x);
    }
}

/* Mean over the large steps of a length's chains, each chain a sample of its own. */
static void add_large(const struct markov *m, const struct group *group, int tile,
                      struct tile_light *light)
{
    const struct markov_replicas *r = &m->replicas;
    double sum = 0.0, count = 0.0, squares = 0.0;
    int first = group->first_chain, n = group->chain_count;
    for (int i = first; i < first + n; i++) {
        sum += r->large[i * r->batches.tiles + tile];
        count += (double)m->chains[i].tally.proposed[MOVE_LARGE];
    }
    if (!(count > 0.0) || n < MARKOV_CHAINS_LEAST)
        return;
    double mean = sum / count;
    for (int i = first; i < first + n; i++) {
        double d = r->large[i * r->batches.tiles + tile] -
                   mean * (double)m->chains[i].tally.proposed[MOVE_LARGE];
        squares += d * d;
    }
    double variance = squares / (count * count) * n / (n - 1.0);
    light->large += mean;
    light->variance += variance;
    light->freedom += variance * variance / (n - 1.0);
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

void markov_missed_find(const struct markov *m, struct evidence *out)
{
    const struct markov_replicas *r = &m->replicas;
    const struct batches *b = &r->batches;
    double least = 1.0, pixels = markov_pixels(m);
    if (!r->large)
        return;
    struct tile_light *lights = mem_alloc((size_t)b->tiles, sizeof *lights);
    for (long i = 0; i < (long)pixels; i++) {
        double deviations[REPLICAS_MOST];
        struct tile_light *light = &lights[r->tile_of[i]];
        out->deviations(out->self, i, deviations);
        light->chains += markov_replicas_value(m, i);
        for (int j = 0; j < out->replicas; j++)
            light->parts[j] += deviations[j];
    }
    for (int tile = 0; tile < b->tiles; tile++) {
        struct tile_light *light = &lights[tile];
        for (int g = 0; g < m->group_count; g++)
            add_large(m, &m->groups[g], tile, light);
        double scale = m->scene->emission_scale * pixels;
        light->large *= scale;
        light->variance *= scale * scale;
        light->freedom *= scale * scale * scale * scale;
        double p = surplus_p(light, out->replicas) * b->tiles;
        out->missed_tiles += p < VERDICT_FALSE_ALARM;
        if (p < least) {
            least = p;
            out->missed_x = tile % b->columns * b->tile + b->tile / 2;
            out->missed_y = tile / b->columns * b->tile + b->tile / 2;
        }
    }
    mem_free(lights);
}
