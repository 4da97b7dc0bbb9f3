/* The evidence of a run of chains for its verdict (convergence/verdict.h). */

#include "integrator/markov/markov_evidence.h"

#include "integrator/markov/markov_errors.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_missed.h"
#include "integrator/markov/markov_state.h"

/* Shares of the light on lengths with few chains, on chains that never moved and on
 * chains that were stuck. */
static void find_stuck(const struct markov *m, struct evidence *out)
{
    double total = 0.0, thin = 0.0, b[DIMS_MAX_DEPTH] = {0.0}, variances = 0.0;
    for (int g = 0; g < m->group_count; g++) {
        double variance;
        b[g] = group_brightness(m, &m->groups[g], &variance);
        total += b[g];
        variances += variance;
    }
    if (m->direct) {
        struct run_statistics plain;
        passes_statistics(m->direct, &plain);
        if (m->design.passes.estimate) /* b is that of the whole light */
            total = variances = 0.0;
        total += plain.b / m->scene->emission_scale;
        variances += pow(plain.b_se / m->scene->emission_scale, 2.0);
    }
    out->b_error = total > 0.0 ? sqrt(variances) / total : 0.0;
    for (int g = 0; g < m->group_count && total > 0.0; g++) {
        const struct group *group = &m->groups[g];
        double share = b[g] / total;
        if (group->chain_count < out->fewest_replicas && share > VERDICT_SHARE)
            out->fewest_replicas = group->chain_count;
        if (group->chain_count < VERDICT_REPLICAS_LEAST) {
            out->few_chains_share += share;
            if (share > thin)
                out->few_chains_length = group->length;
            thin = fmax(thin, share);
        }
        for (int i = 0; i < group->chain_count; i++) {
            const struct chain *chain = &m->chains[group->first_chain + i];
            double stay = (double)chain->most_rejections_in_row / (double)m->done;
            double carries = share / group->chain_count;
            out->never_moved_share += tally_moves(&chain->tally) > 0 ? 0.0 : carries;
            if (stay * carries > out->stuck_share) {
                out->stuck_share = stay * carries;
                out->stuck_fraction = stay;
            }
        }
    }
}

/* For runs whose light is all from plain samples: there is no chain to judge. */
static void find_plain(const struct markov *m, struct evidence *out)
{
    passes_evidence(m->direct, out);
    if (!out->missing && !out->no_light)
        out->plain_only_length = m->design.plain_lengths;
}

void markov_evidence(void *self, struct evidence *out)
{
    struct markov *m = self;
    const struct markov_replicas *r = &m->replicas;
    if (m->no_light && m->direct && !m->design.step->excludes) {
        find_plain(m, out);
        return;
    }
    *out = (struct evidence){.energy_top = (double)NAN};
    out->no_light = m->no_light;
    out->not_started = !m->no_light && m->done == 0;
    if (m->design.step->excludes)
        out->missing = "the method is biased";
    else if (m->settings->replicas < VERDICT_REPLICAS_LEAST)
        out->missing = "replicas=1";
    else if (!out->no_light && !out->not_started && !r->films)
        out->missing = "the replicas of so large a film take too much memory";
    if (out->missing || out->no_light || out->not_started)
        return;
    out->replicas = r->films->count;
    out->replicas_wanted = (int)m->settings->replicas;
    out->spans = &r->spans;
    markov_errors_find(m, out);
    out->energy_top = replicas_top(r->films, 1e-3);
    out->replicas_with_pass = m->direct
                                  ? passes_replicas_with_pass(m->direct, out->replicas)
                                  : out->replicas;
    out->fewest_replicas = out->replicas_with_pass;
    find_stuck(m, out);
    markov_missed_find(m, out);
}
