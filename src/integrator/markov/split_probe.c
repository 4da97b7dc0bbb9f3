#include "integrator/markov/split_probe.h"

#include "base/mem.h"
#include "base/par.h"
#include "integrator/markov/markov_bootstrap.h"
#include "integrator/markov/markov_group.h"

#define PROBES       64                  /* chains, over all lengths */
#define PROBE_LEAST  4                   /* of a length */
#define PROBE_NUMBER ((uint64_t)1 << 32) /* number of the first, for its stream */

/* Splats of a record as shares of its relative brightness. */
static double overlap(const struct split *split, const struct tape_splat *a, int na,
                      double rho_a, const struct tape_splat *b, int nb, double rho_b)
{
    double sum = 0.0;
    for (int i = 0; i < na; i++)
        for (int j = 0; j < nb; j++)
            if (a[i].pixel == b[j].pixel) {
                double w = (double)split->inverse[a[i].pixel];
                sum += w * w * (double)a[i].luminance * (double)b[j].luminance;
            }
    return sum / (rho_a * rho_b);
}

static void read_tape(const struct split *split, const struct tape *tape,
                      struct split_probe *probe)
{
    const struct tape_splat *splats[PROBE_STEPS + 1], *next = tape->splats;
    const struct tape_record *states[PROBE_STEPS + 1];
    probe->states = 0;
    for (long i = 0; i < tape->count; next += tape->records[i++].splats) {
        int k = probe->states++;
        bool moved = i == 0 || tape->records[i].accepted;
        states[k] = moved ? &tape->records[i] : states[k - 1];
        splats[k] = moved ? next : splats[k - 1];
        probe->rho[k] = states[k]->target / split->unit;
        if (i > 0)
            probe->accepted += (double)tape->records[i].acceptance /
                               (double)(tape->count - 1);
    }
    for (int i = 0; i < probe->states; i++)
        for (int j = i; j < probe->states; j++)
            probe->same[i][j] = (float)overlap(split, splats[i], states[i]->splats,
                                               probe->rho[i], splats[j],
                                               states[j]->splats, probe->rho[j]);
    if (tape->mutations[0] > 0.0)
        probe->work = tape->work[0] / tape->mutations[0];
}

static void run_probe(void *ctx, long index, int thread)
{
    const struct split_probes *probes = ctx;
    const struct markov *m = probes->m;
    struct split_probe *probe = &probes->all[index];
    const struct target *target = &m->targets[probe->group * m->threads + thread];
    struct chain_params params = {.p_large = 0.0, .estimator = ESTIMATOR_PLAIN};
    struct chain chain;
    struct tape tape;
    struct chain_sinks sinks = {.tape = &tape};
    chain_init(&chain, m->design.state, &m->design.pss, m->design.max_splats);
    tape_init(&tape, PROBE_STEPS, m->design.max_splats);
    chain_seed(&chain, target, (uint64_t)m->settings->seed,
               markov_path_number(m, probe->group, (long)probe->seed),
               PROBE_NUMBER + (uint64_t)index);
    tape_begin(&tape, chain.current);
    m->design.step->advance(&chain, &params, target, &sinks, PROBE_STEPS);
    read_tape(&m->split->split, &tape, probe);
    tape_deinit(&tape);
    chain_deinit(&chain);
}

void split_probes_run(const struct markov *m, struct split_probes *probes)
{
    int most = PROBES + PROBE_LEAST * m->group_count;
    probes->m = m;
    probes->count = 0;
    probes->all = mem_alloc((size_t)most, sizeof *probes->all);
    for (int g = 0; g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        int count = PROBE_LEAST + (int)(PROBES * paths->b / m->b0);
        long *picked = mem_alloc((size_t)count, sizeof *picked);
        struct rng rng;
        if (paths->b > 0.0 && probes->count + count <= most) {
            rng_init(&rng, (uint64_t)m->settings->seed, RNG_SELECT,
                     PROBE_NUMBER + (uint64_t)g);
            bootstrap_select(paths, rng_double(&rng), picked, count);
            for (int i = 0; i < count; i++) {
                probes->all[probes->count].group = g;
                probes->all[probes->count++].seed = picked[i];
            }
        }
        mem_free(picked);
    }
    par_for(probes->count, m->threads, run_probe, probes);
}
