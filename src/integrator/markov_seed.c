/* Independent paths of every length, the chains that each length gets, what these are
 * equipped with, and their seeds (DESIGN sections 3 and 4). */

#include "base/mem.h"
#include "base/par.h"
#include "integrator/markov_state.h"

static void bootstrap_group(struct markov *m, int index, long paths)
{
    struct group *group = &m->groups[index];
    group->first_path = index * paths;
    bootstrap_run(&group->bootstrap, group->first_path, paths,
                  (uint64_t)m->settings->seed, m->design.max_splats,
                  m->targets + (size_t)index * (size_t)m->threads, m->threads);
    for (long i = 0; i < paths; i++)
        welford_add(&group->independent, group->bootstrap.targets[i]);
    m->b0 += group->bootstrap.b;
}

static void set_params(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        double b0 = group->bootstrap.b;
        group->params.b0 = b0;
        group->params.estimator = settings_estimator(m->settings);
        group->states_scale = 1.0;
        group->large_scale = b0 / group->chain_count / (m->b0 / m->chain_count);
    }
}

void markov_equip(struct markov *m)
{
    markov_films_create(m);
    set_params(m);
    markov_replicas_create(m);
}

/* --- seeds ------------------------------------------------------------------------ */

struct seeding {
    struct markov *m;
    const long *seeds; /* [chain_count] */
};

static void seed_one(void *ctx, long index, int thread)
{
    struct seeding *s = ctx;
    struct markov *m = s->m;
    int group = m->group_of[index];
    chain_seed(&m->chains[index], &m->targets[group * m->threads + thread],
               (uint64_t)m->settings->seed, (uint64_t)s->seeds[index], (uint64_t)index);
}

static void seed_chains(struct markov *m)
{
    long *seeds = mem_alloc((size_t)m->chain_count, sizeof *seeds);
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        long *own = seeds + group->first_chain;
        struct rng rng;
        rng_init(&rng, (uint64_t)m->settings->seed, RNG_SELECT, (uint64_t)i);
        bootstrap_select(&group->bootstrap, rng_double(&rng), own, group->chain_count);
        for (int j = 0; j < group->chain_count; j++)
            own[j] += group->first_path;
    }
    par_for(m->chain_count, m->threads, seed_one, &(struct seeding){m, seeds});
    mem_free(seeds);
}

static void forget_paths(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++)
        bootstrap_deinit(&m->groups[i].bootstrap);
}

static void no_light_found(struct markov *m)
{
    struct statistics none = {.large = m->settings->bootstrap};
    if (settings_auto(m->settings))
        m->plarge = plarge_zsolnai2013(&none);
    else
        markov_manual_plarge(m);
    m->phase = PHASE_MAIN;
    m->dark = true;
}

void markov_bootstrap(struct markov *m)
{
    long paths = m->settings->bootstrap / (m->group_count > 0 ? m->group_count : 1);
    for (int i = 0; i < m->group_count; i++)
        bootstrap_group(m, i, paths > 1 ? paths : 1);
    if (!(m->b0 > 0.0)) {
        forget_paths(m);
        no_light_found(m);
        return;
    }
    markov_allocate(m);
    seed_chains(m);
    markov_missed_create(m);
    markov_missed_meet(m);
    forget_paths(m); /* before films are made: there may be many of both */
    markov_equip(m);
    m->phase = PHASE_START;
}
