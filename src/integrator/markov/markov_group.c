/* Sums over the chains of a path length: tallies, states, brightness; and statistics of
 * all lengths. */

#include "integrator/markov/markov_group.h"

#include "integrator/markov/markov_state.h"
#include "math/student.h"

double markov_pixels(const struct markov *m)
{
    return (double)m->scene->camera.width * (double)m->scene->camera.height;
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

static double tally_states(const struct tally *t)
{
    return (double)(tally_first(t->proposed) - t->excluded - t->zero_states);
}

double markov_states(const struct markov *m, const struct group *group)
{
    struct tally all = group_tally(m, group);
    double states = tally_states(&all);
    for (int j = 0; m->missing && j < group->chain_count; j++) {
        int i = group->first_chain + j;
        if (m->missing[i] != m->start_missing)
            states += (m->missing[i] ? 1.0 : -1.0) * tally_states(&m->start.tallies[i]);
    }
    return states;
}

/* Factor by which the films of the part that made this chain were scaled. */
static double scale_of_part(const struct markov *m, int chain)
{
    double made = (double)tally_first(m->chains[chain].tally.proposed);
    return made > 0.0 ? (double)m->done / made : 0.0;
}

double markov_start_in_films(const struct markov *m)
{
    double start = (double)m->rounds.start_done;
    return m->start_missing ? 0.0 : m->missing ? scale_of_part(m, 0) * start : start;
}

double markov_main_in_films(const struct markov *m, int chain)
{
    double start = (double)m->rounds.start_done;
    if (!m->missing)
        return (double)m->done - start;
    return m->missing[chain] ? 0.0 : (double)m->done - scale_of_part(m, chain) * start;
}

double markov_large_count(const struct markov *m)
{
    double all = (double)m->done * m->chain_count, light = 0.0;
    for (int i = 0; m->missing && i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        double made = 0.0;
        for (int j = 0; j < group->chain_count; j++)
            made += markov_main_in_films(m, group->first_chain + j) +
                    markov_start_in_films(m);
        light += group->bootstrap.b / m->b0 * made / group->chain_count;
    }
    return m->missing && light > 0.0 ? light * m->chain_count : all;
}

/* b is a weighted mean of the bootstrap's mean and that of large steps. The weights must
 * not depend on the bootstrap's result: a length gets more chains, and so more large
 * steps, the more its bootstrap found, so weights by numbers of samples would give a
 * bootstrap that found too little more weight than one that found too much, and b would
 * be biased (too dark). The weights are therefore those for equal numbers of chains in
 * all lengths. */
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

void group_moments(const struct markov *m, const struct group *group, double *squares,
                   double *fourths)
{
    struct tally all = group_tally(m, group);
    const struct welford *boot = &group->independent;
    double large = (double)all.proposed[MOVE_LARGE], w = group_bootstrap_weight(m, group);
    double share[2] = {boot->count > 0.0 ? w / boot->count : 0.0,
                       large > 0.0 ? (1.0 - w) / large : 0.0};
    double sums[2] = {boot->m2 + boot->mean * boot->mean * boot->count,
                      all.large_sum_squares};
    double powers[2] = {group->independent_fourths, all.large_sum_fourths};
    for (int i = 0; i < 2; i++) {
        *squares += share[i] * share[i] * sums[i];
        *fourths += share[i] * share[i] * share[i] * share[i] * powers[i];
    }
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

/* The squares of n effective samples have a sum of relative variance 1/n: chi-squared
 * with 2n degrees of freedom [Satterthwaite46]. */
bool group_matters(const struct markov *m, const struct group *group)
{
    return group->bootstrap.b > 0.01 * m->b0;
}

struct statistics_part group_part(const struct markov *m, const struct group *group,
                                  const struct tally *tallies)
{
    struct statistics_part part = {
        .tallies = tallies + group->first_chain,
        .seeds = m->seeds + group->first_chain,
        .chains = group->chain_count,
    };
    double squares = 0.0, fourths = 0.0;
    group_moments(m, group, &squares, &fourths);
    part.b = group_brightness(m, group, &part.b_variance);
    part.b_freedom = fourths > 0.0 ? student_freedom(squares, fourths) : 1.0;
    return part;
}
