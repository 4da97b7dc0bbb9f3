/* Many chains in rounds: what is made once, and what runs again and again. */

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "integrator/markov_state.h"

#include <float.h>

/* Of one chain in a round: waiting for each other at its end costs threads time. */
#define ROUND_MUTATIONS 128
#define ROUND_MOST      0x1p21 /* of all chains */
#define PLAIN_SHARE     0.25   /* of all paths, where some lengths need no chain */

/* --- making ----------------------------------------------------------------------- */

void markov_plan(struct markov *m)
{
    const struct markov_design *design = &m->design;
    for (int length = design->first_length; length <= design->last_length; length++)
        if (!design->has_length || design->has_length(m->scene, length))
            m->lengths[m->group_count++] = length;
    int least = design->last_length > 0 ? MARKOV_CHAINS_LEAST * m->group_count : 1;
    m->chain_count = m->settings->chains > least ? (int)m->settings->chains : least;
}

/* A row of targets, one a thread, for each group. */
static void create_groups(struct markov *m)
{
    size_t groups = (size_t)m->group_count, threads = (size_t)m->threads;
    m->groups = mem_alloc(groups, sizeof *m->groups);
    m->targets = mem_alloc(groups * threads, sizeof *m->targets);
    for (size_t i = 0; i < groups; i++) {
        m->groups[i].length = m->lengths[i];
        for (size_t j = 0; j < threads; j++)
            m->targets[i * threads + j] = m->design.target_create(m->scene, m->settings,
                                                                  m->lengths[i]);
    }
}

static void create_chains(struct markov *m)
{
    const struct settings *s = m->settings;
    struct kernel kernel;
    kernel_init(&kernel, settings_kernel(s), s->sigma, s->s1, s->s2);
    m->chains = mem_aligned(MEM_APART, (size_t)m->chain_count, sizeof *m->chains);
    for (int i = 0; i < m->chain_count; i++)
        chain_init(&m->chains[i], m->design.capacity, m->design.max_splats, &kernel);
    m->start_tallies = mem_alloc((size_t)m->chain_count, sizeof *m->start_tallies);
    m->group_of = mem_alloc((size_t)m->chain_count, sizeof *m->group_of);
}

static void plan_budget(struct markov *m)
{
    const struct settings *s = m->settings;
    m->round = (long)(ROUND_MOST / m->chain_count);
    m->round = m->round < 1 ? 1 : m->round > ROUND_MUTATIONS ? ROUND_MUTATIONS : m->round;
    /* The mutations per pixel that a run reports shall give that run again: rounding must
     * not make one mutation more of it. */
    if (s->seconds <= 0.0)
        m->budget = fmin(s->mutations_per_pixel * markov_pixels(m), 0x1p62) *
                    (1.0 - 4.0 * DBL_EPSILON);
    markov_start_plan(m);
}

struct markov *markov_create(const struct scene *scene, const struct settings *settings,
                             const struct markov_design *design)
{
    struct markov *m = mem_alloc(1, sizeof *m);
    m->scene = scene;
    m->settings = settings;
    m->design = *design;
    m->threads = settings_threads(settings);
    markov_plan(m);
    create_groups(m);
    create_chains(m);
    if (design->plain_lengths > 0)
        m->direct = passes_create(scene, settings, design->plain_lengths, estimate_pt,
                                  false);
    plan_budget(m);
    return m;
}

void markov_destroy(void *self)
{
    struct markov *m = self;
    for (int i = 0; i < m->chain_count; i++)
        chain_deinit(&m->chains[i]);
    for (int i = 0; i < m->group_count * m->threads; i++)
        m->design.target_destroy(&m->targets[i]);
    for (int i = 0; i < m->group_count; i++)
        bootstrap_deinit(&m->groups[i].bootstrap);
    for (int i = 0; i < m->film_count; i++)
        film_destroy(m->films[i]);
    if (m->direct)
        passes_destroy(m->direct);
    markov_replicas_destroy(m);
    mem_free(m->groups);
    mem_free(m->group_of);
    mem_free(m->start_tallies);
    mem_free(m->chains);
    mem_free(m->targets);
    mem_free(m);
}

/* --- rounds ----------------------------------------------------------------------- */

static struct film *lane(struct film *film, int thread)
{
    return film ? film_lane(film, thread) : NULL;
}

static void advance_one(void *ctx, long index, int thread)
{
    struct markov *m = ctx;
    struct chain *chain = &m->chains[index];
    const struct group *group = &m->groups[m->group_of[index]];
    const struct target *target = &m->targets[m->group_of[index] * m->threads + thread];
    struct chain_films films = {
        .chain = film_lane(group->film, thread),
        .large = lane(m->large, thread),
        .failures = lane(m->failures, thread),
    };
    chain->aim = markov_replicas_aim(m, (int)index, thread);
    m->design.step->advance(chain, &group->params, target, &films, m->this_round);
    chain_flush(chain, &group->params, &films);
}

static double count_chain_paths(const struct markov *m)
{
    double paths = 0.0;
    if (m->design.step->stages < 2)
        return (double)m->done * m->chain_count;
    for (int i = 0; i < m->chain_count; i++)
        for (int j = 0; j < MOVES; j++)
            paths += (double)m->chains[i].tally.proposed[j];
    return paths;
}

/* What chains may trace of a budget: their share, and then what whole passes leave. */
static double chain_budget(const struct markov *m, double chains)
{
    double all = m->budget - (m->paths - chains), share = (1.0 - PLAIN_SHARE) * m->budget;
    return m->direct && chains < share && share < all ? share : all;
}

/* Plain samples keep up with the chains, a pass of one a pixel at a time. The first two
 * come at once: without a second no error is known. Where chains have nothing to do they
 * go on alone. */
static void run_passes(struct markov *m, const struct round_limits *limits)
{
    double pixels = markov_pixels(m), chains = count_chain_paths(m);
    double samples = m->paths - chains;
    double due = PLAIN_SHARE / (1.0 - PLAIN_SHARE) * chains;
    if (m->budget > 0.0)
        due = fmin(due, m->budget - chains);
    due = fmax(due, 2.0 * pixels);
    if (m->dark)
        due = samples + pixels;
    for (; samples + pixels <= due; samples += pixels)
        passes_advance(m->direct, limits);
    m->paths = chains + samples;
}

/* The longest round that cannot trace a path too many but in its last mutation. */
static long round_length(const struct markov *m, long until)
{
    double left = until > 0 ? (double)(until - m->done) : (double)m->round;
    double chains = count_chain_paths(m);
    if (m->budget > 0.0)
        left = fmin(left, ceil((chain_budget(m, chains) - chains) /
                               ((double)m->chain_count * m->design.step->stages)));
    return left < (double)m->round ? (long)left : m->round;
}

void markov_run_round(struct markov *m, long until)
{
    m->this_round = round_length(m, until);
    if (m->this_round < 1)
        return;
    double samples = m->paths - count_chain_paths(m);
    markov_weigh_shared(m);
    markov_replicas_weigh(m);
    par_for(m->chain_count, m->threads, advance_one, m);
    m->done += m->this_round;
    markov_replicas_round(m);
    m->paths = count_chain_paths(m) + samples;
}

bool markov_advance(void *self, const struct round_limits *limits)
{
    struct markov *m = self;
    if (m->phase == PHASE_BOOTSTRAP) {
        double begin = clock_wall();
        markov_bootstrap(m);
        m->seconds_startup += clock_wall() - begin;
    } else if (m->phase == PHASE_START) {
        markov_start_round(m, limits);
    } else if (!m->dark) {
        markov_run_round(m, 0);
    }
    if (m->direct)
        run_passes(m, limits);
    return (m->direct || !m->dark) && (m->budget == 0.0 || m->paths < m->budget);
}

bool markov_started(const void *self)
{
    const struct markov *m = self;
    return m->phase == PHASE_MAIN;
}

double markov_progress(const void *self)
{
    const struct markov *m = self;
    return m->budget > 0.0 ? m->paths / m->budget : 0.0;
}
