/* What the chains of a path length know together: tallies, states, brightness; and of
 * all lengths, statistics. */

#include "integrator/markov_state.h"

double markov_pixels(const struct markov *m)
{
    return (double)m->scene->camera.width * (double)m->scene->camera.height;
}

void markov_fold(struct markov *m)
{
    for (int i = 0; i < m->film_count; i++)
        film_fold(m->films[i], m->threads);
}

static struct tally sum_tallies(const struct markov *m, int first, int count)
{
    struct tally sum = {0};
    for (int i = first; i < first + count; i++)
        tally_add(&sum, &m->chains[i].tally);
    return sum;
}

struct tally group_tally(const struct markov *m, const struct group *group)
{
    return sum_tallies(m, group->first_chain, group->chain_count);
}

struct tally markov_tally(const struct markov *m)
{
    return sum_tallies(m, 0, m->chain_count);
}

double markov_states(const struct markov *m, const struct group *group)
{
    struct tally all = group_tally(m, group);
    return (double)(tally_first(all.proposed) - all.excluded - all.zero_states);
}

/* Bootstrap and large steps are two means, and their weights must not know the first: a
 * length gets more chains, and so more large steps, the more its bootstrap found.
 * Weighted by how many there are, a poor bootstrap would count for more than a rich one,
 * and b come out too dark. The weights are those of an even share of all chains. */
double group_bootstrap_weight(const struct markov *m, const struct group *group)
{
    double large = (double)group_tally(m, group).proposed[MOVE_LARGE];
    double even = large * m->chain_count / ((double)m->group_count * group->chain_count);
    double count = group->independent.count;
    return large > 0.0 ? count / (count + even) : 1.0;
}

double group_spread(const struct markov *m, const struct group *group)
{
    struct tally all = group_tally(m, group);
    const struct welford *boot = &group->independent;
    double n = boot->count + (double)all.proposed[MOVE_LARGE];
    double squares = boot->m2 + boot->mean * boot->mean * boot->count +
                     all.large_sum_squares;
    double pooled = n > 0.0 ? (boot->mean * boot->count + all.large_sum) / n : 0.0;
    return n > 1.0 ? fmax(squares - n * pooled * pooled, 0.0) / (n - 1.0) : 0.0;
}

double group_brightness(const struct markov *m, const struct group *group,
                        double *variance)
{
    struct tally all = group_tally(m, group);
    const struct welford *boot = &group->independent;
    double large = (double)all.proposed[MOVE_LARGE], spread = group_spread(m, group);
    *variance = 0.0;
    if (!(large > 0.0)) {
        *variance = boot->count > 0.0 ? spread / boot->count : 0.0;
        return boot->mean;
    }
    double w = group_bootstrap_weight(m, group);
    *variance = spread * (w * w / boot->count + (1.0 - w) * (1.0 - w) / large);
    return w * boot->mean + (1.0 - w) * all.large_sum / large;
}

void markov_measure(const struct markov *m, const struct tally *tallies,
                    struct statistics *out)
{
    struct statistics parts[DIMS_MAX_DEPTH];
    double weights[DIMS_MAX_DEPTH], variance;
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        statistics_measure(tallies + group->first_chain, group->chain_count, &parts[i]);
        weights[i] = group_brightness(m, group, &variance);
    }
    statistics_join(parts, weights, m->group_count, out);
}
