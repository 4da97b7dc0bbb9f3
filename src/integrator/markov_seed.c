/* Independent paths of every length, the chains that each length gets, their films and
 * their seeds (DESIGN sections 3 and 4). */

#include "base/mem.h"
#include "base/par.h"
#include "integrator/markov_state.h"

/* Lengths below this share of b may do without a film of their own, where films would
 * take more than FILMS_BYTES. */
#define SMALL_SHARE 0.01
#define FILMS_BYTES 0x1p30
/* Whatever their share: so many lengths have films of their own, the brightest, or as
 * many as fit here. That bounds the films for any depth. */
#define OWN_FILMS      12
#define OWN_FILM_BYTES 0x1p32

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

/* --- films ------------------------------------------------------------------------ */

static struct film *create_film(struct markov *m)
{
    const struct camera *camera = &m->scene->camera;
    return m->films[m->film_count++] = film_create(camera->width, camera->height);
}

/* A step that excludes proposals wants a film for each length. */
static bool some_may_share(const struct markov *m)
{
    double bytes = film_bytes(m->scene->camera.width, m->scene->camera.height);
    return !m->design.step->excludes && bytes * m->group_count > FILMS_BYTES;
}

/* How many films groups can have at most, the shared one included. */
static int films_at_most(const struct markov *m)
{
    double bytes = film_bytes(m->scene->camera.width, m->scene->camera.height);
    int own = (int)fmax(OWN_FILMS, fmin(OWN_FILM_BYTES / bytes, DIMS_MAX_DEPTH));
    return some_may_share(m) && own + 1 < m->group_count ? own + 1 : m->group_count;
}

/* How many groups are brighter; of equals the first. */
static int rank_of(const struct markov *m, const struct group *group)
{
    int rank = 0;
    for (const struct group *g = m->groups; g < m->groups + m->group_count; g++)
        rank += g->bootstrap.b > group->bootstrap.b ||
                (g < group && g->bootstrap.b >= group->bootstrap.b);
    return rank;
}

static bool may_share(const struct markov *m, const struct group *group)
{
    if (!some_may_share(m))
        return false;
    bool crowded = films_at_most(m) < m->group_count;
    return group->bootstrap.b < SMALL_SHARE * m->b0 ||
           (crowded && rank_of(m, group) + 1 >= films_at_most(m));
}

static void create_films(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        group->shares = may_share(m, group);
        if (!group->shares) {
            group->film = create_film(m);
            continue;
        }
        if (m->shared == NULL)
            m->shared = create_film(m);
        group->film = m->shared;
        m->shared_b0 += group->bootstrap.b;
        m->shared_chains += group->chain_count;
    }
    if (settings_estimator(m->settings) == ESTIMATOR_KELEMEN)
        m->large = create_film(m);
    if (m->design.failure_map)
        m->failures = create_film(m);
}

/* Lanes for all films or for none: they take as much again for every thread. */
static void create_lanes(struct markov *m)
{
    for (int i = 0; i < m->film_count; i++)
        film_add_lanes(m->films[i], m->threads, FILM_LANES_BYTES / m->film_count);
}

/* As if none of the lengths below SMALL_SHARE shared: how many will is not known before
 * the bootstrap. */
double markov_film_bytes(const void *self)
{
    const struct markov *m = self;
    int width = m->scene->camera.width, height = m->scene->camera.height;
    int films = films_at_most(m) + (m->design.failure_map ? 1 : 0) +
                (settings_estimator(m->settings) == ESTIMATOR_KELEMEN ? 1 : 0);
    double lanes = film_lanes_bytes(width, height, m->threads), laned = films;
    if (lanes * films > FILM_LANES_BYTES)
        laned = some_may_share(m) ? floor(FILM_LANES_BYTES / lanes) : 0.0;
    return films * film_bytes(width, height) + laned * lanes + markov_replicas_bytes(m) +
           (m->direct ? passes_film_bytes(m->direct) : 0.0);
}

/* What makes the splats of several groups terms of one sum, see struct group. */
static double scale(double b0, int chains, double all_b0, int all_chains)
{
    return all_b0 > 0.0 ? b0 / chains / (all_b0 / all_chains) : 0.0;
}

static void set_params(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        double b0 = group->bootstrap.b;
        group->params.b0 = b0;
        group->params.estimator = settings_estimator(m->settings);
        group->params.chain_scale = 1.0;
        group->params.large_scale = scale(b0, group->chain_count, m->b0, m->chain_count);
        if (group->shares)
            group->params.chain_scale = scale(b0, group->chain_count, m->shared_b0,
                                              m->shared_chains);
    }
}

void markov_equip(struct markov *m)
{
    create_films(m);
    create_lanes(m);
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
        no_light_found(m);
        return;
    }
    markov_allocate(m);
    markov_equip(m);
    seed_chains(m);
    m->phase = PHASE_START;
}
