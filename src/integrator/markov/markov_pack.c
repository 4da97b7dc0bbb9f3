/* The state of a run of chains, to and from a checkpoint. What follows from settings and
 * scene (streams of targets, kernels, rounds, scales) is left out, and so are the
 * bootstrap's paths, which are not needed after the start. Of a part of a run only its
 * own chains are in the file, once the start is over. */

#include "integrator/markov/markov_pack.h"

#include "integrator/markov/markov_allocate.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_missed.h"
#include "integrator/markov/markov_part.h"
#include "integrator/markov/markov_seed.h"
#include "integrator/markov/markov_split.h"
#include "integrator/markov/markov_start.h"
#include "integrator/markov/markov_state.h"
#include "integrator/markov/markov_tours.h"

#include <limits.h>

static void pack_done(struct markov *m, struct pack *pack)
{
    long done = m->done;
    pack_long(pack, "done", &done, 0, LONG_MAX);
    if (pack_adds(pack) && m->parts_read > 0 && pack_ok(pack))
        markov_part_scale(m, done);
    m->done = done;
}

static void pack_phase(struct markov *m, struct pack *pack)
{
    int phase = (int)m->phase;
    pack_int(pack, "phase", &phase, PHASE_BOOTSTRAP, PHASE_MAIN);
    m->phase = (enum phase)phase;
    pack_flag(pack, "dark", &m->no_light);
    pack_done(m, pack);
    pack_double(pack, "paths", &m->paths);
    pack_double(pack, "start_paths", &m->rounds.start_paths);
    pack_long(pack, "start_done", &m->rounds.start_done, 0, LONG_MAX);
    pack_double(pack, "paths_each", &m->rounds.paths_each);
    pack_double(pack, "seconds_startup", &m->start.seconds);
}

static void pack_start(struct markov *m, struct pack *pack)
{
    pack_long(pack, "start_until", &m->start.until, 0, LONG_MAX);
    pack_double(pack, "start_until_s", &m->start.until_s);
    pack_double(pack, "start_cap_s", &m->start.cap_s);
    pack_int(pack, "looks", &m->start.looks, 0, INT_MAX);
    statistics_pack(pack, &m->start.statistics);
    pack_double(pack, "p_zsolnai", &m->start.p_zsolnai);
    plarge_pack(pack, &m->plarge);
    for (int i = 0; i < m->chain_count; i++)
        tally_pack(pack, &m->start.tallies[i], m->design.state->moves);
    for (int j = 0; j < JACKKNIFE; j++)
        for (int i = 0; i < m->group_count; i++) {
            pack_double(pack, "share_without", &m->jackknife.shares[j][i]);
            pack_double(pack, "mean_without", &m->jackknife.means[j][i]);
        }
}

static void pack_group(struct group *group, struct pack *pack, int most)
{
    bootstrap_pack(pack, &group->bootstrap);
    pack_double(pack, "fixed_b", &group->fixed_b);
    pack_double(pack, "fixed_light", &group->fixed_light);
    welford_pack(pack, "independent", &group->independent, 1);
    pack_double(pack, "independent_fourths", &group->independent_fourths);
    pack_int(pack, "chains", &group->chain_count, 0, most);
    pack_double(pack, "p_large", &group->params.p_large);
    plarge_pack(pack, &group->plarge);
}

/* Parts whose starts differ cannot be added up. */
static void pack_groups(struct markov *m, struct pack *pack)
{
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i], before = *group;
        pack_group(group, pack, m->chain_count);
        if (m->parts_read > 0 && (before.bootstrap.b != group->bootstrap.b ||
                                  before.chain_count != group->chain_count ||
                                  before.params.p_large != group->params.p_large))
            pack_refuse(pack, "its measured start is not that of the other parts");
    }
}

static bool chains_add_up(const struct markov *m)
{
    long sum = 0;
    for (int i = 0; i < m->group_count; i++) {
        if (m->groups[i].chain_count < 1)
            return false;
        sum += m->groups[i].chain_count;
    }
    return sum == m->chain_count;
}

/* Recomputes what follows from the groups. */
static void rebuild(struct markov *m, struct pack *pack)
{
    if (!chains_add_up(m)) {
        pack_refuse(pack, "chains");
        return;
    }
    for (int i = 0; i < m->group_count; i++)
        m->b0 += m->groups[i].bootstrap.b;
    markov_number_chains(m);
    markov_missed_create(m);
    markov_create_outputs(m);
}

static void pack_chains(struct markov *m, struct pack *pack)
{
    long pixels = (long)markov_pixels(m);
    for (int i = 0; i < m->films.count && pack_ok(pack); i++)
        film_pack(pack, m->films.all[i]);
    pack_int64s(pack, "seeds", m->seeds, (size_t)m->chain_count);
    if (m->replicas.films) {
        replicas_pack(pack, m->replicas.films);
        time_spans_pack(pack, &m->replicas.spans);
    }
    markov_missed_pack(m, pack);
    markov_tours_pack(m, pack);
    for (int i = 0; i < m->chain_count && pack_ok(pack); i++)
        if (part_owns_chain(pack_part(pack), i))
            chain_pack(pack, &m->chains[i], pixels);
}

void markov_pack(void *self, struct pack *pack)
{
    struct markov *m = self;
    pack_phase(m, pack);
    markov_split_pack(m, pack);
    pack_start(m, pack);
    if (pack_reads(pack) && pack_ok(pack) && m->phase == PHASE_MAIN)
        markov_start_adapt(m);
    pack_groups(m, pack);
    bool chains = m->phase != PHASE_BOOTSTRAP && !m->no_light;
    if (chains && pack_reads(pack) && pack_ok(pack) && m->parts_read == 0)
        rebuild(m, pack);
    if (chains && pack_ok(pack))
        pack_chains(m, pack);
    if (m->direct && pack_ok(pack))
        passes_pack(m->direct, pack);
    m->parts_read += pack_adds(pack);
}
