/* The start sets p_l and the bootstrap sets the numbers of chains; this file propagates
 * the errors of both into the acceptance and failure rates of the run. With rates a_L of
 * large and a_S of small steps, the rate of the main pass is p_l a_L + (1 - p_l) a_S, so
 * its derivative by p_l is (a_L - a_S) times the main pass's share of the run.
 *
 * Where p_l is the formula 1 / (2 (1 - q)), the derivative by q is that times dp_l/dq = 1
 * / (2 (1 - q)^2), and the independent units of q are also those of the acceptance
 * (chain/startup.c). In all other cases the variance of p_l is added. If the branch of
 * the rule is unsure, p_l jumps between .25 and the formula from seed to seed; its
 * variance is at most the square of half the interval's length [Popoviciu35]. That bound
 * is reached if both branches are equally likely and is too large if one is rare.
 *
 * With groups of chains, both rates are means over the groups weighted by their numbers
 * of chains, which the bootstrap set: a = sum s_k a_k / sum s_k. Let s_k(j) be the shares
 * without part j of J, and a(j) the mean with these shares; then the jackknife's variance
 * (J - 1) / J sum (a(j) - mean)^2 is added, with J - 1 degrees of freedom [Efron82]. */

#include "integrator/markov/markov_mixing.h"

#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_state.h"

/* Acceptance and failure rate of one kind of first proposals. */
struct rates {
    double accepted, failed;
};

/* second: acceptance of second proposals, after a failed step of either kind. */
static struct rates rates_of(double proposed, double accepted, double nonzero,
                             double second)
{
    double failed = 1.0 - nonzero / proposed;
    return (struct rates){accepted / proposed + failed * second, failed};
}

/* Derivatives of acceptance and failure rate by p_l; start: tallies of the same chains at
 * the end of the start. */
static void by_p_large(const struct tally *all, const struct tally *start, int chains,
                       double slope[2])
{
    double seconds = (double)all->proposed[MOVE_SECOND_STAGE], before = 0.0;
    double second = seconds > 0.0 ? (double)all->accepted[MOVE_SECOND_STAGE] / seconds
                                  : 0.0;
    double large = (double)all->proposed[MOVE_LARGE];
    double local = (double)tally_local(all->proposed);
    slope[0] = slope[1] = 0.0;
    if (!(large > 0.0 && local > 0.0))
        return;
    struct rates l = rates_of(large, (double)all->accepted[MOVE_LARGE],
                              (double)all->nonzero[MOVE_LARGE], second);
    struct rates s = rates_of(local, (double)tally_local(all->accepted),
                              (double)tally_local(all->nonzero), second);
    for (int i = 0; i < chains; i++)
        before += (double)tally_first(start[i].proposed);
    double share = 1.0 - before / (large + local);
    slope[0] = share * (l.accepted - s.accepted);
    slope[1] = share * (l.failed - s.failed);
}

struct sum {
    struct statistics_mixing *mixing;
    double variance, spread; /* variance of p_l, weighted; sum of variance^2 / freedom */
};

/* share: of the chains that use this p_l. */
static void add_variance(struct sum *sum, const struct plarge *plarge,
                         const double slope[2], double share)
{
    double v = share * share * plarge->p_l_se * plarge->p_l_se;
    for (int i = 0; i < 2; i++)
        sum->mixing->variance[i] += slope[i] * slope[i] * v;
    sum->variance += v;
    sum->spread += v * v / fmax(plarge->p_l_freedom, 1.0);
}

static void add_lengths(const struct markov *m, const struct tally *start,
                        struct sum *sum)
{
    double slope[2];
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        struct tally own = group_tally(m, group);
        by_p_large(&own, start + group->first_chain, group->chain_count, slope);
        add_variance(sum, &group->plarge, slope,
                     (double)group->chain_count / m->chain_count);
    }
}

struct statistics_mixing markov_mixing(const struct markov *m, const struct tally *all,
                                       const struct tally *start)
{
    struct statistics_mixing mixing = {.freedom = 1.0};
    struct sum sum = {&mixing, 0.0, 0.0};
    double slope[2], q = m->start.statistics.q;
    if (!settings_auto(m->settings) || m->phase != PHASE_MAIN || m->no_light)
        return mixing;
    by_p_large(all, start, m->chain_count, slope);
    if (m->settings->per == PER_LENGTH)
        add_lengths(m, start, &sum);
    else if (m->plarge.branch == PLARGE_FLAT && !m->plarge.unsure)
        for (int i = 0; i < 2; i++)
            mixing.slope[i] = slope[i] * 0.5 / ((1.0 - q) * (1.0 - q));
    else
        add_variance(&sum, &m->plarge, slope, 1.0);
    if (sum.spread > 0.0)
        mixing.freedom = sum.variance / sum.spread * sum.variance;
    return mixing;
}

/* The start's q without part j of the bootstrap; the weights b_k of the lengths come from
 * the bootstrap and the start's large steps together. */
static double q_without(const struct markov *m, int j)
{
    double large = 0.0, small = 0.0;
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        struct tally t = {0};
        for (int i = 0; i < group->chain_count; i++)
            tally_add(&t, &m->start.tallies[group->first_chain + i]);
        double n = (double)t.proposed[MOVE_LARGE], k = (double)tally_small(t.proposed);
        double paths = group->independent.count * (JACKKNIFE - 1.0) / JACKKNIFE;
        if (!(n > 0.0 && k > 0.0))
            continue;
        double b = (paths * m->jackknife.means[j][g] + t.large_sum) / (paths + n);
        large += b * t.acceptance[MOVE_LARGE] / n;
        small += b * tally_small_acceptance(&t) / k;
    }
    return small > 0.0 ? large / small : 0.0;
}

/* Jackknife variance of the mean over groups of rate[group_count], and of the effect of
 * q. */
static double jackknife_variance(const struct markov *m, const double *rate, double slope)
{
    struct welford means = {0};
    for (int j = 0; j < JACKKNIFE; j++) {
        double sum = 0.0, shares = 0.0;
        for (int g = 0; g < m->group_count; g++) {
            sum += m->jackknife.shares[j][g] * rate[g];
            shares += m->jackknife.shares[j][g];
        }
        double q = slope == 0.0 ? 0.0 : q_without(m, j);
        welford_add(&means, (shares > 0.0 ? sum / shares : 0.0) + slope * q);
    }
    return (JACKKNIFE - 1.0) / JACKKNIFE * means.m2;
}

void markov_add_allocation(const struct markov *m, const struct tally *tallies,
                           struct statistics_mixing *mixing)
{
    double accepted[DIMS_MAX_DEPTH] = {0.0}, failed[DIMS_MAX_DEPTH] = {0.0};
    if (m->group_count < 2)
        return;
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double n = 0.0;
        for (int i = group->first_chain; i < group->first_chain + group->chain_count;
             i++) {
            const struct tally *t = &tallies[i];
            double all = (double)tally_first(t->proposed);
            n += all;
            accepted[g] += (double)tally_moves(t);
            failed[g] += all - (double)tally_first(t->nonzero);
        }
        accepted[g] = n > 0.0 ? accepted[g] / n : 0.0;
        failed[g] = n > 0.0 ? failed[g] / n : 0.0;
    }
    double v = mixing->variance[0],
           own = jackknife_variance(m, accepted, mixing->slope[0]);
    double spread = v * v / mixing->freedom + own * own / (JACKKNIFE - 1.0);
    mixing->variance[0] += own;
    mixing->variance[1] += jackknife_variance(m, failed, mixing->slope[1]);
    if (spread > 0.0)
        mixing->freedom = (v + own) / spread * (v + own);
}

void markov_measure(const struct markov *m, const struct tally *tallies,
                    struct statistics *out)
{
    struct statistics_part parts[DIMS_MAX_DEPTH];
    struct statistics_mixing mixing = {.freedom = 1.0};
    for (int i = 0; i < m->group_count; i++)
        parts[i] = group_part(m, &m->groups[i], tallies);
    markov_add_allocation(m, tallies, &mixing);
    statistics_measure_after(parts, parts, m->group_count, &mixing, out);
}
