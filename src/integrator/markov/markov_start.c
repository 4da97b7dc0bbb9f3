/* The measured start: its length, its end, and p_l by the rule. */

#include "integrator/markov/markov_start.h"

#include "base/clock.h"
#include "base/mem.h"
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
    if (s->seconds > 0.0) {
        m->start.until_s = s->start * s->seconds;
        return;
    }
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
    return seconds >= s->start_cap * s->seconds ||
           (m->done >= m->start.until && seconds >= m->start.until_s);
}

/* Doubles the start while the branch of the rule is unsure; false at the cap. */
static bool extend_start(struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    if (m->start.looks >= START_LOOKS)
        return false;
    if (s->seconds > 0.0) {
        double cap = s->start_cap * s->seconds;
        m->start.until_s = fmin(2.0 * seconds, cap);
        m->start.until = 2 * m->done;
        return seconds < cap;
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

/* Sets p_l for each length from its own statistics; the p_l of the whole is the mean over
 * mutations. A length whose branch is unsure asks for a longer start if it carries enough
 * of the light. */
static bool decide_per_length(struct markov *m)
{
    bool sure = true;
    double sum = 0.0, lo = 0.0, hi = 0.0, variance = 0.0, spread = 0.0;
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        struct statistics s;
        struct statistics_part part = group_part(m, group, m->start.tallies);
        statistics_measure(&part, 1, &s);
        group->plarge = plarge_zsolnai2013(&s);
        double se = group->plarge.p_l_se * group->chain_count / m->chain_count;
        variance += se * se;
        spread += se * se * se * se / group->plarge.p_l_freedom;
        sum += group->plarge.p_l * group->chain_count;
        lo += group->plarge.p_l_lo * group->chain_count;
        hi += group->plarge.p_l_hi * group->chain_count;
        sure = sure && !(group->plarge.unsure && group->bootstrap.b > 0.01 * m->b0);
    }
    m->plarge = (struct plarge){.p_l = sum / m->chain_count,
                                .p_l_lo = lo / m->chain_count,
                                .p_l_hi = hi / m->chain_count,
                                .p_l_se = sqrt(variance),
                                .p_l_freedom = spread > 0.0 ? variance / spread * variance
                                                            : 1.0,
                                .unsure = !sure};
    snprintf(m->plarge.reason, sizeof m->plarge.reason,
             "each path length by its own statistics; this is the mean over mutations");
    return sure;
}

/* The rule `tours`. If there are too few tours for it, the published rule decides. */
static bool decide_by_tours(struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    struct tours_choice *choice = &m->start.tours;
    double share = m->direct ? 1.0 - m->passes_share : 1.0;
    double planned = s->seconds > 0.0
                         ? (double)m->done * s->seconds / fmin(seconds, s->seconds)
                         : share * m->budget / m->chain_count;
    /* A plain sample has an event for each vertex and for each connection. */
    int depth = m->split ? m->design.depth : m->design.plain_lengths;
    double fixed = m->direct ? m->passes_share / share * (2.0 + 2.0 * depth) : 0.0;
    markov_tours_choose(m, fmax(planned, (double)m->done), fixed, m->start.p_zsolnai,
                        choice);
    m->plarge = choice->plarge;
    if (choice->found)
        return !m->plarge.unsure || markov_tours_full(m);
    bool sure = decide_for_all(m);
    char reason[sizeof m->plarge.reason];
    snprintf(reason, sizeof reason, "%s", m->plarge.reason);
    snprintf(m->plarge.reason, sizeof m->plarge.reason,
             "too few tours to predict errors, so by zsolnai2013: %.250s", reason);
    return sure;
}

static bool apply_rule(struct markov *m, double seconds)
{
    m->start.p_zsolnai = plarge_zsolnai2013(&m->start.statistics).p_l;
    if (m->tours)
        return decide_by_tours(m, seconds);
    return m->settings->per == PER_LENGTH ? decide_per_length(m) : decide_for_all(m);
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
    markov_run_round(m, m->settings->seconds > 0.0 ? 0 : m->start.until, limits);
    double seconds = limits->seconds_used + clock_wall() - begin;
    if (start_complete(m, seconds))
        decide(m, seconds);
    m->start.seconds += clock_wall() - begin;
}
