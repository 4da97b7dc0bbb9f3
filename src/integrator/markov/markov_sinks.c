/* Connects the splats of a chain to the outputs of a run: films, replicas, tiles of large
 * steps, layers. A further output is a sink of sink_set.h and its lines
 * here. */

#include "integrator/markov/markov_sinks.h"

#include "integrator/markov/markov_state.h"

static struct film *lane(struct film *film, int thread)
{
    return film ? film_lane(film, thread) : NULL;
}

static void add_films(struct sink_set *s, const struct markov *m,
                      const struct group *group, int thread)
{
    s->film = film_sink_of(lane(group->film, thread), group->states_scale);
    s->large = film_sink_of(lane(m->films.large, thread), group->large_scale);
    splat_sinks_append(&s->to.states, &s->film.sink);
    if (m->films.large)
        splat_sinks_append(&s->to.large, &s->large.sink);
}

/* The layers that the user asked for, and the map of failures of pfmlt. Class films are
 * shared by the threads. */
static void add_layers(struct sink_set *s, const struct markov *m,
                       const struct group *group, int thread)
{
    const struct markov_films *f = &m->films;
    if (f->steps || f->small_steps) {
        bool work = (m->settings->layers & LAYER_WORK) != 0;
        s->maps = map_sink_of(lane(f->steps, thread), lane(f->small_steps, thread),
                              lane(f->large_steps, thread), work);
        s->to.steps = &s->maps.sink;
    }
    if (f->light.count == 0)
        return;
    s->classes = class_sink_of(&f->light, f->class_states, 1.0);
    splat_sinks_append(&s->to.states, &s->classes.sink);
    s->large_classes = class_sink_of(&f->light, f->class_large, group->large_scale);
    if (f->large)
        splat_sinks_append(&s->to.large, &s->large_classes.sink);
}

static void add_replicas(struct sink_set *s, const struct markov *m,
                         const struct group *group, int chain, int thread)
{
    const struct markov_replicas *r = &m->replicas;
    if (!r->films || r->share_counts[chain] == 0)
        return;
    const struct replica_share *shares = r->weighted_shares +
                                         (size_t)chain * (size_t)r->films->count;
    double scale = REPLICAS_ONE * group->bootstrap.b * m->chain_count /
                   (m->b0 * group->chain_count);
    s->replicas = &r->films->lanes[thread];
    s->replica_states = replica_sink_of_states(s->replicas, shares,
                                               r->share_counts[chain], scale);
    s->replica_large = replica_sink_of_large(s->replicas, shares, r->share_counts[chain],
                                             scale);
    splat_sinks_append(&s->to.states, &s->replica_states.sink);
    if (m->films.large)
        splat_sinks_append(&s->to.large, &s->replica_large.sink);
}

static void add_tiles(struct sink_set *s, const struct markov *m, int chain)
{
    const struct markov_missed *missed = &m->missed;
    if (!missed->large)
        return;
    s->tiles = tile_sink_of(missed->large + (size_t)chain * (size_t)missed->grid.tiles,
                            missed->tile_of);
    splat_sinks_append(&s->to.large, &s->tiles.sink);
}

/* A chain makes p_l large steps a mutation, and its film of large steps is in units of
 * b0. */
static void add_rest(struct sink_set *s, const struct markov *m,
                     const struct group *group)
{
    double large = m->split ? m->split->split.large[group->length] : 0.0;
    double unit = group->params.p_large * group->params.b0;
    if (!(large > 0.0 && unit > 0.0 && m->films.large))
        return;
    s->rest = rest_sink_of(large / unit, &s->large.sink,
                           s->replica_large.sink.add ? &s->replica_large.sink : NULL,
                           s->large_classes.sink.add ? &s->large_classes.sink : NULL);
    splat_sinks_append(&s->to.large, &s->rest.sink);
}

void markov_sinks_init(struct sink_set *sinks, const struct markov *m, int chain,
                       int thread)
{
    const struct group *group = &m->groups[m->group_of[chain]];
    *sinks = (struct sink_set){0};
    add_films(sinks, m, group, thread);
    add_replicas(sinks, m, group, chain, thread);
    add_tiles(sinks, m, chain);
    add_layers(sinks, m, group, thread);
    add_rest(sinks, m, group);
    if (m->tours)
        sinks->to.tape = &m->tours->tapes[chain];
}

void markov_sinks_flush(const struct sink_set *sinks)
{
    if (sinks->replicas)
        replica_flush(sinks->replicas);
}
