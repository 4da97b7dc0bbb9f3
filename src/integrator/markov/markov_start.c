/* The measured start: its length, its end, and p_l by the rule. */

#include "integrator/markov/markov_start.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_mixing.h"
#include "integrator/markov/markov_part.h"
#include "integrator/markov/markov_round.h"
#include "integrator/markov/markov_state.h"
#include "integrator/markov/markov_tours.h"

#include <stdio.h>

#define START_P_LARGE 0.5
#define START_LOOKS   5

static void set_plarge(struct markov *m, double p_large)
{
    for (int i = 0; i < m->group_count; i++)
        m->groups[i].params.p_large = p_large;
}

void markov_start_plan(struct markov *m)
{
    const struct settings *s = m->settings;
    double p_large = settings_auto(s) ? START_P_LARGE : s->p_large;
    set_plarge(m, p_large);
    m->plarge = (struct plarge){.p_l = p_large, .p_l_hi = 1.0};
    m->start.p_zsolnai = (double)NAN;
    m->start.until = s->start_mutations;
    if (s->seconds > 0.0)
        return;
    double budget = ceil(m->budget / m->chain_count);
    double share = s->start * budget, cap = s->start_cap * budget;
    double start = fmin(fmax(share, (double)s->start_mutations), cap);
    m->start.until = (long)fmax(ceil(start), 1.0);
}

/* Whether the measured start has reached its length. */
static bool start_complete(const struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    if (s->seconds <= 0.0)
        return m->done >= m->start.until || m->paths >= m->budget;
    return seconds >= m->start.cap_s ||
           (m->done >= m->start.until && seconds >= m->start.until_s);
}

/* Under a time budget the start has shares of the time that is left after the independent
 * paths: these alone can take more than start_cap. */
static void plan_seconds(struct markov *m, double used)
{
    const struct settings *s = m->settings;
    m->start.cap_s = used + s->start_cap * fmax(s->seconds - used, 0.0);
    m->start.until_s = fmin(used + s->start * s->seconds, m->start.cap_s);
}

/* Doubles the start while the branch of the rule is unsure; false at the cap. */
static bool extend_start(struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    if (m->start.looks >= START_LOOKS)
        return false;
    if (s->seconds > 0.0) {
        double took = m->rounds.pace * (double)m->done;
        m->start.until_s = fmin(seconds + took, m->start.cap_s);
        m->start.until = 2 * m->done;
        return seconds < m->start.cap_s;
    }
    long cap = (long)(s->start_cap * ceil(m->budget / m->chain_count));
    m->start.until = 2 * m->done < cap ? 2 * m->done : cap;
    return m->start.until > m->done;
}

void markov_manual_plarge(struct markov *m)
{
    double p = m->settings->p_large;
    m->plarge = (struct plarge){.p_l = p, .p_l_lo = p, .p_l_hi = p};
    snprintf(m->plarge.reason, sizeof m->plarge.reason, "p_l = %g was given", p);
    for (int i = 0; i < m->group_count; i++)
        m->groups[i].plarge = m->plarge;
}

/* One p_l for all lengths, from their statistics weighted by brightness. */
static bool decide_for_all(struct markov *m)
{
    m->plarge = plarge_zsolnai2013(&m->start.statistics);
    for (int i = 0; i < m->group_count; i++)
        m->groups[i].plarge = m->plarge;
    return !m->plarge.unsure;
}

/* p_l of the whole, if each length has its own: the mean over mutations. */
static void average_lengths(struct markov *m, bool unsure)
{
    double sum = 0.0, lo = 0.0, hi = 0.0, variance = 0.0, spread = 0.0;
    for (int i = 0; i < m->group_count; i++) {
        const struct plarge *p = &m->groups[i].plarge;
        double share = (double)m->groups[i].chain_count / m->chain_count;
        double square = share * p->p_l_se * share * p->p_l_se;
        variance += square;
        spread += square * square / p->p_l_freedom;
        sum += share * p->p_l;
        lo += share * p->p_l_lo;
        hi += share * p->p_l_hi;
    }
    m->plarge = (struct plarge){.p_l = sum,
                                .p_l_lo = lo,
                                .p_l_hi = hi,
                                .p_l_se = sqrt(variance),
                                .p_l_freedom = spread > 0.0 ? variance / spread * variance
                                                            : 1.0,
                                .unsure = unsure};
}

/* Sets p_l for each length from its own statistics. A length whose branch is unsure asks
 * for a longer start if it carries enough of the light. */
static bool decide_per_length(struct markov *m)
{
    bool sure = true;
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        struct statistics s;
        struct statistics_part part = group_part(m, group, m->start.tallies);
        statistics_measure(&part, 1, &s);
        group->plarge = plarge_zsolnai2013(&s);
        sure = sure && !(group->plarge.unsure && group_matters(m, group));
    }
    average_lengths(m, !sure);
    snprintf(m->plarge.reason, sizeof m->plarge.reason,
             "each path length by its own statistics; this is the mean over mutations");
    return sure;
}

static bool decide_published(struct markov *m)
{
    return m->settings->per == PER_LENGTH ? decide_per_length(m) : decide_for_all(m);
}

/* Mutations of a chain in the whole run. Under a time budget by the pace of the last
 * round: the time that is used up holds the independent paths before the chains too. */
static double planned_mutations(const struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    double share = m->direct ? 1.0 - m->passes_share : 1.0, done = (double)m->done;
    if (s->seconds <= 0.0)
        return fmax(share * m->budget / m->chain_count, done);
    double left = fmax(share * (s->seconds - seconds), 0.0);
    return done + (m->rounds.pace > 0.0 ? left / m->rounds.pace : 0.0);
}

/* Work of plain samples for each mutation: an event for each vertex and for each
 * connection. */
static double plain_work(const struct markov *m)
{
    int depth = m->split ? m->design.depth : m->design.plain_lengths;
    double events = 2.0 + 2.0 * depth;
    return m->direct ? m->passes_share / (1.0 - m->passes_share) * WORK_EVENT * events
                     : 0.0;
}

/* Puts before the reason that the published rule gives why it decided. */
static void explain_fallback(struct markov *m, const char *doubt)
{
    char reason[sizeof m->plarge.reason];
    snprintf(reason, sizeof reason, "%s", m->plarge.reason);
    snprintf(m->plarge.reason, sizeof m->plarge.reason,
             "not by predicted errors, as %s, but by zsolnai2013: %.200s", doubt, reason);
}

/* The rule `tours`, where it can be trusted; else the published rule decides. */
static bool decide_by_tours(struct markov *m, double seconds)
{
    struct tours_choice *choice = &m->start.tours;
    bool published = decide_published(m);
    bool longer = markov_tours_choose(m, planned_mutations(m, seconds), plain_work(m),
                                      m->start.p_zsolnai, choice);
    const char *doubt = tours_doubt(choice);
    if (m->settings->per == PER_LENGTH) {
        average_lengths(m, longer);
        snprintf(m->plarge.reason, sizeof m->plarge.reason,
                 "each path length by its own curve of predicted error; this is the mean "
                 "over mutations; one p_l for all would be %.3f%s",
                 choice->found ? choice->plarge.p_l : m->start.p_zsolnai,
                 longer ? "; unsure lengths by the common curve or by zsolnai2013" : "");
    } else if (*doubt) {
        explain_fallback(m, doubt);
    } else {
        m->plarge = choice->plarge;
    }
    return markov_tours_full(m) ? !*doubt || published : !longer;
}

/* Returns whether the rule is content with the start. */
static bool apply_rule(struct markov *m, double seconds)
{
    bool tours = text_equal(settings_rule(m->settings), "tours");
    m->start.p_zsolnai = plarge_zsolnai2013(&m->start.statistics).p_l;
    if (m->tours && m->done >= MARKOV_TOURS_LEAST)
        return decide_by_tours(m, seconds);
    bool sure = decide_published(m);
    if (tours)
        explain_fallback(m, m->tours ? "the start is too short" : markov_tours_bar(m));
    return sure && !m->tours;
}

void markov_start_adapt(struct markov *m)
{
    struct tally all = {0};
    if (!m->design.adapt)
        return;
    for (int i = 0; i < m->chain_count; i++)
        tally_add(&all, &m->start.tallies[i]);
    m->design.adapt(&m->design, m->settings, &all);
}

/* From here on a part of the run goes on alone. */
static void finish(struct markov *m)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        double variance, b = group_brightness(m, group, &variance);
        group->fixed_b = b > 0.0 ? b : group->fixed_b;
    }
    markov_predict_paths(m);
    markov_start_adapt(m);
    m->phase = PHASE_MAIN;
    markov_part_begin(m);
}

static void decide(struct markov *m, double seconds)
{
    for (int i = 0; i < m->chain_count; i++)
        m->start.tallies[i] = m->chains[i].tally;
    markov_measure(m, m->start.tallies, &m->start.statistics);
    m->start.looks++;
    if (!settings_auto(m->settings)) {
        markov_manual_plarge(m);
        finish(m);
        return;
    }
    if (!apply_rule(m, seconds) && extend_start(m, seconds))
        return;
    markov_tours_destroy(m);
    for (int i = 0; i < m->group_count; i++)
        m->groups[i].params.p_large = m->groups[i].plarge.p_l;
    finish(m);
}

void markov_start_round(struct markov *m, const struct round_limits *limits)
{
    double begin = clock_wall();
    if (m->done == 0)
        plan_seconds(m, limits->seconds_used);
    markov_run_round(m, m->settings->seconds > 0.0 ? 0 : m->start.until, limits);
    double seconds = limits->seconds_used + clock_wall() - begin;
    if (start_complete(m, seconds))
        decide(m, seconds);
    m->start.seconds += clock_wall() - begin;
}
