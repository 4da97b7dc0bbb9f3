#include "integrator/markov/markov_split.h"

#include "base/clock.h"
#include "base/mem.h"
#include "image/metric.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/pilot.h"
#include "integrator/markov/split_plan.h"
#include "integrator/pass_target.h"

#define PILOT_SHARE 0.5 /* of the bootstrap's paths */
#define PATHS_SHARE \
    0.08 /* of a budget of paths: bootstrap of a run with passes, at most */
#define PATHS_LEAST 8192.0
#define PILOT_TIME  0.25 /* of start_cap, of a time budget */
#define PILOT_KEPT  16384
#define PILOT_CHUNK 1024 /* samples of a source between two readings of the clock */

/* --- targets ---------------------------------------------------------------------- */

struct split_target {
    struct target inner;
    const struct split *split;
    int length;
};

static void eval_share(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    const struct split_target *t = ctx;
    t->inner.eval(t->inner.ctx, numbers, out);
    split_for_chain(t->split, t->length, out);
}

struct target markov_split_target(const struct markov *m, struct target inner, int length)
{
    if (!m->split)
        return inner;
    struct split_target *t = mem_aligned(MEM_APART, 1, sizeof *t);
    *t = (struct split_target){inner, &m->split->split, length};
    return (struct target){eval_share, t};
}

struct target markov_split_unwrap(struct target target)
{
    if (target.eval != eval_share)
        return target;
    struct split_target *t = target.ctx;
    struct target inner = t->inner;
    mem_free(t);
    return inner;
}

static struct target inner_of(const struct markov *m, int group, int thread)
{
    struct split_target *t = m->targets[group * m->threads + thread].ctx;
    return t->inner;
}

/* --- making ----------------------------------------------------------------------- */

static void arrays(const struct markov *m, struct split *split, struct mem_plan *plan)
{
    split->inverse = mem_take(plan, 0, (size_t)markov_pixels(m), sizeof *split->inverse);
}

void markov_split_create(struct markov *m)
{
    if (!m->design.split)
        return;
    m->split = mem_alloc(1, sizeof *m->split);
    struct split *split = &m->split->split;
    arrays(m, split, &(struct mem_plan){.take = true});
    split->by_technique = m->design.passes.estimate && m->design.last_length > 0;
    for (int k = 1; k <= m->design.depth; k++) {
        struct techniques techniques;
        techniques_init(&techniques, &m->scene->needs, k);
        split->techniques[k] = techniques.count;
        split->only[k] = SPLIT_PASSES;
    }
    for (int i = 0; i < m->group_count; i++)
        split->only[m->lengths[i]] = SPLIT_BOTH;
    m->design.passes.split = split;
}

void markov_split_destroy(struct markov *m)
{
    if (!m->split)
        return;
    markov_split_end_pilot(m);
    mem_free(m->split->split.inverse);
    mem_free(m->split);
}

void markov_split_memory(const struct markov *m, struct run_memory *out)
{
    double pixels = markov_pixels(m), splats = estimate_splats(m->design.depth);
    struct mem_plan plan = {.take = false};
    if (!m->design.split)
        return;
    arrays(m, &(struct split){.unit = 0.0}, &plan);
    /* The pilot: guess and splats; few samples have all of them. */
    double kept = 2.0 * PILOT_KEPT * splats * sizeof(struct pilot_splat);
    out->states += plan.bytes + pixels * sizeof(double) + kept;
    out->extra += kept;
}

/* The planned paths of a run with passes are a share of the budget, as a run of passes
 * alone needs none. */
long markov_split_bootstrap(const struct markov *m)
{
    const struct settings *s = m->settings;
    double paths = s->mutations_per_pixel * markov_pixels(m);
    if (m->design.passes.estimate == NULL || s->seconds > 0.0)
        return s->bootstrap;
    return (long)fmin((double)s->bootstrap, fmax(PATHS_SHARE * paths, PATHS_LEAST));
}

long markov_split_samples(const struct markov *m)
{
    if (!m->design.split)
        return 0;
    long samples = (long)(PILOT_SHARE * (double)markov_split_bootstrap(m));
    return samples > 1 ? samples : 1;
}

/* --- the pilot -------------------------------------------------------------------- */

static struct target *pass_targets(const struct markov *m, int depth,
                                   estimate_function estimate)
{
    struct target *targets = mem_alloc((size_t)m->threads, sizeof *targets);
    for (int i = 0; i < m->threads; i++)
        targets[i] = pass_target_create(m->scene, depth, estimate);
    return targets;
}

static struct target *group_targets(const struct markov *m, int group)
{
    struct target *targets = mem_alloc((size_t)m->threads, sizeof *targets);
    for (int i = 0; i < m->threads; i++)
        targets[i] = inner_of(m, group, i);
    return targets;
}

static void destroy_targets(const struct markov *m, struct target *targets)
{
    for (int i = 0; i < m->threads; i++)
        pass_target_destroy(&targets[i]);
    mem_free(targets);
}

/* What the pilot samples: the passes, whose splats are kept; without these the chains'
 * targets, and the plain samples of short paths. */
static int sources(const struct markov *m, struct pilot_job *jobs)
{
    const struct passes_plan *passes = &m->design.passes;
    int count = 0;
    if (passes->estimate) {
        jobs[count++] = (struct pilot_job){
            .targets = pass_targets(m, passes->depth, passes->estimate),
            .max_splats = estimate_splats_techniques(passes->depth),
            .keep = true};
    } else {
        for (int i = 0; i < m->group_count; i++)
            jobs[count++] = (struct pilot_job){.targets = group_targets(m, i),
                                               .max_splats = m->design.max_splats};
        if (m->design.plain_lengths > 0)
            jobs[count++] = (struct pilot_job){
                .targets = pass_targets(m, m->design.plain_lengths, estimate_pt),
                .max_splats = estimate_splats(m->design.plain_lengths)};
    }
    return count;
}

/* Equal numbers of samples of each source; under a time budget as many as there is time
 * for. */
static void trace(struct markov *m, const struct round_limits *limits)
{
    struct pilot_job jobs[DIMS_MAX_DEPTH + 1];
    const struct settings *s = m->settings;
    int count = sources(m, jobs);
    if (count == 0)
        return;
    long each = (markov_split_samples(m) + count - 1) / count, done = 0;
    double begin = clock_wall();
    while (done < each) {
        long chunk = each - done < PILOT_CHUNK ? each - done : PILOT_CHUNK;
        for (int i = 0; i < count; i++) {
            jobs[i].threads = m->threads;
            jobs[i].seed = (uint64_t)s->seed;
            jobs[i].first = i * each + done;
            jobs[i].factor = count;
            pilot_trace(m->split->pilot, &jobs[i], chunk);
        }
        done += chunk;
        if (s->seconds > 0.0 && limits->seconds_used + clock_wall() - begin >=
                                    PILOT_TIME * s->start_cap * s->seconds)
            break;
    }
    m->split->seconds = clock_wall() - begin;
    for (int i = 0; i < count; i++)
        destroy_targets(m, (struct target *)jobs[i].targets);
}

void markov_split_pilot(struct markov *m, const struct round_limits *limits)
{
    if (!m->split)
        return;
    struct split *split = &m->split->split;
    m->split->pilot = mem_alloc(1, sizeof *m->split->pilot);
    pilot_init(m->split->pilot, m->scene->camera.width, m->scene->camera.height,
               PILOT_KEPT);
    trace(m, limits);
    m->split->samples = (double)m->split->pilot->count;
    split->ceiling = (double)INFINITY;
    /* Without a guess chains find no light either. */
    double scale = m->scene->emission_scale;
    if (!pilot_guess(m->split->pilot, m->design.guess,
                     METRIC_RELATIVE_FLOOR / (scale * scale), split))
        split->floor = (double)INFINITY;
}

/* --- the decision ----------------------------------------------------------------- */

/* The targets of the bootstrap's paths, which were those of c = 0 and no ceiling. */
static void retarget(struct markov *m)
{
    const struct split *split = &m->split->split;
    m->b0 = 0.0;
    for (int g = 0; g < m->group_count; g++) {
        struct group *group = &m->groups[g];
        group->independent = (struct welford){0};
        group->independent_fourths = 0.0;
        for (long i = 0; i < group->bootstrap.count; i++) {
            double *f = &group->bootstrap.targets[i], rho = *f / split->unit;
            double s = rho > 0.0 ? split_share(split, rho) : 0.0;
            *f *= s;
            if (i >= m->bootstrap)
                continue;
            m->split->rest_squares[g] += (1.0 - s) * rho * (1.0 - s) * rho;
            welford_add(&group->independent, *f);
            group->independent_fourths += *f * *f * *f * *f;
        }
        bootstrap_summarize(&group->bootstrap, m->bootstrap);
        m->b0 += group->bootstrap.b;
    }
}

/* Paths of the whole run; under a time budget from the pace of the pilot. */
static double planned_paths(const struct markov *m, const struct round_limits *limits)
{
    if (m->budget > 0.0)
        return m->budget;
    double left = fmax(m->settings->seconds - limits->seconds_used, 0.0);
    return left * m->split->samples / fmax(m->split->seconds, 1e-6);
}

/* Lengths without light in the bootstrap: no target can be normalised by it. */
static void assign_lengths(struct markov *m)
{
    enum split_only other = m->design.passes.estimate ? SPLIT_PASSES : SPLIT_CHAINS;
    for (int g = 0; g < m->group_count; g++)
        if (!(m->groups[g].bootstrap.b > 0.0))
            m->split->split.only[m->groups[g].length] = other;
}

void markov_split_decide(struct markov *m, const struct round_limits *limits)
{
    if (!m->split)
        return;
    struct split *split = &m->split->split;
    struct split_plan *plan = &m->split->plan;
    if (m->b0 > 0.0)
        split_plan_find(m, m->split->pilot, planned_paths(m, limits), plan);
    else
        *plan = (struct split_plan){.floor = (double)INFINITY,
                                    .ceiling = (double)INFINITY,
                                    .relmse = (double)NAN,
                                    .passes_alone = (double)NAN,
                                    .chains_alone = (double)NAN,
                                    .reason = "no light was found for chains"};
    split->floor = plan->floor;
    split->ceiling = plan->ceiling;
    if (m->design.passes.estimate)
        m->passes_share = plan->passes;
    retarget(m);
    assign_lengths(m);
}

/* Weights inverse to the variances of the two means, by the pilot and the bootstrap.
 * Without passes large steps estimate all of the rest. */
void markov_split_share_rest(struct markov *m)
{
    if (!m->split)
        return;
    struct split *split = &m->split->split;
    const struct split_plan *plan = &m->split->plan;
    struct pilot *pilot = m->split->pilot;
    struct pilot_rest rest = pilot_rest(pilot, split);
    double chains = (1.0 - plan->passes) * plan->p_large / m->chain_count;
    bool kelemen = settings_estimator(m->settings) == ESTIMATOR_KELEMEN;
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        int k = group->length;
        if (split->only[k] != SPLIT_BOTH || !kelemen)
            continue;
        if (!m->design.passes.estimate) {
            split->large[k] = 1.0;
            continue;
        }
        double square = m->split->rest_squares[g] / fmax(group->independent.count, 1.0);
        double passes = k > 0 ? rest.by_length[k] : rest.square - rest.mean * rest.mean;
        double large = chains * group->chain_count;
        if (square > 0.0 && passes > 0.0)
            split->large[k] = large / square / (large / square + plan->passes / passes);
    }
}

void markov_split_end_pilot(struct markov *m)
{
    if (!m->split || !m->split->pilot)
        return;
    pilot_deinit(m->split->pilot);
    mem_free(m->split->pilot);
    m->split->pilot = NULL;
}

/* --- checkpoints ------------------------------------------------------------------ */

static void pack_plan(struct pack *pack, struct split_plan *plan)
{
    pack_double(pack, "split_floor", &plan->floor);
    pack_double(pack, "split_ceiling", &plan->ceiling);
    pack_double(pack, "split_passes", &plan->passes);
    pack_double(pack, "split_p_large", &plan->p_large);
    pack_double(pack, "split_relmse", &plan->relmse);
    pack_double(pack, "split_passes_alone", &plan->passes_alone);
    pack_double(pack, "split_chains_alone", &plan->chains_alone);
    pack_text(pack, "split_reason", plan->reason, sizeof plan->reason);
}

void markov_split_pack(struct markov *m, struct pack *pack)
{
    if (!m->split)
        return;
    struct split *split = &m->split->split;
    pack_double(pack, "split_unit", &split->unit);
    pack_double(pack, "split_samples", &m->split->samples);
    pack_plan(pack, &m->split->plan);
    pack_double(pack, "floor", &split->floor);
    pack_double(pack, "ceiling", &split->ceiling);
    pack_double(pack, "passes_share", &m->passes_share);
    for (int k = 0; k <= m->design.depth; k++) {
        int only = (int)split->only[k];
        pack_int(pack, "only", &only, SPLIT_BOTH, SPLIT_PASSES);
        split->only[k] = (enum split_only)only;
        pack_double(pack, "large", &split->large[k]);
    }
    if (m->phase != PHASE_BOOTSTRAP)
        pack_floats(pack, "inverse", split->inverse, (size_t)markov_pixels(m));
}
