/* Allocates chains to path lengths. The picture is right for any numbers, as each length
 * is normalised by its own; the numbers decide where the error is.
 *
 * With N_k counted states of length k and n pixels, a pixel of brightness I_k receives
 * N_k I_k / (b_k n) states, each of which adds b_k n / N_k. If the states were
 * independent, the variance would be b_k n I_k / N_k, and the mean over pixels of
 * relative errors, variance / (I^2 + e^2), n S_k / N_k with S_k = b_k E[f_k / (I(pixel)^2
 * + e^2)], the mean over independent paths of that length. But a chain's states are
 * correlated, mostly in bright places. With N_k independent paths instead of a chain the
 * error would be n Q_k / N_k with Q_k = E[f_k^2 / (I(pixel)^2 + e^2)]. A chain lies
 * between these two; their geometric mean is used. The brightness b_k is estimated from
 * p_l N_k large steps with variance Var[f_k] / (p_l N_k); relative to b^2 this is given
 * the weight WHOLE. So the error is a sum of J_k / N_k, J_k = n sqrt(S_k Q_k) + WHOLE
 * Var[f_k] / (p_l b^2), which for a given sum of N_k is least if N_k is proportional to
 * sqrt(J_k) (Neyman allocation). Numbers proportional to b_k would instead spend most
 * chains on what is bright and simple: a lamp that is seen directly.
 *
 * J_k is estimated from the bootstrap, and figures that weight all chains alike
 * (acceptance, failure rate) depend on the resulting numbers of chains. Their error is
 * estimated by the jackknife [Efron82]: the shares are computed again with every
 * JACKKNIFE-th path left out, for each of the JACKKNIFE ways to do so (markov_mixing.c).
 */

#include "integrator/markov/markov_allocate.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_state.h"

#define TILES      16 /* tiles of the film each way, the pixels of a coarse picture */
#define TILE_COUNT (TILES * TILES)
#define DARK       0.5 /* e, in units of the mean brightness */
#define WHOLE      10.0
#define LARGE      0.5 /* p_l of the measured start; the final one is not known yet */

static int tile_of(const struct markov *m, int32_t pixel)
{
    int width = m->scene->camera.width, height = m->scene->camera.height;
    int64_t x = pixel % width, y = pixel / width;
    return (int)(y * TILES / height * TILES + x * TILES / width);
}

/* left_out: leaves out the paths whose number is left_out modulo JACKKNIFE; -1: none. */
static bool is_kept(long path, int left_out)
{
    return path % JACKKNIFE != left_out;
}

/* Brightness of each tile by the bootstrap paths of all lengths. */
static void measure_tiles(const struct markov *m, int left_out, double tiles[TILE_COUNT])
{
    for (int g = 0; g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        for (long i = 0; i < paths->count; i++)
            if (paths->targets[i] > 0.0 && is_kept(i, left_out))
                tiles[tile_of(m, paths->pixels[i])] += paths->targets[i] * TILE_COUNT /
                                                       (double)paths->count;
    }
}

/* Mean and variance of the planned paths that are kept. */
static struct welford values_of(const struct markov *m, const struct group *group,
                                int left_out)
{
    struct welford sum = {0};
    if (left_out < 0)
        return group->independent;
    for (long i = 0; i < group->bootstrap.count && i < m->bootstrap; i++)
        if (is_kept(i, left_out))
            welford_add(&sum, group->bootstrap.targets[i]);
    return sum;
}

/* J_k of a length, as defined above. */
static double error_of(const struct markov *m, const struct group *group, int left_out,
                       const double tiles[TILE_COUNT])
{
    struct welford values = values_of(m, group, left_out);
    const struct bootstrap *paths = &group->bootstrap;
    double sum = 0.0, squares = 0.0, n = markov_pixels(m), dark = DARK * m->b0;
    for (long i = 0; i < paths->count; i++) {
        double f = paths->targets[i];
        if (!(f > 0.0) || !is_kept(i, left_out))
            continue;
        double tile = tiles[tile_of(m, paths->pixels[i])];
        sum += f / (tile * tile + dark * dark);
        squares += f * f / (tile * tile + dark * dark);
    }
    /* n sqrt(S_k Q_k) of J_k, see above. */
    double mixed = sqrt((left_out < 0 ? paths->b : values.mean) * sum * squares) /
                   (double)paths->count;
    /* Var[f_k] / (p_l b^2) of J_k. */
    double whole = welford_variance(&values) / (LARGE * m->b0 * m->b0);
    return n * mixed + WHOLE * whole;
}

static void find_weights(const struct markov *m, int left_out, double *weights)
{
    double tiles[TILE_COUNT] = {0.0};
    if (m->settings->allocation != ALLOCATION_BRIGHTNESS)
        measure_tiles(m, left_out, tiles);
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        if (m->settings->allocation != ALLOCATION_BRIGHTNESS)
            weights[i] = sqrt(error_of(m, group, left_out, tiles));
        else
            weights[i] = left_out < 0 ? group->bootstrap.b
                                      : values_of(m, group, left_out).mean;
    }
}

/* The shares that share_out would give before rounding. */
static void jackknife(struct markov *m)
{
    for (int j = 0; j < JACKKNIFE; j++) {
        double total = 0.0, *share = m->jackknife.shares[j];
        find_weights(m, j, share);
        for (int i = 0; i < m->group_count; i++) {
            total += share[i];
            m->jackknife.means[j][i] = values_of(m, &m->groups[i], j).mean;
        }
        for (int i = 0; i < m->group_count && total > 0.0; i++)
            share[i] = fmax(share[i] / total,
                            MARKOV_CHAINS_LEAST / (double)m->chain_count);
    }
}

/* Rounds the shares down, but not below the least number of chains; then adds or removes
 * single chains where the ratio of weight to number of chains makes that best. */
static void share_out(struct markov *m, const double *weights)
{
    int least = m->design.last_length > 0 ? MARKOV_CHAINS_LEAST : 1, given = 0;
    double total = 0.0;
    for (int i = 0; i < m->group_count; i++)
        total += weights[i];
    for (int i = 0; i < m->group_count; i++) {
        int due = (int)(m->chain_count * (weights[i] / total));
        m->groups[i].chain_count = due > least ? due : least;
        given += m->groups[i].chain_count;
    }
    for (int step = given < m->chain_count ? 1 : -1; given != m->chain_count;
         given += step) {
        int best = -1;
        double best_worth = 0.0;
        for (int i = 0; i < m->group_count; i++) {
            double worth = step * weights[i] / (m->groups[i].chain_count + 0.5 * step);
            if (step < 0 && m->groups[i].chain_count <= least)
                continue;
            if (best < 0 || worth > best_worth) {
                best = i;
                best_worth = worth;
            }
        }
        m->groups[best].chain_count += step;
    }
}

void markov_allocate(struct markov *m)
{
    double weights[DIMS_MAX_DEPTH] = {1.0};
    if (m->group_count > 1) {
        find_weights(m, -1, weights);
        jackknife(m);
    }
    share_out(m, weights);
    markov_number_chains(m);
}

void markov_number_chains(struct markov *m)
{
    for (int i = 0, chain = 0; i < m->group_count; i++) {
        m->groups[i].first_chain = chain;
        for (int j = 0; j < m->groups[i].chain_count; j++)
            m->group_of[chain++] = i;
    }
}
