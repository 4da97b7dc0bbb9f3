/* Replicas: chains of each length in independent parts, small pictures of each part, and
 * what they say about the error (verdict.h).
 *
 * A length's chains are cut into runs of neighbours: their seeds then come from different
 * stretches of the bootstrap, so that parts do not even start alike. With n chains of a
 * length in part r, D mutations each, N pixels, the part's picture is
 *
 *     N / D sum over lengths of (b film + b0 large) / n,
 *
 * with the b known when the round began. How b itself differs from part to part is added
 * at the end, from the large steps: it multiplies the length's film.
 *
 * A length with fewer chains than there are parts, say m, puts each of them into a part
 * of its own and takes their mean off again, so that the parts without one stay at their
 * mean: deviations sqrt(R (R-1) / (m (m-1))) (x_j - mean), whose sum of squares over
 * R estimates the variance of the mean of m as well. */

#include "base/mem.h"
#include "integrator/markov_state.h"

/* Mutations a pixel in the first batches, if the end is not known: a look takes as long
 * as a few mutations for every hundred pixels. If it is, they are short enough to be
 * joined twice: of the paths, second proposals and plain samples take up to half, and a
 * batch ends with a round. */
#define BATCH_PIXELS 2.0

struct errors {
    long pixels;
    int replicas, slopes;
    double scale; /* of replicas, to the units of the picture */
    const struct film *films[DIMS_MAX_DEPTH];
    double slope[DIMS_MAX_DEPTH];      /* d picture / d b = slope * film */
    double brightness[DIMS_MAX_DEPTH]; /* picture = sum of brightness * slope * film */
    double (*b)[REPLICAS_MOST];        /* [slopes]: deviations of b by replica */
    double b_variance[DIMS_MAX_DEPTH]; /* of the bootstrap's part of b */
    const struct markov *m;
};

static int replica_of(const struct markov *m, const struct group *group, int chain)
{
    long count = m->replicas.films->count;
    if (group->chain_count < count)
        return chain % (int)count; /* by number in the run: other parts for others */
    return (int)((chain - group->first_chain) * count / group->chain_count);
}

/* Where its replica's pixels begin. */
static int64_t first_of(const struct markov *m, const struct group *group, int chain)
{
    return replica_of(m, group, chain) * (int64_t)markov_pixels(m);
}

/* What makes the deviations of so few chains those of all replicas. */
static double stretch(double replicas, double chains)
{
    return sqrt(replicas * (replicas - 1.0) / (chains * (chains - 1.0)));
}

static void share_chain(struct markov_replicas *r, const struct markov *m,
                        const struct group *group, int chain)
{
    struct chain_share *shares = r->shares + (size_t)chain * (size_t)r->films->count;
    int first = group->first_chain, count = group->chain_count, own = 0;
    if (count >= r->films->count) {
        for (int i = first; i < first + count; i++)
            own += replica_of(m, group, i) == replica_of(m, group, chain);
        shares[0] = (struct chain_share){first_of(m, group, chain), 1.0 / own, 0.0};
        r->share_counts[chain] = 1;
        return;
    }
    double s = count > 1 ? stretch(r->films->count, count) : 0.0;
    for (int i = 0; count > 1 && i < count; i++) {
        int other = first + (chain - first + i) % count;
        shares[i] = (struct chain_share){first_of(m, group, other),
                                         s * ((i == 0) - 1.0 / count), 0.0};
    }
    r->share_counts[chain] = count > 1 ? count : 0;
}

void markov_replicas_create(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    const struct camera *camera = &m->scene->camera;
    double batch = BATCH_PIXELS * markov_pixels(m) / m->chain_count;
    int count = replicas_that_fit(camera->width, camera->height,
                                  (int)m->settings->replicas);
    if (count < VERDICT_REPLICAS_LEAST || m->design.step->excludes)
        return;
    r->films = replicas_create(camera->width, camera->height, count, m->threads, true);
    if (m->budget > 0.0)
        batch = m->budget / m->chain_count / (4.0 * BATCHES_MOST - 2.0);
    batches_init(&r->batches, r->films, batch);
    r->shares = mem_alloc((size_t)m->chain_count * (size_t)count, sizeof *r->shares);
    r->weighed = mem_alloc((size_t)m->chain_count * (size_t)count, sizeof *r->weighed);
    r->share_counts = mem_alloc((size_t)m->chain_count, sizeof *r->share_counts);
    for (int i = 0; i < m->chain_count; i++)
        share_chain(r, m, &m->groups[m->group_of[i]], i);
    for (int g = 0; g < m->group_count; g++)
        r->whole |= m->groups[g].chain_count >= count;
    markov_missed_create(m);
}

void markov_replicas_destroy(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    if (r->errors)
        mem_free(r->errors->b);
    mem_free(r->errors);
    mem_free(r->shares);
    mem_free(r->weighed);
    mem_free(r->share_counts);
    mem_free(r->large);
    mem_free(r->tile_of);
    batches_deinit(&r->batches);
    replicas_destroy(r->films);
}

/* Before a round: splats in units of b0, at the b of now. */
void markov_replicas_weigh(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    for (int g = 0; r->films && g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double variance, b = group_brightness(m, group, &variance) / m->b0;
        double b0 = group->bootstrap.b / m->b0;
        for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++)
            for (int j = 0; j < r->share_counts[i]; j++) {
                size_t at = (size_t)i * (size_t)r->films->count + (size_t)j;
                const struct chain_share *share = &r->shares[at];
                r->weighed[at] = (struct chain_share){share->first, share->chain * b,
                                                      share->chain * b0};
            }
    }
}

struct chain_aim markov_replicas_aim(const struct markov *m, int chain, int thread)
{
    const struct markov_replicas *r = &m->replicas;
    const struct group *group = &m->groups[m->group_of[chain]];
    if (!r->films)
        return (struct chain_aim){0};
    size_t at = (size_t)chain * (size_t)r->films->count;
    return (struct chain_aim){
        .lane = &r->films->lanes[thread],
        .shares = r->weighed + at,
        .count = r->share_counts[chain],
        .scale = REPLICAS_ONE * group->bootstrap.b * m->chain_count /
                 (m->b0 * group->chain_count),
        .large = r->large ? r->large + (size_t)chain * (size_t)r->missed.tiles : NULL,
        .tile_of = r->tile_of,
    };
}

void markov_replicas_round(struct markov *m)
{
    struct markov_replicas *r = &m->replicas;
    if (r->films)
        batches_take(&r->batches, r->films, (double)m->done, r->whole, m->threads);
}

void markov_replicas_memory(const struct markov *m, struct run_memory *out)
{
    const struct camera *camera = &m->scene->camera;
    int count = replicas_that_fit(camera->width, camera->height,
                                  (int)m->settings->replicas);
    if (count < VERDICT_REPLICAS_LEAST || m->design.step->excludes)
        return;
    out->films += replicas_bytes(camera->width, camera->height, count, m->threads, true);
    out->states += batches_bytes(camera->width, camera->height, count) +
                   (double)m->chain_count * count * 2 * sizeof(struct chain_share) +
                   markov_missed_bytes(m);
}

/* --- errors ----------------------------------------------------------------------- */

/* Means of large steps by replica, less their mean; stretched as the splats are. */
static void b_deviations(const struct markov *m, const struct group *group, double weight,
                         double *out)
{
    const struct replicas *films = m->replicas.films;
    double sums[REPLICAS_MOST] = {0.0}, counts[REPLICAS_MOST] = {0.0}, mean = 0.0;
    int used = 0;
    for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++) {
        const struct tally *tally = &m->chains[i].tally;
        sums[replica_of(m, group, i)] += tally->large_sum;
        counts[replica_of(m, group, i)] += (double)tally->proposed[MOVE_LARGE];
    }
    for (int r = 0; r < films->count; r++)
        if (counts[r] > 0.0) {
            mean += sums[r] / counts[r];
            used++;
        }
    mean /= used > 0 ? used : 1;
    for (int r = 0; r < films->count; r++)
        if (counts[r] > 0.0 && used > 1)
            out[r] += weight * stretch(films->count, used) * (sums[r] / counts[r] - mean);
}

/* Lengths that share a film have one slope. */
static int slope_of(struct errors *e, const struct film *film)
{
    int i = 0;
    while (i < e->slopes && e->films[i] != film)
        i++;
    e->films[i] = film;
    e->slopes += i == e->slopes;
    return i;
}

static struct errors *errors_create(const struct markov *m)
{
    struct errors *e = mem_alloc(1, sizeof *e);
    double pixels = markov_pixels(m), scale = m->scene->emission_scale;
    e->m = m;
    e->pixels = (long)pixels;
    e->replicas = m->replicas.films->count;
    e->scale = scale * pixels * m->b0 / (double)m->done;
    e->b = mem_alloc((size_t)m->group_count, sizeof *e->b);
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double states = markov_states(m, group);
        double weight = group_bootstrap_weight(m, group), variance;
        int at = slope_of(e, group->film);
        double own = states > 0.0 ? pixels / states : 0.0;
        e->slope[at] = scale * (group->shares ? markov_shared_factor(m) : own);
        e->brightness[at] += group_brightness(m, group, &variance);
        e->b_variance[at] += weight * weight * group_spread(m, group) /
                             fmax(group->independent.count, 1.0);
        b_deviations(m, group, 1.0 - weight, e->b[at]);
    }
    return e;
}

static double deviations(const void *self, long pixel, double *out)
{
    const struct errors *e = self;
    double mean = 0.0, common = 0.0;
    for (int r = 0; r < e->replicas; r++) {
        out[r] = e->scale * replicas_value(e->m->replicas.films, r, pixel);
        mean += out[r] / e->replicas;
    }
    for (int r = 0; r < e->replicas; r++)
        out[r] -= mean;
    for (int i = 0; i < e->slopes; i++) {
        double slope = e->slope[i] * rgb_luminance(film_value(e->films[i], (int)pixel));
        common += slope * slope * e->b_variance[i];
        for (int r = 0; r < e->replicas; r++)
            out[r] += slope * e->b[i][r];
    }
    if (e->m->direct)
        passes_add_deviations(e->m->direct, pixel, e->replicas, out);
    return common;
}

double markov_replicas_value(const struct markov *m, long pixel)
{
    const struct errors *e = m->replicas.errors;
    double sum = 0.0;
    for (int i = 0; i < e->slopes; i++)
        sum += e->slope[i] * e->brightness[i] *
               rgb_luminance(film_value(e->films[i], (int)pixel));
    return sum;
}

/* --- chains ----------------------------------------------------------------------- */

/* What hangs on few chains, or on chains that stand still. */
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
        total += plain.b / m->scene->emission_scale;
        variances += pow(plain.b_se / m->scene->emission_scale, 2.0);
    }
    out->b_error = total > 0.0 ? sqrt(variances) / total : 0.0;
    for (int g = 0; g < m->group_count && total > 0.0; g++) {
        const struct group *group = &m->groups[g];
        double share = b[g] / total;
        if (group->chain_count < out->fewest && share > VERDICT_SHARE)
            out->fewest = group->chain_count;
        if (group->chain_count < VERDICT_REPLICAS_LEAST) {
            out->thin_share += share;
            if (share > thin)
                out->thin_length = group->length;
            thin = fmax(thin, share);
        }
        for (int i = 0; i < group->chain_count; i++) {
            const struct chain *chain = &m->chains[group->first_chain + i];
            double stay = (double)chain->longest_stay / (double)m->done;
            double carries = share / group->chain_count;
            out->never_share += tally_moves(&chain->tally) > 0 ? 0.0 : carries;
            if (stay * carries > out->stay_share) {
                out->stay_share = stay * carries;
                out->longest_stay = stay;
            }
        }
    }
}

void markov_evidence(void *self, struct evidence *out)
{
    struct markov *m = self;
    struct markov_replicas *r = &m->replicas;
    *out = (struct evidence){.energy_top = (double)NAN};
    out->dark = m->dark;
    out->unbegun = !m->dark && m->done == 0;
    if (m->design.step->excludes)
        out->missing = "the method is biased";
    else if (m->settings->replicas < VERDICT_REPLICAS_LEAST)
        out->missing = "replicas=1";
    else if (!out->dark && !out->unbegun && !r->films)
        out->missing = "the replicas of so large a film take too much memory";
    if (out->missing || out->dark || out->unbegun)
        return;
    markov_fold(m);
    r->errors = errors_create(m);
    out->replicas = r->films->count;
    out->replicas_wanted = (int)m->settings->replicas;
    out->batches = &r->batches;
    out->deviations = deviations;
    out->self = r->errors;
    out->energy_top = replicas_top(r->films, 1e-3);
    out->units = m->direct ? passes_units(m->direct, out->replicas) : out->replicas;
    out->fewest = out->units;
    find_stuck(m, out);
    markov_missed_find(m, out);
}
