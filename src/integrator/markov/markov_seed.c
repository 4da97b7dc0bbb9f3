/* Creates the outputs and parameters of chains, and seeds them.
 */

#include "integrator/markov/markov_seed.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "integrator/markov/markov_allocate.h"
#include "integrator/markov/markov_bootstrap.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_missed.h"
#include "integrator/markov/markov_part.h"
#include "integrator/markov/markov_replica.h"
#include "integrator/markov/markov_split.h"
#include "integrator/markov/markov_start.h"
#include "integrator/markov/markov_state.h"
#include "integrator/markov/markov_tours.h"

static void set_params(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        double b0 = group->bootstrap.b;
        /* A length without a hit weighs as much as one path could have missed. */
        double least = m->b0 / fmax(group->independent.count, 1.0);
        if (!(group->fixed_b > 0.0)) /* else it was read */
            group->fixed_b = fmax(b0, least);
        group->params.b0 = b0;
        group->params.estimator = settings_estimator(m->settings);
        group->states_scale = 1.0;
        group->large_scale = b0 / group->chain_count / (m->b0 / m->chain_count);
    }
}

void markov_create_outputs(struct markov *m)
{
    markov_films_assign(m);
    set_params(m);
    markov_replicas_assign(m);
}

/* --- seeds ------------------------------------------------------------------------ */

static void seed_one(void *ctx, long index, int thread)
{
    struct markov *m = ctx;
    int group = m->group_of[index];
    chain_seed(&m->chains[index], &m->targets[group * m->threads + thread],
               (uint64_t)m->settings->seed,
               markov_path_number(m, group, (long)m->seeds[index]), (uint64_t)index);
}

static void seed_chains(struct markov *m)
{
    long *picked = mem_alloc((size_t)m->chain_count, sizeof *picked);
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        struct rng rng;
        rng_init(&rng, (uint64_t)m->settings->seed, RNG_SELECT, (uint64_t)i);
        bootstrap_select(&group->bootstrap, rng_double(&rng), picked, group->chain_count);
        for (int j = 0; j < group->chain_count; j++)
            m->seeds[group->first_chain + j] = picked[j];
    }
    mem_free(picked);
    double begin = clock_wall();
    par_for(m->chain_count, m->threads, seed_one, m);
    m->rounds.pace = clock_wall() -
                     begin; /* a path of each chain costs about a mutation */
}

static void forget_paths(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++)
        bootstrap_deinit(&m->groups[i].bootstrap);
}

static void no_light_found(struct markov *m)
{
    struct statistics none = {0};
    for (int i = 0; i < m->group_count; i++)
        none.large += m->groups[i].bootstrap.count;
    if (settings_auto(m->settings))
        m->plarge = plarge_zsolnai2013(&none);
    else
        markov_manual_plarge(m);
    m->phase = PHASE_MAIN;
    m->no_light = true;
    markov_part_begin(m);
}

void markov_begin(struct markov *m, const struct round_limits *limits)
{
    markov_split_pilot(m, limits);
    markov_bootstrap_planned(m, limits);
    markov_split_decide(m, limits);
    markov_bootstrap_more(m, limits);
    if (!(m->b0 > 0.0)) {
        markov_split_end_pilot(m);
        forget_paths(m);
        no_light_found(m);
        return;
    }
    markov_allocate(m);
    markov_split_share_rest(m);
    markov_split_end_pilot(m);
    seed_chains(m);
    markov_missed_create(m);
    markov_missed_count_paths(m);
    markov_tours_begin(m);
    forget_paths(m);
    markov_create_outputs(m);
    m->phase = PHASE_START;
}
