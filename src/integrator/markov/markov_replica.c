/* Replicas: the chains of each length are divided into independent parts with a picture
 * each, from which the error is estimated (convergence/verdict.h).
 *
 * A part takes consecutive chains of each length, so that the seeds of different parts
 * come from different ranges of the bootstrap. With n chains of a length in part r, D
 * mutations each, N pixels, the part's picture is
 *
 *     N / D sum over lengths of (b film + b0 large) / n,
 *
 * with b the fixed_b of the length; the deviations are scaled to the b of the whole run,
 * and those of b itself between parts added, at the end (markov_errors.c).
 *
 * A length with m chains, fewer than the R parts, adds the contrasts sqrt(R (R-1) / (m
 * (m-1))) (x_j - mean) of its chains to m of the parts; the others stay at the mean. The
 * sum of their squares over R is the estimate of the variance of the mean of m
 * chains. */

#include "integrator/markov/markov_replica.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_state.h"

/* Mutations a pixel in the first spans of time if the length of the run is not known;
 * reading the replicas takes as long as a few mutations for every hundred pixels. If it
 * is known, the first spans are short enough to be joined twice: second proposals and
 * plain samples take up to half of the paths, and a span ends with a round. */
#define SPAN_PIXELS 2.0

int markov_replica_of(const struct markov *m, const struct group *group, int chain)
{
    long count = m->replicas.films->count;
    if (group->chain_count < count)
        return chain % (int)count; /* by the number of the chain in the run, so that the
                                      parts differ between lengths */
    return (int)((chain - group->first_chain) * count / group->chain_count);
}

/* Index of the first pixel of a chain's replica. */
static int64_t first_of(const struct markov *m, const struct group *group, int chain)
{
    return markov_replica_of(m, group, chain) * (int64_t)markov_pixels(m);
}

double markov_replica_deviation_scale(double replicas, double chains)
{
    /* Contrasts of m chains in R replicas, see above. */
    return sqrt(replicas * (replicas - 1.0) / (chains * (chains - 1.0)));
}

static void share_chain(struct markov_replicas *r, const struct markov *m,
                        const struct group *group, int chain)
{
    struct replica_share *shares = r->shares + (size_t)chain * (size_t)r->films->count;
    int first = group->first_chain, count = group->chain_count, own = 0;
    if (count >= r->films->count) {
        for (int i = first; i < first + count; i++)
            own += markov_replica_of(m, group, i) == markov_replica_of(m, group, chain);
        shares[0] = (struct replica_share){first_of(m, group, chain), 1.0 / own, 0.0};
        r->share_counts[chain] = 1;
        return;
    }
    double s = count > 1 ? markov_replica_deviation_scale(r->films->count, count) : 0.0;
    for (int i = 0; count > 1 && i < count; i++) {
        int other = first + (chain - first + i) % count;
        shares[i] = (struct replica_share){first_of(m, group, other),
                                           s * ((i == 0) - 1.0 / count), 0.0};
    }
    r->share_counts[chain] = count > 1 ? count : 0;
}

int markov_replicas_count(const struct markov *m)
{
    const struct camera *camera = &m->scene->camera;
    int count = replicas_that_fit(camera->width, camera->height,
                                  (int)m->settings->replicas);
    return count < VERDICT_REPLICAS_LEAST || m->design.step->excludes ? 0 : count;
}

void markov_replicas_create(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    const struct camera *camera = &m->scene->camera;
    double span = SPAN_PIXELS * markov_pixels(m) / m->chain_count;
    int count = markov_replicas_count(m);
    if (count == 0)
        return;
    r->films = replicas_create(camera->width, camera->height, count, m->threads, true);
    if (m->budget > 0.0 && !settings_until(m->settings))
        span = m->budget / m->chain_count / (4.0 * TIME_SPANS_MOST - 2.0);
    time_spans_init(&r->spans, r->films, span);
}

static void share_arrays(const struct markov *m, int count, struct markov_replicas *r,
                         struct mem_plan *plan)
{
    size_t chains = (size_t)m->chain_count, shares = chains * (size_t)count;
    r->shares = mem_take(plan, 0, shares, sizeof *r->shares);
    r->weighted_shares = mem_take(plan, 0, shares, sizeof *r->weighted_shares);
    r->share_counts = mem_take(plan, 0, chains, sizeof *r->share_counts);
}

void markov_replicas_assign(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    if (!r->films)
        return;
    int count = r->films->count;
    share_arrays(m, count, r, &(struct mem_plan){.take = true});
    for (int i = 0; i < m->chain_count; i++)
        share_chain(r, m, &m->groups[m->group_of[i]], i);
    for (int g = 0; g < m->group_count; g++)
        r->whole |= m->groups[g].chain_count >= count;
}

void markov_replicas_destroy(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    mem_free(r->shares);
    mem_free(r->weighted_shares);
    mem_free(r->share_counts);
    time_spans_deinit(&r->spans);
    replicas_destroy(r->films);
}

/* Before a round: converts the shares to units of b0, with the fixed b of each length. */
void markov_replicas_set_weights(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    for (int g = 0; r->films && g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double b = group->fixed_b / m->b0;
        double b0 = group->bootstrap.b / m->b0;
        for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++)
            for (int j = 0; j < r->share_counts[i]; j++) {
                size_t at = (size_t)i * (size_t)r->films->count + (size_t)j;
                const struct replica_share *share = &r->shares[at];
                r->weighted_shares[at] = (struct replica_share){
                    share->first, share->states * b, share->states * b0};
            }
    }
}

void markov_replicas_round(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    if (r->films)
        time_spans_take(&r->spans, r->films, (double)m->done, r->whole, m->threads);
}

void markov_replicas_memory(const struct markov *m, struct run_memory *out)
{
    const struct camera *camera = &m->scene->camera;
    int count = markov_replicas_count(m);
    if (count == 0)
        return;
    out->films += replicas_bytes(camera->width, camera->height, count, m->threads, true);
    struct mem_plan plan = {.take = false};
    share_arrays(m, count, &(struct markov_replicas){.films = NULL}, &plan);
    out->states += time_spans_bytes(camera->width, camera->height, count) + plan.bytes;
}
