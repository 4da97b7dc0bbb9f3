/* Traces independent paths of every length: as many as were asked for or as there is time
 * for, and additional ones where their effective number is small.
 *
 * Chains start at paths drawn in proportion to their targets, so if one path is as bright
 * as all others together, there are hardly any distinct seeds. While the effective number
 * of seeds is below SEEDS_WANTED, the lengths responsible for this double their paths.
 * The additional paths serve as seeds only: whether they are traced depends on what the
 * planned ones found, so a mean over both would be biased (too dark). b and b0 come from
 * the planned paths.
 *
 * Under a time budget the bootstrap takes at most half of the time that the start may
 * take. The paths are then traced in small chunks, for all lengths in turn, so that each
 * length has some when time is up. If no light was found by then, tracing goes on up to
 * the planned number, or up to DARK_SHARE of the time where plain samples render a part
 * of the picture. */

#include "integrator/markov/markov_bootstrap.h"

#include "base/clock.h"
#include "integrator/markov/markov_state.h"

#define SEEDS_WANTED 64.0 /* effective number, over all lengths */
#define START_SHARE  0.5  /* of start_cap: of time, or of paths for additional paths */
#define DARK_SHARE   0.5  /* of the time without light, if plain samples need some too */
#define EXTRA_MOST   15   /* additional paths for each planned one: four doublings */
#define CHUNKS_TIME  0.01 /* s; if a chunk of every length takes less, chunks double */

double markov_bootstrap_most(const struct markov *m)
{
    return (double)m->bootstrap * fmax(m->group_count, 1.0) * (EXTRA_MOST + 1.0);
}

/* The planned paths of all lengths are numbered consecutively; the paths of each doubling
 * follow those of all earlier ones. */
uint64_t markov_path_number(const struct markov *m, int group, long i)
{
    long level = m->bootstrap;
    if (i < level)
        return (uint64_t)(group * level + i);
    while (2 * level <= i)
        level *= 2;
    return (uint64_t)((m->group_count + group) * level + i - level);
}

double markov_effective_seeds(const struct markov *m)
{
    double sum = 0.0;
    for (int i = 0; i < m->group_count; i++) {
        const struct bootstrap *paths = &m->groups[i].bootstrap;
        double share = paths->b / m->b0;
        if (paths->b > 0.0)
            /* [Kong92], with lengths as strata. */
            sum += share * share / paths->effective;
    }
    return sum > 0.0 ? 1.0 / sum : 0.0;
}

/* --- paths ------------------------------------------------------------------------- */

struct work {
    struct markov *m;
    double begin, used; /* clock_wall() at the beginning; seconds of the run before it */
    long wanted[DIMS_MAX_DEPTH];
    long chunk; /* paths of a length traced at a time; 0: all */
    bool light; /* a path with a contribution was found */
};

static double seconds_so_far(const struct work *w)
{
    return w->used + clock_wall() - w->begin;
}

/* Whether the clock ends the bootstrap; never under a mutation budget. */
static bool out_of_time(const struct work *w)
{
    const struct settings *s = w->m->settings;
    if (s->seconds <= 0.0)
        return false;
    double dark = w->m->direct ? DARK_SHARE : 1.0;
    double share = w->light ? START_SHARE * s->start_cap : dark;
    return seconds_so_far(w) >= share * s->seconds;
}

/* Does not cross a doubling, where the path numbers jump. */
static void add_paths(struct work *w, int index, long count)
{
    struct markov *m = w->m;
    struct group *group = &m->groups[index];
    long begin = group->bootstrap.count, level = m->bootstrap;
    while (level <= begin)
        level *= 2;
    count = count < level - begin ? count : level - begin;
    bootstrap_extend(&group->bootstrap, (long)markov_path_number(m, index, begin), count,
                     (uint64_t)m->settings->seed, m->design.max_splats,
                     m->targets + (size_t)index * (size_t)m->threads, m->threads);
    for (long i = begin; i < begin + count; i++) {
        double f = group->bootstrap.targets[i];
        w->light = w->light || f > 0.0;
        if (i < m->bootstrap) {
            welford_add(&group->independent, f);
            group->independent_fourths += f * f * f * f;
        }
    }
}

/* Traces a chunk for every length that has paths to trace; when all have some, only as
 * many as time allows. False if no length has any left. */
static bool add_chunks(struct work *w)
{
    bool more = false;
    double begin = clock_wall();
    for (int i = 0; i < w->m->group_count; i++) {
        long left = w->wanted[i] - w->m->groups[i].bootstrap.count;
        if (left <= 0 || (w->m->groups[i].bootstrap.count > 0 && out_of_time(w)))
            continue;
        add_paths(w, i, w->chunk > 0 && w->chunk < left ? w->chunk : left);
        more = true;
    }
    if (clock_wall() - begin < CHUNKS_TIME)
        w->chunk *= 2;
    return more;
}

static void fill_up(struct work *w)
{
    struct markov *m = w->m;
    while (add_chunks(w) && !out_of_time(w))
        continue;
    m->b0 = 0.0;
    for (int i = 0; i < m->group_count; i++) {
        bootstrap_summarize(&m->groups[i].bootstrap, m->bootstrap);
        m->b0 += m->groups[i].bootstrap.b;
    }
}

/* --- more -------------------------------------------------------------------------- */

/* Doubles the paths of the lengths with too few effective seeds for their share of b;
 * returns the number of additional paths, 0 if there are enough seeds. */
static double want_more(struct work *w)
{
    struct markov *m = w->m;
    double wanted = 0.0, effective = markov_effective_seeds(m);
    if (!(effective > 0.0) || effective >= SEEDS_WANTED)
        return 0.0;
    for (int i = 0; i < m->group_count; i++) {
        const struct bootstrap *paths = &m->groups[i].bootstrap;
        double share = paths->b / m->b0;
        bool few = paths->b > 0.0 &&
                   share * share * SEEDS_WANTED * m->group_count >= paths->effective;
        w->wanted[i] = few ? 2 * paths->count : paths->count;
        wanted += (double)(w->wanted[i] - paths->count);
    }
    return wanted;
}

static struct work work_of(struct markov *m, const struct round_limits *limits)
{
    struct work w = {
        .m = m,
        .begin = limits->begin,
        .used = limits->seconds_used,
        .chunk = m->settings->seconds > 0.0 ? 1 : 0,
        .light = m->b0 > 0.0,
    };
    for (int i = 0; i < m->group_count; i++)
        w.wanted[i] = m->bootstrap;
    return w;
}

void markov_bootstrap_planned(struct markov *m, const struct round_limits *limits)
{
    struct work w = work_of(m, limits);
    fill_up(&w);
}

void markov_bootstrap_more(struct markov *m, const struct round_limits *limits)
{
    struct work w = work_of(m, limits);
    double extra = 0.0, most = markov_bootstrap_most(m);
    most -= (double)m->bootstrap * m->group_count;
    if (m->settings->seconds <= 0.0)
        most = fmin(most, START_SHARE * m->settings->start_cap * m->budget);
    while (!out_of_time(&w)) {
        double more = want_more(&w);
        extra += more;
        if (!(more > 0.0) || extra > most)
            break;
        fill_up(&w);
    }
}
