/* A run of chains: its allocations, their predicted memory, and its phases. */

#include "integrator/markov.h"

#include "base/clock.h"
#include "base/mem.h"
#include "integrator/markov/markov_bootstrap.h"
#include "integrator/markov/markov_errors.h"
#include "integrator/markov/markov_evidence.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_fixed.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_missed.h"
#include "integrator/markov/markov_pack.h"
#include "integrator/markov/markov_part.h"
#include "integrator/markov/markov_replica.h"
#include "integrator/markov/markov_result.h"
#include "integrator/markov/markov_round.h"
#include "integrator/markov/markov_seed.h"
#include "integrator/markov/markov_split.h"
#include "integrator/markov/markov_start.h"
#include "integrator/markov/markov_state.h"
#include "integrator/markov/markov_tours.h"

#include <float.h>

/* Mutations of a chain in a round. The threads wait for each other at the end of a round,
 * so short rounds cost time. */
#define ROUND_MUTATIONS 128
#define ROUND_MOST      0x1p21 /* mutations of all chains in a round */

/* --- making ----------------------------------------------------------------------- */

/* Decides the path lengths and the number of chains; allocates nothing. */
static void plan_groups(struct markov *m)
{
    const struct markov_design *design = &m->design;
    for (int length = design->first_length; length <= design->last_length; length++)
        if (!design->has_length || design->has_length(m->scene, length))
            m->lengths[m->group_count++] = length;
    m->bootstrap = (markov_split_bootstrap(m) - markov_split_samples(m)) /
                   (m->group_count > 0 ? m->group_count : 1);
    m->bootstrap = m->bootstrap > 1 ? m->bootstrap : 1;
    int least = design->last_length > 0 ? MARKOV_CHAINS_LEAST * m->group_count : 1;
    m->chain_count = m->settings->chains > least ? (int)m->settings->chains : least;
}

/* Creates the targets of each group, one a thread. */
static void create_groups(struct markov *m)
{
    size_t groups = (size_t)m->group_count, threads = (size_t)m->threads;
    m->groups = mem_alloc(groups, sizeof *m->groups);
    m->targets = mem_alloc(groups * threads, sizeof *m->targets);
    for (size_t i = 0; i < groups; i++) {
        m->groups[i].length = m->lengths[i];
        for (size_t j = 0; j < threads; j++)
            m->targets[i * threads + j] = markov_split_target(
                m, m->design.target_create(m->scene, m->settings, m->lengths[i]),
                m->lengths[i]);
    }
}

static void chain_arrays(struct markov *m, struct mem_plan *plan)
{
    size_t chains = (size_t)m->chain_count;
    m->chains = mem_take(plan, MEM_APART, chains, sizeof *m->chains);
    m->start.tallies = mem_take(plan, 0, chains, sizeof *m->start.tallies);
    m->group_of = mem_take(plan, 0, chains, sizeof *m->group_of);
    m->seeds = mem_take(plan, 0, chains, sizeof *m->seeds);
}

/* Options of the chains' state. */
static const void *state_options(const struct markov_design *design)
{
    if (design->state == &state_mlt)
        return &design->mlt;
    return &design->pss;
}

static void create_chains(struct markov *m)
{
    const struct settings *s = m->settings;
    struct markov_design *design = &m->design;
    double pixels = markov_pixels(m);
    chain_arrays(m, &(struct mem_plan){.take = true});
    kernel_init(&design->pss.kernel, settings_kernel(s), settings_sigma(s, pixels), s->s1,
                settings_s2(s, pixels));
    for (int i = 0; i < m->chain_count; i++)
        chain_init(&m->chains[i], design->state, state_options(design),
                   design->max_splats);
}

static void plan_budget(struct markov *m)
{
    const struct settings *s = m->settings;
    m->rounds.full = (long)(ROUND_MOST / m->chain_count);
    m->rounds.full = m->rounds.full < 1                 ? 1
                     : m->rounds.full > ROUND_MUTATIONS ? ROUND_MUTATIONS
                                                        : m->rounds.full;
    /* A run must be reproducible from the mutations per pixel that it reports: rounding
     * must not add a mutation. */
    if (s->seconds <= 0.0)
        m->budget = fmin(s->mutations_per_pixel * markov_pixels(m), 0x1p62) *
                    (1.0 - 4.0 * DBL_EPSILON);
    markov_start_plan(m);
}

static struct markov_design design_of(const struct integrator_type *type,
                                      const struct scene *scene,
                                      const struct settings *settings)
{
    return ((const struct markov_integrator *)type)->design(scene, settings);
}

/* Passes beside the chains: of what a split leaves, or of short paths. */
static struct passes_plan passes_of(const struct markov_design *design)
{
    if (design->plain_lengths > 0)
        return (struct passes_plan){design->plain_lengths, estimate_pt, false, false,
                                    NULL};
    return design->passes;
}

static void *create(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings)
{
    struct markov *m = mem_alloc(1, sizeof *m);
    m->scene = scene;
    m->settings = settings;
    m->design = design_of(type, scene, settings);
    m->threads = settings_threads(settings);
    plan_groups(m);
    markov_split_create(m);
    create_groups(m);
    create_chains(m);
    struct passes_plan passes = passes_of(&m->design);
    m->passes_share = PLAIN_SHARE;
    if (passes.estimate)
        m->direct = passes_create(scene, settings, &passes);
    plan_budget(m);
    markov_films_create(m);
    markov_replicas_create(m);
    return m;
}

static void destroy(void *self)
{
    struct markov *m = self;
    for (int i = 0; i < m->chain_count; i++)
        chain_deinit(&m->chains[i]);
    for (int i = 0; i < m->group_count * m->threads; i++) {
        struct target inner = markov_split_unwrap(m->targets[i]);
        m->design.target_destroy(&inner);
    }
    for (int i = 0; i < m->group_count; i++)
        bootstrap_deinit(&m->groups[i].bootstrap);
    for (int i = 0; i < m->films.count; i++)
        film_destroy(m->films.all[i]);
    if (m->direct)
        passes_destroy(m->direct);
    markov_errors_destroy(m->errors);
    markov_missed_destroy(m);
    markov_tours_destroy(m);
    markov_split_destroy(m);
    markov_replicas_destroy(m);
    mem_free(m->missing);
    mem_free(m->groups);
    mem_free(m->group_of);
    mem_free(m->seeds);
    mem_free(m->start.tallies);
    mem_free(m->chains);
    mem_free(m->targets);
    mem_free(m);
}

/* --- memory ----------------------------------------------------------------------- */

/* Adds the memory of the bootstrap; most runs never take `extra`. */
static void bootstrap_memory(const struct markov *m, struct run_memory *out)
{
    double path = sizeof(double) + sizeof(int32_t), most = markov_bootstrap_most(m);
    double planned = (double)m->bootstrap * fmax(m->group_count, 1.0);
    out->states += most * path;
    out->extra += (most - planned) * path;
}

/* Of the target of one thread. */
static double scratch_bytes(const struct markov *m, int depth)
{
    if (m->design.state == &state_mlt)
        return (double)sizeof(struct path_space) + path_space_bytes(m->scene, depth);
    return subpaths_bytes(m->scene, depth) + m->design.target_bytes;
}

static double states_memory(struct markov *m)
{
    struct mem_plan plan = {.take = false};
    double each = chain_bytes(m->design.state, state_options(&m->design),
                              m->design.max_splats);
    double scratch = 0.0;
    chain_arrays(m, &plan);
    for (int i = 0; i < m->group_count; i++) {
        int depth = m->lengths[i] > 0 ? m->lengths[i] : m->design.depth;
        scratch += m->threads * scratch_bytes(m, depth);
    }
    return m->chain_count * each + plan.bytes + scratch;
}

static void memory(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out)
{
    struct markov m = {
        .scene = scene,
        .settings = settings,
        .design = design_of(type, scene, settings),
        .threads = settings_threads(settings),
    };
    plan_groups(&m);
    markov_films_memory(&m, out);
    out->states += states_memory(&m);
    bootstrap_memory(&m, out);
    markov_replicas_memory(&m, out);
    markov_missed_memory(&m, out);
    markov_tours_memory(&m, out);
    markov_split_memory(&m, out);
    struct passes_plan passes = passes_of(&m.design);
    /* Where a split takes samples by technique; passes_memory reads no more of it. */
    struct split split = {.by_technique = m.design.last_length > 0};
    passes.split = m.design.split && passes.estimate ? &split : NULL;
    if (passes.estimate)
        passes_memory(scene, settings, &passes, out);
}

/* --- phases ----------------------------------------------------------------------- */

static bool advance(void *self, const struct round_limits *limits)
{
    struct markov *m = self;
    if (m->phase == PHASE_BOOTSTRAP) {
        double begin = clock_wall();
        markov_begin(m, limits);
        m->start.seconds += clock_wall() - begin;
    } else if (m->phase == PHASE_START) {
        markov_start_round(m, limits);
    } else if (!m->no_light) {
        markov_run_round(m, 0, limits);
    }
    if (m->direct)
        markov_run_passes(m, limits);
    return !m->rounds.out_of_time && (m->direct || !m->no_light) &&
           (m->budget == 0.0 || m->paths < m->budget);
}

static bool started(const void *self)
{
    const struct markov *m = self;
    return m->phase == PHASE_MAIN;
}

static void set_part(void *self, struct run_part part)
{
    struct markov *m = self;
    m->part = part;
    if (m->phase == PHASE_MAIN) /* the state at the end of the start was read */
        markov_part_begin(m);
}

static double progress(const void *self)
{
    const struct markov *m = self;
    return m->budget > 0.0 ? m->paths / m->budget : 0.0;
}

const struct integrator_methods markov_methods = {
    .chains = true,
    .memory = memory,
    .create = create,
    .set_part = set_part,
    .advance = advance,
    .started = started,
    .picture = markov_picture,
    .fixed_picture = markov_fixed_picture,
    .layers = markov_layers,
    .statistics = markov_statistics,
    .counts = markov_counts,
    .progress = progress,
    .pack = markov_pack,
    .complete = markov_complete,
    .evidence = markov_evidence,
    .destroy = destroy,
};
