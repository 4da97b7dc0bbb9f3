/* A round: every chain makes the same number of mutations, and plain samples keep pace.
 */

#include "integrator/markov/markov_round.h"

#include "base/clock.h"
#include "base/par.h"
#include "base/part.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_replica.h"
#include "integrator/markov/markov_sinks.h"
#include "integrator/markov/markov_state.h"

#define ROUND_SECONDS 0.1  /* s, length of a round under a time budget, at most */
#define ROUND_SHARE   0.5  /* and this share of the time left, as the pace may change */
#define ROUND_LATE    0.05 /* s, by which a round may be expected to exceed the budget */
#define PACE_GROWTH   4.0  /* limit of the length of a round relative to the last one */
#define DARK_ROUND    0.05 /* s, a round under a time budget without chains */

static void advance_one(void *ctx, long index, int thread)
{
    struct markov *m = ctx;
    struct chain *chain = &m->chains[index];
    if (m->phase == PHASE_MAIN && !part_owns_chain(m->part, (int)index))
        return;
    const struct group *group = &m->groups[m->group_of[index]];
    const struct target *target = &m->targets[m->group_of[index] * m->threads + thread];
    struct sink_set sinks;
    markov_sinks_init(&sinks, m, (int)index, thread);
    m->design.step->advance(chain, &group->params, target, &sinks.to, m->rounds.current);
    chain_flush(chain, &group->params, &sinks.to);
    markov_sinks_flush(&sinks);
}

/* Of one mutation: a jump, which traces two, has no second stage. */
static int most_paths(const struct markov *m)
{
    bool jumps = m->design.state->moves[MOVE_JUMP] != NULL;
    return jumps || m->design.step->stages > 1 ? 2 : 1;
}

/* Paths of all chains so far. After the start, of which every part of a run knows all
 * chains, second proposals and jumps are those that it predicts, so that all parts end
 * alike. */
static double count_chain_paths(const struct markov *m)
{
    const struct markov_rounds *r = &m->rounds;
    double paths = 0.0;
    if (most_paths(m) < 2)
        return (double)m->done * m->chain_count;
    if (m->phase == PHASE_MAIN)
        return r->start_paths +
               (double)(m->done - r->start_done) * m->chain_count * r->paths_each;
    for (int i = 0; i < m->chain_count; i++)
        paths += (double)tally_paths(&m->chains[i].tally);
    return paths;
}

/* Paths of the budget that chains may trace: their share, and what whole passes leave
 * over. */
static double chain_budget(const struct markov *m, double chains)
{
    double all = m->budget - (m->paths - chains),
           share = (1.0 - m->passes_share) * m->budget;
    return m->direct && chains < share && share < all ? share : all;
}

/* Second proposals and jumps of a mutation after the start. */
static double further_paths(const struct markov *m, const struct tally *t, double p_large)
{
    double large = (double)t->proposed[MOVE_LARGE];
    double local = (double)tally_local(t->proposed);
    double jumps = (double)t->proposed[MOVE_JUMP], failing = 0.0;
    if (m->design.step->stages > 1) {
        double no_large = large - (double)t->nonzero[MOVE_LARGE];
        double no_local = local - (double)tally_local(t->nonzero);
        failing = (large > 0.0 ? p_large * no_large / large : 0.0) +
                  (local > 0.0 ? (1.0 - p_large) * no_local / local : 0.0);
    }
    return failing + (local > 0.0 ? (1.0 - p_large) * jumps / local : 0.0);
}

void markov_predict_paths(struct markov *m)
{
    struct markov_rounds *r = &m->rounds;
    r->start_paths = count_chain_paths(m);
    r->start_done = m->done;
    r->paths_each = 1.0;
    for (int i = 0; most_paths(m) > 1 && i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        struct tally t = group_tally(m, group);
        r->paths_each += further_paths(m, &t, group->params.p_large) *
                         group->chain_count / m->chain_count;
    }
}

static double paths_of_mutation(const struct markov *m)
{
    return m->phase == PHASE_MAIN ? m->rounds.paths_each : most_paths(m);
}

/* The longest round after which at most the last mutation exceeds the budget of paths. */
static long round_length(const struct markov *m, long until)
{
    double left = until > 0 ? (double)(until - m->done) : (double)m->rounds.full;
    double chains = count_chain_paths(m);
    if (m->budget > 0.0)
        left = fmin(left, ceil((chain_budget(m, chains) - chains) /
                               (m->chain_count * paths_of_mutation(m))));
    return left < (double)m->rounds.full ? (long)left : m->rounds.full;
}

/* The same under a time budget, from the pace of the last round: half of the time left,
 * so that rounds get shorter towards the end. In a round all chains make the same number
 * of mutations; 0 if one mutation of all chains would take too long. */
static long timed_round_length(const struct markov *m, const struct round_limits *limits)
{
    double left = m->settings->seconds - limits->seconds_used;
    double most = fmin((double)m->rounds.full, PACE_GROWTH * (double)m->rounds.current);
    if (m->rounds.pace > left + ROUND_LATE)
        return 0;
    left = fmin(ROUND_SHARE * left, ROUND_SECONDS);
    return m->rounds.pace > 0.0 ? (long)fmax(fmin(left / m->rounds.pace, most), 1.0) : 1;
}

void markov_run_round(struct markov *m, long until, const struct round_limits *limits)
{
    double begin = clock_wall();
    bool timed = m->settings->seconds > 0.0;
    long length = timed ? timed_round_length(m, limits) : round_length(m, until);
    m->rounds.out_of_time = timed && length < 1;
    if (length < 1)
        return;
    m->rounds.current = length;
    double samples = m->paths - count_chain_paths(m);
    markov_set_shared_weights(m);
    markov_replicas_set_weights(m);
    par_for(m->chain_count, m->threads, advance_one, m);
    m->done += m->rounds.current;
    for (int i = 0; i < m->group_count; i++)
        m->groups[i].fixed_light += (double)m->rounds.current * m->groups[i].fixed_b;
    markov_replicas_round(m);
    m->paths = count_chain_paths(m) + samples;
    m->rounds.pace = (clock_wall() - begin) / (double)m->rounds.current;
}

/* Under a time budget plain samples are added by rows, not by passes, and end with the
 * budget. Before two passes are complete they get as much time as the chains had in this
 * round, as a pass may take long. */
static void run_rows(struct markov *m, const struct round_limits *limits, double due)
{
    double now = clock_wall(), until = limits->until;
    if (m->no_light)
        until = fmin(until, now + DARK_ROUND);
    else if (passes_whole(m->direct) < 2)
        until = fmin(until, now + (now - limits->begin));
    while (passes_paths(m->direct) < due && clock_wall() < until)
        passes_trace(m->direct, due - passes_paths(m->direct), until, NULL);
}

/* Plain samples keep pace with the chains by passes of one sample a pixel. The first two
 * passes run at once, as the error is unknown before the second. Without chains the
 * passes go on alone. */
void markov_run_passes(struct markov *m, const struct round_limits *limits)
{
    double pixels = markov_pixels(m), chains = count_chain_paths(m);
    double due = m->passes_share / (1.0 - m->passes_share) * chains;
    if (m->budget > 0.0)
        due = fmin(due, m->budget - chains);
    due = fmax(due, 2.0 * pixels);
    if (m->no_light)
        due = passes_paths(m->direct) + pixels;
    if (limits->until > 0.0)
        run_rows(m, limits, due);
    else
        while (passes_paths(m->direct) + pixels <= due)
            passes_trace(m->direct, pixels, (double)INFINITY, NULL);
    m->paths = chains + passes_paths(m->direct);
}
