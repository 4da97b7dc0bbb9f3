/* Deviations of the replicas by pixel, from which error bars come. They include the error
 * of b, which is estimated from large steps and multiplies the film of a length. */

#include "integrator/markov/markov_errors.h"

#include "base/mem.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_replica.h"
#include "integrator/markov/markov_state.h"

struct errors {
    int replicas, slopes;
    double scale; /* converts sums of replicas to the units of the picture */
    const struct film *films[DIMS_MAX_DEPTH];
    double slope[DIMS_MAX_DEPTH];      /* d picture / d b = slope * film */
    double brightness[DIMS_MAX_DEPTH]; /* picture = sum of brightness * slope * film */
    double fixed[DIMS_MAX_DEPTH];      /* the same of the replicas' mean */
    double large;                      /* and both have large * films.large */
    double (*b)[REPLICAS_MOST];        /* [slopes]: deviations of b by replica */
    double b_variance[DIMS_MAX_DEPTH]; /* variance that the bootstrap contributes to b */
    const struct markov *m;
};

/* Adds the deviations of each replica's mean large step from the mean over replicas,
 * scaled as the splats are. */
static void b_deviations(const struct markov *m, const struct group *group, double weight,
                         double *out)
{
    const struct replicas *films = m->replicas.films;
    double sums[REPLICAS_MOST] = {0.0}, counts[REPLICAS_MOST] = {0.0}, mean = 0.0;
    int used = 0;
    for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++) {
        const struct tally *tally = &m->chains[i].tally;
        sums[markov_replica_of(m, group, i)] += tally->large_sum;
        counts[markov_replica_of(m, group, i)] += (double)tally->proposed[MOVE_LARGE];
    }
    for (int r = 0; r < films->count; r++)
        if (counts[r] > 0.0) {
            mean += sums[r] / counts[r];
            used++;
        }
    mean /= used > 0 ? used : 1;
    for (int r = 0; r < films->count; r++)
        if (counts[r] > 0.0 && used > 1)
            out[r] += weight * markov_replica_deviation_scale(films->count, used) *
                      (sums[r] / counts[r] - mean);
}

/* Ratio of the picture to the replicas' mean at a pixel, which weighs lengths by their
 * fixed b. Deviations of the chains' splats are in proportion to these weights. */
static double fixed_ratio(const struct errors *e, long pixel)
{
    const struct film *large = e->m->films.large;
    double both = large ? e->large * rgb_luminance(film_value(large, (int)pixel)) : 0.0;
    double picture = both, mean = both;
    for (int i = 0; i < e->slopes; i++) {
        double unit = e->slope[i] * rgb_luminance(film_value(e->films[i], (int)pixel));
        picture += e->brightness[i] * unit;
        mean += e->fixed[i] * unit;
    }
    return picture > 0.0 && mean > 0.0 ? picture / mean : 1.0;
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
    e->replicas = m->replicas.films->count;
    e->scale = scale * pixels * m->b0 / (double)m->done;
    e->large = scale * m->b0 * pixels / markov_large_count(m);
    e->b = mem_alloc((size_t)m->group_count, sizeof *e->b);
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        double states = markov_states(m, group);
        double weight = group_bootstrap_weight(m, group), variance;
        int at = slope_of(e, group->film);
        double own = states > 0.0 ? pixels / states : 0.0;
        e->slope[at] = scale * (group->shares ? markov_shared_factor(m) : own);
        e->brightness[at] += group_brightness(m, group, &variance);
        e->fixed[at] += group->fixed_light / (double)m->done;
        e->b_variance[at] += weight * weight * group_spread(m, group) /
                             fmax(group->independent.count, 1.0);
        b_deviations(m, group, 1.0 - weight, e->b[at]);
    }
    return e;
}

void markov_errors_destroy(struct errors *e)
{
    if (e)
        mem_free(e->b);
    mem_free(e);
}

static double deviations(const void *self, long pixel, double *out)
{
    const struct errors *e = self;
    double mean = 0.0, common = 0.0, ratio = fixed_ratio(e, pixel);
    for (int r = 0; r < e->replicas; r++) {
        out[r] = e->scale * replicas_value(e->m->replicas.films, r, pixel);
        mean += out[r] / e->replicas;
    }
    for (int r = 0; r < e->replicas; r++)
        out[r] = ratio * (out[r] - mean);
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

void markov_errors_find(struct markov *m, struct evidence *out)
{
    markov_errors_destroy(m->errors);
    m->errors = errors_create(m);
    out->deviations = deviations;
    out->self = m->errors;
}

double markov_errors_value(const struct errors *e, long pixel)
{
    double sum = 0.0;
    for (int i = 0; i < e->slopes; i++)
        sum += e->slope[i] * e->brightness[i] *
               rgb_luminance(film_value(e->films[i], (int)pixel));
    return sum;
}
