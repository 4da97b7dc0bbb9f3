/* Collects the sums for the test of missed light (convergence/missed_light.h), for
 * estimators that have no film of large steps. */

#include "integrator/markov/markov_missed.h"

#include "base/mem.h"
#include "integrator/markov/markov_errors.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_replica.h"

#define MISSED_BYTES 0x1p30 /* memory for the sums */

static struct missed_grid plan_grid(const struct markov *m)
{
    const struct camera *camera = &m->scene->camera;
    double bytes = m->settings->memory_limit > 0.0 ? m->settings->memory_limit
                                                   : MISSED_BYTES;
    return missed_grid_plan(camera->width, camera->height, m->chain_count, bytes);
}

static bool is_wanted(const struct markov *m)
{
    return markov_replicas_count(m) > 0 &&
           settings_estimator(m->settings) != ESTIMATOR_KELEMEN;
}

static void missed_arrays(const struct markov *m, struct markov_missed *missed,
                          struct mem_plan *plan)
{
    size_t chains = (size_t)m->chain_count, tiles = (size_t)missed->grid.tiles;
    size_t pixels = (size_t)markov_pixels(m);
    missed->large = mem_take(plan, 0, chains * tiles, sizeof *missed->large);
    missed->path_hits = mem_take(plan, 0, tiles, sizeof *missed->path_hits);
    missed->tile_of = mem_take(plan, 0, pixels, sizeof *missed->tile_of);
}

void markov_missed_memory(const struct markov *m, struct run_memory *out)
{
    struct markov_missed missed = {.grid = plan_grid(m)};
    struct mem_plan plan = {.take = false};
    if (!is_wanted(m))
        return;
    missed_arrays(m, &missed, &plan);
    out->states += plan.bytes;
}

void markov_missed_create(struct markov *m)
{
    struct markov_missed *missed = &m->missed;
    long pixels = (long)markov_pixels(m);
    if (!is_wanted(m))
        return;
    missed->grid = plan_grid(m);
    missed_arrays(m, missed, &(struct mem_plan){.take = true});
    for (long i = 0; i < pixels; i++)
        missed->tile_of[i] = (uint16_t)missed_grid_tile(&missed->grid, i);
}

void markov_missed_count_paths(struct markov *m)
{
    for (int g = 0; m->missed.path_hits && g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        for (long i = 0; i < paths->count; i++)
            if (paths->targets[i] > 0.0 && paths->pixels[i] >= 0)
                m->missed.path_hits[m->missed.tile_of[paths->pixels[i]]] += 1.0;
    }
}

void markov_missed_pack(struct markov *m, struct pack *pack)
{
    size_t tiles = (size_t)m->missed.grid.tiles;
    if (!m->missed.large)
        return;
    for (int i = 0; i < m->chain_count; i++)
        if (part_owns_chain(pack_part(pack), i))
            pack_doubles(pack, "large_tiles", m->missed.large + (size_t)i * tiles, tiles);
    pack_doubles(pack, "met_tiles", m->missed.path_hits, tiles);
}

void markov_missed_destroy(struct markov *m)
{
    mem_free(m->missed.large);
    mem_free(m->missed.path_hits);
    mem_free(m->missed.tile_of);
}

static void add_plain(const struct markov *m, struct tile_shown *shown)
{
    int width = m->scene->camera.width, height = m->scene->camera.height;
    if (!m->direct)
        return;
    struct image *image = image_create(width, height);
    passes_picture(m->direct, image);
    for (long i = 0; i < (long)width * height; i++)
        shown[m->missed.tile_of[i]].plain += rgb_luminance(image_pixel(image, i));
    image_destroy(image);
}

static struct tile_shown *find_shown(const struct markov *m, const struct evidence *e)
{
    struct tile_shown *shown = mem_alloc((size_t)m->missed.grid.tiles, sizeof *shown);
    for (long i = 0; i < (long)markov_pixels(m); i++) {
        double deviations[REPLICAS_MOST];
        struct tile_shown *tile = &shown[m->missed.tile_of[i]];
        e->deviations(e->self, i, deviations);
        tile->chains += markov_errors_value(m->errors, i);
        for (int j = 0; j < e->replicas; j++)
            tile->deviations[j] += deviations[j];
    }
    add_plain(m, shown);
    return shown;
}

void markov_missed_find(const struct markov *m, struct evidence *out)
{
    struct missed_stratum strata[DIMS_MAX_DEPTH];
    if (!m->missed.large)
        return;
    struct tile_shown *shown = find_shown(m, out);
    double *large_steps = mem_alloc((size_t)m->chain_count, sizeof *large_steps);
    struct missed_light light = {
        .grid = m->missed.grid,
        .large = m->missed.large,
        .large_steps = large_steps,
        .path_hits = m->missed.path_hits,
        .strata = strata,
        .strata_count = m->group_count,
        .scale = m->scene->emission_scale * markov_pixels(m),
        .replicas = out->replicas,
        .shown = shown,
    };
    for (int i = 0; i < m->chain_count; i++)
        large_steps[i] = (double)m->chains[i].tally.proposed[MOVE_LARGE];
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        strata[g] = (struct missed_stratum){group->first_chain, group->chain_count};
        light.states += markov_states(m, group);
    }
    missed_light_find(&light, out);
    mem_free(large_steps);
    mem_free(shown);
}
