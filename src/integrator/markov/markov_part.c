#include "integrator/markov/markov_part.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_replica.h"

static void forget(struct markov *m)
{
    *m->scene->edges_cut = 0;
    for (int i = 0; i < m->films.count; i++)
        film_clear(m->films.all[i]);
    if (m->replicas.films) {
        replicas_clear(m->replicas.films);
        time_spans_clear(&m->replicas.spans);
    }
}

void markov_part_begin(struct markov *m)
{
    if (m->part.index > 0)
        forget(m);
    if (m->direct)
        passes_set_part(m->direct, m->part);
}

/* The films of single lengths are divided by their numbers of states and need no scale,
 * nor do maps of steps, which are relative. */
static bool is_of_one_length(const struct markov *m, const struct film *film)
{
    for (int i = 0; i < m->group_count; i++)
        if (m->groups[i].film == film)
            return !m->groups[i].shares;
    for (int i = 0; i < m->films.light.count; i++)
        if (film == m->films.class_states[i])
            return true;
    return film == m->films.steps || film == m->films.small_steps ||
           film == m->films.large_steps;
}

void markov_part_scale(struct markov *m, long done)
{
    double factor = m->done > 0 ? (double)done / (double)m->done : 1.0;
    if (done == m->done)
        return;
    for (int i = 0; i < m->films.count; i++)
        if (!is_of_one_length(m, m->films.all[i]))
            film_scale(m->films.all[i], factor);
    if (m->replicas.films) {
        replicas_scale(m->replicas.films, -1, factor);
        time_spans_scale(&m->replicas.spans, -1, factor);
    }
}

/* Share of a replica's light that its sums have. */
static double share_present(const struct markov *m, int replica)
{
    double all = 0.0, present = 0.0, start = markov_start_in_films(m);
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double chains = 0.0, here = 0.0;
        if (group->chain_count < m->replicas.films->count)
            continue; /* it gives contrasts only */
        for (int i = group->first_chain; i < group->first_chain + group->chain_count;
             i++) {
            if (markov_replica_of(m, group, i) != replica)
                continue;
            chains += 1.0;
            here += (markov_main_in_films(m, i) + start) / (double)m->done;
        }
        all += group->fixed_b;
        present += group->fixed_b * here / chains;
    }
    return all > 0.0 ? present / all : 1.0;
}

static void complete_replicas(struct markov *m)
{
    for (int r = 0; m->replicas.films && r < m->replicas.films->count; r++) {
        double share = share_present(m, r);
        if (!(share > 0.0))
            continue;
        replicas_scale(m->replicas.films, r, 1.0 / share);
        time_spans_scale(&m->replicas.spans, r, 1.0 / share);
    }
}

/* Whether all chains are at hand and made the same number of mutations. */
static bool is_even(const struct markov *m, const bool *present, int count)
{
    bool even = true;
    for (int i = 0; i < count; i++)
        even = even && present[i];
    for (int i = 0; i < m->chain_count; i++)
        even = even && tally_first(m->chains[i].tally.proposed) == m->done;
    return even;
}

void markov_complete(void *self, const bool *present, int count)
{
    struct markov *m = self;
    if (m->no_light || m->done == 0 || is_even(m, present, count))
        return;
    m->start_missing = !present[0];
    m->missing = mem_alloc((size_t)m->chain_count, sizeof *m->missing);
    for (int i = 0; i < m->chain_count; i++)
        for (int j = 0; j < count; j++)
            m->missing[i] |= !present[j] &&
                             part_owns_chain((struct run_part){j, count}, i);
    complete_replicas(m);
}
