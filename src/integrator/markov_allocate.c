/* How many chains each path length gets. Any numbers give the right picture, for every
 * length is normalised by its own; they decide where the error is.
 *
 * A chain of length k, of which N_k states are counted, puts b_k n / N_k (n pixels) into
 * a pixel of brightness I_k with each of the N_k I_k / (b_k n) states that fall there. As
 * if these were independent, the variance is b_k n I_k / N_k, and the mean over pixels of
 * relative errors, variance / (I^2 + e^2), is n S_k / N_k with
 *     S_k = b_k E[f_k / (I(pixel)^2 + e^2)],
 * the mean over independent paths of that length. Of the brightness b_k itself, known
 * from p_l N_k large steps, the variance is Var[f_k] / (p_l N_k); relative to b^2 it
 * counts WHOLE times. So the error is a sum of J_k / N_k, J_k = n S_k + WHOLE Var[f_k] /
 * (p_l b^2), which at a given sum of N_k is least for N_k in proportion to sqrt(J_k). In
 * proportion to b_k instead, most chains would polish what is bright already: a lamp that
 * is seen directly. */

#include "base/mem.h"
#include "integrator/markov_state.h"

#define CHAINS_LEAST 2  /* standard errors come from the spread between chains */
#define TILES        16 /* of the film, each way: the pixels of a coarse picture */
#define TILE_COUNT   (TILES * TILES)
#define DARK         0.5 /* e, in units of the mean brightness */
#define WHOLE        10.0
#define LARGE        0.5 /* p_l is not known yet: that of the measured start */

static int tile_of(const struct markov *m, int32_t pixel)
{
    int width = m->scene->camera.width, height = m->scene->camera.height;
    int x = pixel % width * TILES / width, y = pixel / width * TILES / height;
    return y * TILES + x;
}

/* Brightness of the tiles, by the bootstraps of all lengths. */
static void measure_tiles(const struct markov *m, double tiles[TILE_COUNT])
{
    for (int g = 0; g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        for (long i = 0; i < paths->count; i++)
            if (paths->targets[i] > 0.0)
                tiles[tile_of(m, paths->pixels[i])] += paths->targets[i] * TILE_COUNT /
                                                       (double)paths->count;
    }
}

/* sqrt(J_k) of every length. */
static void error_weights(const struct markov *m, double *weights)
{
    double tiles[TILE_COUNT] = {0.0}, dark = DARK * m->b0;
    measure_tiles(m, tiles);
    for (int g = 0; g < m->group_count; g++) {
        const struct bootstrap *paths = &m->groups[g].bootstrap;
        double sum = 0.0;
        for (long i = 0; i < paths->count; i++) {
            if (!(paths->targets[i] > 0.0))
                continue;
            double tile = tiles[tile_of(m, paths->pixels[i])];
            sum += paths->targets[i] / (tile * tile + dark * dark);
        }
        double whole = WHOLE * welford_variance(&m->groups[g].independent) /
                       (LARGE * m->b0 * m->b0);
        weights[g] = sqrt(markov_pixels(m) * paths->b * sum / (double)paths->count +
                          whole);
    }
}

/* Every length at least its due rounded down; each of the others goes to where the next
 * chain is worth most, or comes from where the last one is worth least. */
static void share_out(struct markov *m, const double *weights)
{
    int least = m->group_count > 1 ? CHAINS_LEAST : 1, given = 0;
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
    if (m->group_count > 1 && !m->settings->by_brightness)
        error_weights(m, weights);
    for (int i = 0; m->settings->by_brightness && i < m->group_count; i++)
        weights[i] = m->groups[i].bootstrap.b;
    share_out(m, weights);
    for (int i = 0, chain = 0; i < m->group_count; i++) {
        m->groups[i].first_chain = chain;
        for (int j = 0; j < m->groups[i].chain_count; j++)
            m->group_of[chain++] = i;
    }
}
