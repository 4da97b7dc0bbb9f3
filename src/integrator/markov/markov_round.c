/* A round: every chain advances by as many mutations, and plain samples keep up. */

#include "integrator/markov/markov_round.h"

#include "base/clock.h"
#include "base/par.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_replica.h"
#include "integrator/markov/markov_sinks.h"
#include "integrator/markov/markov_state.h"

#define ROUND_SECONDS 0.1  /* where the clock decides, at most */
#define ROUND_SHARE   0.5  /* and so much of what is left: the pace may change */
#define ROUND_LATE    0.05 /* s, that a round may be expected to end too late */
#define PACE_GROWTH   4.0  /* a round may be so much longer than the last one */
#define PLAIN_SHARE   0.25 /* of all paths, where some lengths need no chain */
#define DARK_ROUND    0.05 /* s, of a time budget, where none does */

static void advance_one(void *ctx, long index, int thread)
{
    struct markov *m = ctx;
    struct chain *chain = &m->chains[index];
    const struct group *group = &m->groups[m->group_of[index]];
    const struct target *target = &m->targets[m->group_of[index] * m->threads + thread];
    struct sink_set sinks;
    markov_sinks_init(&sinks, m, (int)index, thread);
    m->design.step->advance(chain, &group->params, target, &sinks.to, m->this_round);
    chain_flush(chain, &group->params, &sinks.to);
    markov_sinks_flush(&sinks);
}

static double count_chain_paths(const struct markov *m)
{
    double paths = 0.0;
    if (m->design.step->stages < 2)
        return (double)m->done * m->chain_count;
    for (int i = 0; i < m->chain_count; i++)
        for (int j = 0; j < MOVES_MOST; j++)
            paths += (double)m->chains[i].tally.proposed[j];
    return paths;
}

/* What chains may trace of a budget: their share, and then what whole passes leave. */
static double chain_budget(const struct markov *m, double chains)
{
    double all = m->budget - (m->paths - chains), share = (1.0 - PLAIN_SHARE) * m->budget;
    return m->direct && chains < share && share < all ? share : all;
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

/* The same where the clock decides: of the pace that the last round had, and half of what
 * is left of the budget, so that the rounds get shorter towards its end. A round cannot
 * end before each chain has done as much as the others: 0 if one mutation of all would
 * take too long. */
static long timed_round_length(const struct markov *m, const struct round_limits *limits)
{
    double left = m->settings->seconds - limits->seconds_used;
    double most = fmin((double)m->round, PACE_GROWTH * (double)m->this_round);
    if (m->pace > left + ROUND_LATE)
        return 0;
    left = fmin(ROUND_SHARE * left, ROUND_SECONDS);
    return m->pace > 0.0 ? (long)fmax(fmin(left / m->pace, most), 1.0) : 1;
}

void markov_run_round(struct markov *m, long until, const struct round_limits *limits)
{
    double begin = clock_wall();
    bool timed = m->settings->seconds > 0.0;
    long length = timed ? timed_round_length(m, limits) : round_length(m, until);
    m->out_of_time = timed && length < 1;
    if (length < 1)
        return;
    m->this_round = length;
    double samples = m->paths - count_chain_paths(m);
    markov_set_shared_weights(m);
    markov_replicas_set_weights(m);
    par_for(m->chain_count, m->threads, advance_one, m);
    m->done += m->this_round;
    markov_replicas_round(m);
    m->paths = count_chain_paths(m) + samples;
    m->pace = (clock_wall() - begin) / (double)m->this_round;
}

/* With a time budget plain samples are added by rows, not by passes, and end with it.
 * Until there are two passes they get as much time as the chains' part of the round had:
 * a pass may take long. */
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

/* Plain samples keep up with the chains, a pass of one a pixel at a time. The first two
 * come at once: without a second no error is known. Where chains have nothing to do they
 * go on alone. */
void markov_run_passes(struct markov *m, const struct round_limits *limits)
{
    double pixels = markov_pixels(m), chains = count_chain_paths(m);
    double due = PLAIN_SHARE / (1.0 - PLAIN_SHARE) * chains;
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
